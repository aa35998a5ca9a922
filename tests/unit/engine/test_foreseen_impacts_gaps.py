"""Which gaps cannot close in a part, against their closed forms: balls, and capsules over a plane.

A capsule in free motion goes round its momentum L at |L|/I across its axis: u turns by Rodrigues.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import put_vector
from interpreted import interpreted, records

from lavendersim.engine.collide.pairs import SHAPE_PAIRS
from lavendersim.engine.foreseen_impacts import ALONE, make_follow, make_stays_apart
from lavendersim.engine.record_layout import allocate_bodies, allocate_pairs, contact_dtype
from lavendersim.engine.records import BOX, CAPSULE, MOTION, PLANE, SPHERE, dtype
from lavendersim.engine.spec import Spec

STEP, RADIUS, HALF = 0.02, 0.1, 0.5
SHAPES = ("sphere_plane", "sphere_sphere", "capsule_plane", "box_plane")
SPEC = Spec(("compound", "fast_bodies", "gyroscopic", "impact_order", "rotation"), SHAPES)
APART = interpreted(make_stays_apart(SPEC))
TIMES = np.linspace(0.0, STEP, 400)


class Meeting:
    """A row between bodies 0 and 1 of a pair of shapes."""

    def __init__(self, name: str, rng: np.random.Generator) -> None:
        self.name, self.rng = name, rng
        self.bodies, self.pairs = allocate_bodies(SPEC, 2), allocate_pairs(SPEC, 1)
        self.motion, self.contact = np.zeros(2, dtype(MOTION)), np.zeros(1, contact_dtype(SPEC))
        self.pairs["kind"], self.pairs["b"] = SHAPE_PAIRS[name].kind, 1
        self.contact["b"], self.bodies["owner"] = 1, [0, 1]
        first = SPHERE if name == "sphere_sphere" else PLANE
        second = {"capsule_plane": CAPSULE, "box_plane": BOX}.get(name, SPHERE)
        self.bodies["shape"], self.bodies["bound"] = [first, second], [0.0, RADIUS + HALF]
        self.bodies["hx"], self.bodies["hz"] = RADIUS, HALF
        for axis, inverse in zip("xyz", (1.0, 1.0, rng.uniform(1.0, 50.0)), strict=True):
            self.bodies[f"inv_i{axis}"] = inverse
        self.v, self.a = rng.normal(size=3), 20.0 * rng.normal(size=3)
        self.w = 10.0 * rng.normal(size=3)
        put_vector(self.motion[1], "v", self.v)
        put_vector(self.motion[1], "w", self.w)
        put_vector(self.motion[1], "ahead_", self.a * STEP)

    def gaps(self) -> np.ndarray:
        """Return the gap over TIMES, and fill the row with how it begins."""
        rng, t = self.rng, TIMES[:, None]
        way, begin = self.v * t + 0.5 * self.a * t * t, np.abs(rng.normal()) * 2e-3
        if self.name == "sphere_sphere":
            n = rng.normal(size=3)
            n /= np.linalg.norm(n)
            gap = np.linalg.norm((2.0 * RADIUS + begin) * n + way, axis=1) - 2.0 * RADIUS
            rate = n @ self.v
        else:
            n = np.array([0.0, 0.0, 1.0])
            gap, rate = begin + way[:, 2], self.v[2]
        if self.name == "capsule_plane":
            u = rng.normal(size=3)
            u /= np.linalg.norm(u)
            axial = u * (u @ self.w)
            spin = self.w - axial + axial / self.bodies["inv_iz"][1]  # L/I across the axis
            speed = np.linalg.norm(spin)
            k, angle = spin / speed, speed * t
            turned = u * np.cos(angle) + np.cross(k, u) * np.sin(angle)
            turned = turned + k * (k @ u) * (1.0 - np.cos(angle))
            gap = gap + HALF * (turned[:, 2] - u[2])
            rate = rate + HALF * np.cross(self.w, u)[2]
        put_vector(self.contact[0], "n", n)
        self.contact["phi"], self.contact["rate"] = begin, rate
        return gap

    def stays(self) -> bool:
        rows = (self.contact, self.pairs, self.bodies, self.motion)
        contact, pair, bodies, motion = (records(one) for one in rows)
        return bool(APART(contact[0], pair[0], bodies, motion, STEP))


@pytest.mark.parametrize("name", sorted(ALONE))
def test_no_gap_that_is_said_to_stay_open_closes(name: str, rng: np.random.Generator) -> None:
    said, closed = 0, 0
    for _ in range(400):
        meeting = Meeting(name, rng)
        closes, stays = bool(meeting.gaps().min() < 0.0), meeting.stays()
        assert not (closes and stays)
        said, closed = said + stays, closed + closes
    assert said > 100
    assert closed > 100


def open_for(meeting: Meeting) -> bool:
    meeting.contact["phi"], meeting.contact["rate"] = 1.0, 0.0
    return meeting.stays()


def test_what_has_other_features_or_another_path_is_not_known_by_one_gap(rng: Any) -> None:
    for name in SHAPES:
        assert open_for(Meeting(name, rng)) == (name in ALONE)
    turning = Meeting("sphere_plane", rng)
    turning.motion["wx"][0] = 1e-3
    part, swept = Meeting("sphere_sphere", rng), Meeting("sphere_sphere", rng)
    part.bodies["owner"] = 0
    swept.contact["tangential_y"] = 1e-3
    broad, uneven = Meeting("capsule_plane", rng), Meeting("capsule_plane", rng)
    broad.bodies["inv_iz"] = 0.5
    uneven.bodies["inv_iy"] = 2.0
    for meeting in (turning, part, swept, broad, uneven):
        assert not open_for(meeting)


def test_only_where_a_row_may_close_is_the_pair_followed(rng: np.random.Generator) -> None:
    follow = interpreted(make_follow(SPEC))
    for rate, due in ((50.0, 1e300), (1e-3, 0.0)):
        ball = Meeting("sphere_sphere", rng)
        put_vector(ball.contact[0], "n", (0.0, 0.0, 1.0))
        ball.contact["rate"], ball.contact["waits"], ball.contact["due"] = rate, 1, 0.5 * STEP
        rows = [records(one) for one in (ball.contact, ball.pairs, ball.bodies, ball.motion)]
        ball.motion["wx"] = 1e3  # may bring any point nearer
        follow(rows[0], rows[1], 1, rows[2], rows[3], STEP)
        assert ball.contact["due"][0] == due


def test_a_force_that_is_not_reckoned_yet_closes_gaps_too(rng) -> None:
    """In the first step under gravity: 1e-5 m + 0.2 mm - 2 mm after 20 ms."""
    meeting = Meeting("sphere_plane", rng)
    put_vector(meeting.motion[1], "ahead_", np.zeros(3))
    meeting.contact["phi"], meeting.contact["rate"] = 1e-5, 0.01
    assert meeting.stays()
    put_vector(meeting.motion[1], "dv", np.array([0.0, 0.0, -9.81 * STEP]))
    assert not meeting.stays()
