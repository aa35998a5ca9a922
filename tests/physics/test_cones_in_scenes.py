"""A cone as a part of a compound, and on a height field, rests as alone and on a plane.

A compound of one part is the part, however it is turned in it. A level height field is a plane.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from physics_runs import GRAVITY, Course, run_config
from scipy.spatial.transform import Rotation

RADIUS, HEIGHT = 0.15, 0.3
HALF = math.atan(RADIUS / HEIGHT)  # half its angle [rad]
CONE = f"{{kind: cone, radius: {RADIUS}, height: {HEIGHT}}}"
PLANE = "{shape: {kind: plane}, surface: one}"
HEIGHTS = "{kind: height_field, heights: [[0, 0, 0], [0, 0, 0], [0, 0, 0]], spacing: [0.5, 0.5]}"
FIELD = f"{{shape: {HEIGHTS}, position: [0, 0, 0], fixed: true, surface: one}}"
SCENE = """\
scene:
  surfaces: {{one: {{friction: 0.8}}}}
  bodies:
    floor: {floor}
    it: {{shape: {shape}, mass: 1, surface: one, position: {place}, orientation: {turn}}}
numerics: {{timestep: 1/240}}
duration: 8/240
"""
WITHIN = Rotation.from_euler("xyz", [0.5, -0.7, 1.1])  # of the part in its compound
UPRIGHT = 0.25 * HEIGHT, Rotation.from_euler("z", 0.3)
# Its side is level: the centre is 3/4 h from the apex along the axis.
LYING = 0.75 * HEIGHT * math.sin(HALF), Rotation.from_euler("y", -(0.5 * math.pi + HALF))


def ran(height: float, turn: Rotation, floor: str, shape: str) -> Course:
    x, y, z, w = turn.as_quat().tolist()
    place = [0.05, 0.03, height]
    text = SCENE.format(floor=floor, shape=shape, place=place, turn=[w, x, y, z])
    (course,) = run_config(text, interpreted=True)
    return course


@pytest.mark.parametrize("stands", [UPRIGHT, LYING], ids=["on its base", "on its side"])
@pytest.mark.parametrize("floor", [PLANE, FIELD], ids=["plane", "height field"])
@pytest.mark.parametrize("is_part", [False, True], ids=["alone", "part"])
def test_it_rests_where_it_stands_and_carries_its_weight(
    stands: tuple[float, Rotation], floor: str, is_part: bool
) -> None:
    height, turn = stands
    shape = CONE
    if is_part:
        x, y, z, w = WITHIN.as_quat().tolist()
        part = f"{{shape: {CONE}, position: [0, 0, 0], orientation: {[w, x, y, z]}}}"
        shape, turn = f"{{kind: compound, parts: [{part}]}}", turn * WITHIN.inv()
    course = ran(height, turn, floor, shape)
    place = course.pose[:, course.names.index("it"), :3]
    # Steps are solved to 1e-9 m/s, for 8/240 s; distances of GJK are known to 1e-9 m.
    assert abs(place - place[0]).max() <= 2e-9
    held = np.bincount(course.contact["step"], course.contact["impulse_n"])[-1]
    assert held == pytest.approx(GRAVITY / 240, rel=1e-6)
