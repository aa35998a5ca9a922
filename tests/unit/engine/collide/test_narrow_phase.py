"""Contacts of listed pairs are those within reach, by the closed forms of spheres."""

from __future__ import annotations

from itertools import combinations
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drawn_contacts import put_vector
from interpreted import interpreted, records
from plain_facts import one_row, vector_fields

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.collide.narrow_phase import REACHES, displacement, make, make_manifold
from lavendersim.engine.collide.scratch import allocate_scratch
from lavendersim.engine.record_layout import (
    allocate_bodies,
    allocate_pairs,
    allocate_velocities,
    contact_dtype,
)
from lavendersim.engine.records import MOTION, PLANE, SPHERE, TOUCHING, dtype
from lavendersim.engine.spec import Spec

PAIRS = ("sphere_plane", "sphere_sphere")
SPEC = Spec(effects=("speculative",), shape_pairs=PAIRS)
DT = 0.01


class Balls:
    """The plane z = 0, row 0, and balls; every two of them are a listed pair."""

    def __init__(self, centres: Any, radii: Any, spec: Spec = SPEC, room: int = 32) -> None:
        count = len(centres) + 1
        self.spec, self.bodies = spec, allocate_bodies(spec, count)
        self.bodies["shape"], self.bodies["inv_m"] = SPHERE, 1.0
        self.bodies["shape"][0], self.bodies["inv_m"][0], self.bodies["hz"][0] = PLANE, 0.0, 1.0
        for body, centre, radius in zip(self.bodies[1:], centres, radii, strict=True):
            put_vector(body, "", centre)
            body["hx"] = body["bound"] = radius
        if "owner" in self.bodies.dtype.names:
            self.bodies["owner"] = np.arange(count)
        self.motion = np.zeros(count, dtype(MOTION))
        self.velocities = allocate_velocities(spec, count)
        listed = list(combinations(range(count), 2))
        self.pairs, self.contacts = (
            allocate_pairs(spec, len(listed)),
            np.zeros(room, contact_dtype(spec)),
        )
        for row, (a, b) in zip(self.pairs, listed, strict=True):
            row["a"], row["b"], row["key"] = a, b, 1000 + 10 * a + b
            row["kind"] = SHAPE_PAIRS[PAIRS[0] if a == 0 else PAIRS[1]].kind

    def look(self, listed: int | None = None) -> Any:
        """Return the rows in use, or -1."""
        names = ("bodies", "motion", "pairs", "contacts")
        state = SimpleNamespace(**{name: records(getattr(self, name)) for name in names})
        state.velocities = records(self.velocities)
        workspace = SimpleNamespace(collision=records(allocate_scratch(None)))
        kernel = interpreted(make(self.spec))
        count = kernel(state, len(self.pairs) if listed is None else listed, workspace, DT)
        return self.contacts[:count] if count >= 0 else count


def expected_of(balls: Balls) -> list[tuple[int, float, np.ndarray]]:
    """Return row of the pair, gap and normal from its A to its B, of all within reach."""
    found = []
    for p, pair in enumerate(balls.pairs):
        a, b = balls.bodies[pair["a"]], balls.bodies[pair["b"]]
        between = np.array([b[axis] - a[axis] for axis in "xyz"])
        if a["shape"] == PLANE:  # its normal, however deep the ball is
            between = np.array([0.0, 0.0, 1.0])
            gap = b["z"] - b["hx"]
        else:
            gap = np.linalg.norm(between) - a["hx"] - b["hx"]
        reach = balls.motion["reach"][pair["a"]] + balls.motion["reach"][pair["b"]]
        if gap <= TOUCHING + reach:
            found.append((p, gap, between / np.linalg.norm(between)))
    return found


def test_contacts_are_those_within_reach_of_both_bodies(rng) -> None:
    counts = set()
    for _ in range(40):
        balls = Balls(rng.normal((0.0, 0.0, 1.5), size=(4, 3)), rng.uniform(0.1, 0.6, 4))
        balls.motion["reach"] = rng.uniform(0.0, 0.5, 5)
        rows, expected = balls.look(), expected_of(balls)
        assert rows["pair"].tolist() == [p for p, _, _ in expected]
        counts.add(len(rows))
        for row, (p, gap, normal) in zip(rows, expected, strict=True):
            pair = balls.pairs[p]
            assert (row["a"], row["b"], row["key"]) == (pair["a"], pair["b"], pair["key"])
            assert row["phi"] == pytest.approx(gap, abs=1e-14)
            np.testing.assert_allclose([row[f"n{x}"] for x in "xyz"], normal, atol=1e-14)
            # Half way between the surfaces.
            b = balls.bodies[pair["b"]]
            at = np.array([b[x] for x in "xyz"]) - normal * (b["hx"] + 0.5 * gap)
            np.testing.assert_allclose([row[x] for x in "xyz"], at, atol=1e-14)
    assert len(counts) > 4


@pytest.mark.parametrize("soft", [0.0, 1e-6])
def test_springs_are_looked_for_as_far_as_what_is_thrown_may_go(soft: float) -> None:
    """REACHES of the fastest, be it thrown by a spring; of rigid pairs as far as both move."""
    spec = SPEC.including("compliance", "contact_spring")
    for far, count in ((0.999, 1), (1.001, 0)):
        gap = TOUCHING + far * REACHES * (0.01 + 3.0 * DT)
        balls = Balls([(0.0, 0.0, 1.0 + gap), (9.0, 0.0, 9.0)], [1.0, 1.0], spec)
        balls.pairs["compliance"] = soft
        balls.motion["reach"][2], balls.velocities["released"][2] = 0.01, 3.0
        assert len(balls.look(listed=1)) == (count if soft > 0.0 else 0)


