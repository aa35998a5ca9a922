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
from lavendersim.engine.records import MOTION, PLANE, SPHERE, dtype
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
