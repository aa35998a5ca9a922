"""Rows turn by what turns and by bodies that go round each other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import drawn
from interpreted import interpreted, records
from plain_facts import one_row

from lavendersim.engine import midpoint_turning
from lavendersim.engine.midpoint_rows import SAME
from lavendersim.engine.records import BOX, MOTION, PLANE, SPHERE, dtype
from lavendersim.engine.spec import Spec

EFFECTS = ("contact_midpoint", "friction", "impact_order", "impact_time", "rotation")
SPEC = Spec(EFFECTS, ("sphere_plane", "sphere_sphere"))
STRAIGHT = SPEC.without("friction", "rotation")
DT = 0.02
PARAMS = one_row(dt=DT, timestep=DT, slop=1e-5)


TURNING = interpreted(midpoint_turning.make_is_turning(SPEC))


def turning_along(
    axes: tuple[str, str], shapes: Any, velocities: Any, spins: Any, kernel: Any = TURNING
) -> bool:
    scene = drawn(SPEC, np.random.default_rng(3), [(0, 1)], fixed=())
    motion = np.zeros(2, dtype(MOTION))
    scene.bodies["shape"], scene.bodies["bound"] = shapes, [0.2, 0.5]
    for axis, along in zip(axes, (velocities, spins), strict=True):
        motion[axis] = along
    arrays = (scene.bodies, motion)
    return bool(kernel(records(scene.contacts), 1, *(records(a) for a in arrays), PARAMS))


@pytest.mark.parametrize("axes", [("vx", "wz"), ("vy", "wx"), ("vz", "wy")])
def test_geometry_changes_by_what_turns_and_by_bodies_that_go_round_each_other(axes: Any) -> None:
    """By (v/r + w) (v + w r) dt in the step, with the radius of the lesser."""

    def turning(*given: Any) -> bool:
        return turning_along(axes, *given)

    balls, plane = (SPHERE, SPHERE), (PLANE, SPHERE)
    for share, turns in ((1.0 - 1e-6, False), (1.0 + 1e-6, True)):
        v = np.sqrt(share * SAME * 0.2 / DT)
        assert turning(balls, (v, 2.0 * v), (0.0, 0.0)) == turns
        w = np.sqrt(share * SAME / DT / 0.2)
        assert turning(balls, (1.0, 1.0), (-0.5 * w, 0.5 * w)) == turns
        # Past a plane: w (v + w r), r of the ball.
        w = 1e-4
        v = share * SAME / DT / w - w * 0.5
        assert turning(plane, (0.0, v), (w, 0.0)) == turns
    assert not turning(plane, (0.0, 100.0), (0.0, 0.0))
    straight = interpreted(midpoint_turning.make_is_turning(STRAIGHT))
    assert not turning(plane, (0.0, 1.0), (9.0, 9.0), straight)


ALL = (*EFFECTS, "anisotropic_friction", "contact_patch", "contact_spring", "fast_bodies")
ALL = (*ALL, "frictionless_contact", "joint", "kinematic", "rope", "spring", "surface_velocity")
ALL = (*ALL, "gyroscopic", "tangential_compliance")
FULL = Spec(ALL, ("sphere_plane", "sphere_box", "sphere_sphere"))
FULLY = interpreted(midpoint_turning.make_is_turning(FULL))
SIZE = 0.5  # half the edges of the box, and the radius of the ball [m]


class Rolling:
    """A ball that rolls at 1 m/s on a fixed plane, or over the middle of a box of 1 m."""

    def __init__(self, shape: int = PLANE, at: float = 0.0) -> None:
        self.scene = drawn(FULL, np.random.default_rng(3), [(0, 1)])
        self.motion = np.zeros(2, dtype(MOTION))
        bodies, row = self.scene.bodies, self.scene.contacts[0]
        bodies["shape"], bodies["bound"] = (shape, SPHERE), (0.9, SIZE)
        bodies["kinematic"], bodies["sprung"] = 0, 0
        for name in ("x", "y", "z", "r01", "r02", "r10", "r12", "r20", "r21"):
            bodies[name] = 0.0
        for name in ("sx", "sy", "sz"):
            bodies[name][1] = 0.0
        for name in ("r00", "r11", "r22"):
            bodies[name] = 1.0
        for axis in "xyz":
            bodies[f"h{axis}"], bodies[f"inv_i{axis}"][1] = SIZE, 3.0
        bodies["x"][1], bodies["z"][1] = at, 2.0 * SIZE
        self.motion["vx"][1], self.motion["wy"][1], self.motion["wz"][1] = 1.0, 2.0, 30.0
        for name in row.dtype.names:
            if name not in ("a", "b", "pair", "nx", "ny", "nz", "t1x", "t1y", "t1z"):
                row[name] = 0
        row["lasts"], row["frictional"], row["lambda_1"] = 1, 1, 2.0

    def turns(self) -> bool:
        scene = self.scene
        arrays = (records(scene.bodies), records(self.motion))
        return bool(FULLY(records(scene.contacts), 1, *arrays, PARAMS))


def test_a_ball_on_a_plane_or_over_a_face_turns_no_row() -> None:
    """Its normal is that of the plane, its lever -r n: whatever it spins, its row is the same."""
    assert not Rolling().turns()
    # Over a face as long as it does not reach an edge: 20 mm in a step of 20 ms at 1 m/s.
    for at, turns in ((0.0, False), (SIZE - 0.0201, False), (SIZE - 0.0199, True), (SIZE, True)):
        assert Rolling(BOX, at).turns() == turns
        assert Rolling(BOX, -at).turns() == turns
    assert Rolling(SPHERE).turns()


CHANGED = {
    "body": {"kinematic": (0, 1), "inv_m": (0, 1.0), "inv_iz": (1, 3.5), "sprung": (1, 1),
             "sz": (1, 1.0)},
    "contact": {
        "spring_compliance": 1e-4, "yield_k": 1.0, "stretched": 1, "span": 1.0, "bilateral": 1,
        "patch_x": 1e-3, "tangential_y": 1e-3, "surface_2": 1e-3, "begin_n": 1e-8,
    },
}  # fmt: skip


@pytest.mark.parametrize("name", [*CHANGED["body"], *CHANGED["contact"], "slip"])
def test_what_changes_the_row_or_its_sense_is_solved_at_the_middle(name: str) -> None:
    for shape in (PLANE, BOX):
        ball = Rolling(shape)
        row = ball.scene.contacts[0]
        if name in CHANGED["body"]:
            body, value = CHANGED["body"][name]
            ball.scene.bodies[name][body] = value
        elif name == "slip":  # along which friction would push
            for axis in "xyz":
                row[f"begin_{axis}"] = 1e-6 * row[f"t1{axis}"]
        else:
            row[name] = CHANGED["contact"][name]
        assert ball.turns()