def test_without_contacts_ahead_only_what_touches_is_one() -> None:
    spec = SPEC.without("speculative")
    for gap, count in ((0.9 * TOUCHING, 1), (1.1 * TOUCHING, 0), (-0.1, 1)):
        balls = Balls([(0.0, 0.0, 1.0 + gap)], [1.0], spec)
        balls.motion["reach"] = 1.0
        assert len(balls.look()) == count


def test_full_rows_are_said_and_only_listed_pairs_are_looked_at() -> None:
    together = [(0.0, 0.0, 0.1)] * 3, [0.2] * 3
    assert len(Balls(*together, room=6).look()) == 6
    assert Balls(*together, room=5).look() == -1
    assert len(Balls(*together, room=5).look(listed=4)) == 4


def test_bodies_of_which_none_can_move_are_not_looked_at() -> None:
    spec = SPEC.including("sleeping")
    balls = Balls([(0.0, 0.0, 1.0), (0.0, 0.0, 3.0)], [1.0, 1.0], spec)
    balls.bodies["z"][2] = 2.0
    balls.pairs = balls.pairs[[0, 2]]
    assert balls.look()["pair"].tolist() == [0, 1]
    balls.bodies["asleep"][1], balls.bodies["inv_m"][1] = 1, 0.0
    assert balls.look()["pair"].tolist() == [1]
    balls.bodies["asleep"][2], balls.bodies["inv_m"][2] = 1, 0.0
    assert balls.look()["pair"].tolist() == []


def test_contacts_of_parts_are_contacts_of_their_owners() -> None:
    """Shapes, places and keys are those of the part, reach and row those of the body."""
    spec = SPEC.including("compound", "rotation")
    balls = Balls([(0.0, 0.0, 5.0), (0.0, 0.0, 1.2)], [0.1, 1.0], spec)
    balls.bodies["owner"][2] = 1
    assert len(balls.look()) == 0
    balls.motion["reach"][1] = 0.3
    (row,) = balls.look()
    assert (row["a"], row["b"], row["pair"]) == (0, 1, 1)
    assert row["phi"] == pytest.approx(0.2, abs=1e-14)


def test_bodies_move_by_their_own_velocity_and_by_a_share_of_what_forces_change() -> None:
    v, dv = np.array([1.0, -2.0, 3.0]), np.array([0.5, 0.25, -1.0])
    move = interpreted(displacement)
    of_a = one_row(**vector_fields("v", 2.0 * v), **vector_fields("dv", 3.0 * dv))
    of_b = one_row(**vector_fields("v", v), **vector_fields("dv", dv))
    found = np.array(move(of_a, of_b, 0.5, DT))
    np.testing.assert_allclose(found, DT * (-v - dv), rtol=1e-15)


@pytest.mark.parametrize("midpoint", [False, True])
def test_a_fast_ball_touches_where_it_will_meet(midpoint: bool) -> None:
    """Of a ball that falls on another beside its top: the normal is that of the meeting.

    Its gap is what it comes nearer by until then along that normal, and across it B is touched
    where it will be.
    """
    spec = SPEC.including("fast_bodies", *(["midpoint"] if midpoint else []))
    radius, aside, high = 0.1, 0.12, 1.0
    balls = Balls([(aside, 0.0, high), (0.0, 0.0, -1.0)], [radius, radius], spec)
    balls.bodies["z"][2], balls.bodies["inv_m"][2] = 0.0, 0.0
    balls.pairs, balls.motion["reach"] = balls.pairs[2:], 2.0
    # Half of what forces add counts where the midpoint rule moves bodies.
    balls.motion["vz"][1], balls.motion["dvx"][1] = -150.0, 4.0
    (row,) = balls.look()
    n = np.array([row[f"n{x}"] for x in "xyz"])
    # Of B from A, a path and where it meets the sum of the radii: |c + t d| = 2 r.
    c, d = np.array([-aside, 0.0, -high]), DT * np.array([-2.0 if midpoint else -4.0, 0.0, 150.0])
    along, squared = c @ d, d @ d
    t = (-along - np.sqrt(along**2 - squared * (c @ c - 4.0 * radius**2))) / squared
    # They touch to TOUCHING: the normal to its share of a radius, times what it is aslant.
    np.testing.assert_allclose(n, (c + t * d) / (2.0 * radius), atol=1e-7)
    assert row["phi"] == pytest.approx(-t * (d @ n), abs=1e-7)
    across = t * (d - n * (d @ n))
    np.testing.assert_allclose([row[f"tangential_{x}"] for x in "xyz"], across, atol=1e-7)


@pytest.mark.parametrize("names", [(), PAIRS[:1], PAIRS])
def test_only_the_manifolds_of_a_plan_are_in_it(names: tuple[str, ...]) -> None:
    """Every kind differs from the others; of a plan with one kind it is not asked."""
    spec = SPEC._replace(shape_pairs=names)
    manifold = interpreted(make_manifold(spec, names))
    balls = Balls([(0.0, 0.0, 0.9), (0.0, 0.0, 2.5)], [1.0, 1.0])
    rows, scratch = records(balls.bodies), records(allocate_scratch(None))
    for name, a, b, depth in ((PAIRS[0], 0, 1, 0.1), (PAIRS[1], 1, 2, 0.4)):
        kind = SHAPE_PAIRS[name].kind
        if name in names:
            assert manifold(kind, rows[a], rows[b], TOUCHING, scratch) == 1
            assert scratch.manifold.points[0].phi == pytest.approx(-depth, abs=1e-14)
        elif not names:
            assert manifold(kind, rows[a], rows[b], TOUCHING, scratch) == 0
