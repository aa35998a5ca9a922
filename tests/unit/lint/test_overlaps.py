"""Bodies that start inside one another or behind a plane are found; those that touch are not."""

from __future__ import annotations

import math
import re

import pytest

from tests.unit.lint.scenes import config, found

SHAPES = {  # each of a half width of 0.5 along x, whatever turns it about x
    "sphere": "{kind: sphere, radius: 0.5}",
    "box": "{kind: box, size: [1, 1, 1]}",
    "cylinder": "{kind: cylinder, radius: 0.5, length: 1}",
    "capsule": "{kind: capsule, radius: 0.5, length: 1}",
    "hull": "{kind: hull, points: [[0.5, 0.5, 0.5], [0.5, -0.5, 0.5], [0.5, 0.5, -0.5], "
    "[0.5, -0.5, -0.5], [-0.5, 0.5, 0.5], [-0.5, -0.5, 0.5], [-0.5, 0.5, -0.5], "
    "[-0.5, -0.5, -0.5]]}",
    "compound": "{kind: compound, parts: [{shape: {kind: box, size: [1, 1, 0.5]}, "
    "position: [0, 0, 0.25]}, {shape: {kind: box, size: [1, 1, 0.5]}, position: [0, 0, -0.25]}]}",
}


def body(name: str, shape: str, x: float, z: float = 10.0) -> str:
    return f"{name}: {{shape: {SHAPES[shape]}, mass: 1, position: [{x!r}, 0, {z!r}]}}"


PAIRS = [(one, other) for one in SHAPES for other in SHAPES if one <= other]


@pytest.mark.parametrize(("one", "other"), PAIRS)
def test_a_pair_is_found_as_deep_as_a_twentieth_and_not_where_it_touches(
    one: str, other: str
) -> None:
    """Along x both reach 0.5 m on their axes, so the distance of touch is 1 m for every pair."""
    (defect,) = found(config(body("a", one, 0.0), body("b", other, 0.95)))
    assert re.match(r"[ab] starts (0\.05\d* m )?inside [ab]", defect.message), defect.message
    assert found(config(body("a", one, 0.0), body("b", other, 1.0))) == []
    assert found(config(body("a", one, 0.0), body("b", other, 1.2))) == []


@pytest.mark.parametrize("shape", SHAPES)
def test_a_body_behind_a_plane_is_found_by_how_deep_it_is(shape: str) -> None:
    half = 1.0 if shape == "capsule" else 0.5  # of the height
    text = config(body("a", shape, 0.0, half - 0.03))
    (defect,) = found(text)
    assert defect.message.startswith("a starts 0.03 m behind the surface of floor")
    line = text.splitlines()[defect.line - 1]
    assert line[defect.column - 1 :].startswith("position")
    assert found(config(body("a", shape, 0.0, half))) == []
    assert found(config(body("a", shape, 0.0, half + 1.0))) == []


def test_a_tilted_box_on_its_edge_touches() -> None:
    """A cube turned by 45 degrees about x reaches sqrt(2)/2 of its edge below its centre."""
    turned = "orientation: {axis: [1, 0, 0], degrees: 45}"
    text = f"a: {{shape: {SHAPES['box']}, mass: 1, position: [0, 0, {math.sqrt(0.5)!r}], {turned}}}"
    assert found(config(text)) == []


def test_parts_of_one_body_may_overlap_and_many_pairs_are_one_sentence() -> None:
    parts = "{shape: {kind: box, size: [1, 1, 1]}}, {shape: {kind: sphere, radius: 0.6}}"
    one = f"a: {{shape: {{kind: compound, parts: [{parts}]}}, mass: 1, position: [0, 0, 9]}}"
    assert found(config(one)) == []
    balls = [body(f"b{k}", "sphere", 0.9 * k) for k in range(4)]
    (defect,) = found(config(*balls))
    assert "so do 2 more pairs" in defect.message


def test_bodies_that_a_joint_joins_may_overlap_and_those_that_still_touch_not() -> None:
    text = config(body("a", "box", 0.0), body("b", "box", 0.9))
    joint = "  connections: {c: {kind: ball, between: [a, b], at: [0.5, 0, 10]}}\n  bodies:\n"
    assert found(text.replace("  bodies:\n", joint, 1)) == []
    touching = joint.replace("10]", "10], collide: true")
    assert len(found(text.replace("  bodies:\n", touching, 1))) == 1


def test_bodies_that_never_move_may_overlap() -> None:
    fixed = [body(name, "box", 0.0).replace("mass: 1", "fixed: true") for name in "ab"]
    assert found(config(*fixed, body("c", "box", 5.0))) == []


@pytest.mark.parametrize("shape", SHAPES)
def test_a_body_whose_centre_is_behind_a_mesh_is_found(shape: str) -> None:
    """A slope of 4/3 along x through the origin, turned by 180 degrees about x: behind is above."""
    ground = "kind: height_field, heights: [[-4, -4], [4, 4]], spacing: [6, 6]"
    deep = 0.75 if shape == "compound" else 0.6  # of the centre of its lower part, or its own
    for turn, above in (("0", 1.0), ("180", -1.0)):
        pose = f"position: [0, 0, 5], orientation: {{axis: [0, 1, 0], degrees: {turn}}}"
        mesh = f"ground: {{shape: {{{ground}}}, {pose}}}"
        assert found(config(body("a", shape, 0.0, 5.0 + above), mesh)) == []
        (defect,) = found(config(body("a", shape, 0.0, 5.0 - above), mesh))
        assert defect.message.startswith(f"a starts {deep} m behind the surface of ground")
        beside_its_rim = body("a", shape, above * 12.0, 5.0 - above)
        assert found(config(beside_its_rim, mesh)) == []


@pytest.mark.parametrize("cavity", ["bowl", "drum"])
@pytest.mark.parametrize("shape", ["sphere", "box"])
def test_a_body_in_the_wall_around_it_is_found_by_how_deep_it_is(cavity: str, shape: str) -> None:
    """Out along x by 1 m: a corner of the cube is 1.5 m out there, and 0.5 m aside on two sides."""
    aside = 0.5 if cavity == "bowl" or shape == "sphere" else 0.0
    farthest = 1.5 if shape == "sphere" else math.sqrt(1.5**2 + 0.5**2 + aside**2)
    for radius, count in ((farthest - 0.03, 1), (farthest + 1e-9, 0)):
        wall = f"wall: {{shape: {{kind: {cavity}, radius: {radius!r}}}, position: [0, 0, 10]}}"
        defects = found(config(wall, body("a", shape, 1.0)))
        assert len(defects) == count
        assert all("starts 0.03 m behind the surface of wall" in one.message for one in defects)
