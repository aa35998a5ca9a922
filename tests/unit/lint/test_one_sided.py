"""A coefficient that the other surface leaves out is pointed at; a 0 that is written is meant."""

from __future__ import annotations

import pytest

from tests.unit.lint.scenes import config, found

BOX = "shape: {kind: box, size: [1, 1, 1]}, mass: 1"
SLIDES = f"box: {{{BOX}, position: [0, 0, 0.5], surface: {{friction: 0.5}}}}"
FRICTIONAL = "    floor: {shape: {kind: plane}, surface: {friction: 0.4}}\n"


def test_friction_of_one_surface_alone_is_pointed_at_where_it_is_written() -> None:
    text = config(SLIDES)
    (defect,) = found(text)
    line = text.splitlines()[defect.line - 1]
    assert line[defect.column - 1 :].startswith("friction: 0.5")
    assert "has no effect where it touches floor, which specifies none" in defect.message


@pytest.mark.parametrize(
    "floor",
    [
        FRICTIONAL,
        "    floor: {shape: {kind: plane}, surface: {friction: 0}}\n",
    ],
)
def test_friction_of_both_and_a_zero_that_somebody_wrote_are_meant(floor: str) -> None:
    assert found(config(SLIDES, floor=floor)) == []


def test_the_friction_of_a_floor_is_pointed_at_once_for_all_that_leave_it_out() -> None:
    bodies = [f"b{k}: {{{BOX}, position: [{2 * k}, 0, 0.5]}}" for k in range(5)]
    (defect,) = found(config(*bodies, floor=FRICTIONAL))
    assert "b0, b1, b2 and 2 more" in defect.message


def test_bodies_that_never_touch_since_neither_moves_are_no_pair() -> None:
    wall = f"wall: {{{BOX.replace('mass: 1', 'fixed: true')}, position: [9, 0, 0]}}"
    ball = "ball: {shape: {kind: sphere, radius: 1}, mass: 1, position: [0, 0, 1]}"
    (defect,) = found(config(wall, ball, floor=FRICTIONAL))
    assert "wall" not in defect.message


def test_a_named_surface_is_pointed_at_where_it_stands_and_a_swept_one_counts() -> None:
    surfaces = "  surfaces: {rubber: {friction: 0.5}}\n"
    named = SLIDES.replace("{friction: 0.5}", "rubber")
    (defect,) = found(config(named, surfaces=surfaces))
    assert defect.line == 2
    swept = (
        "sweep: {mu: {path: scene.bodies.floor.surface.friction, values: [0, 0.1]}}\nalways: {}\n"
    )
    floor = "    floor: {shape: {kind: plane}, surface: {restitution: 0}}\n"
    assert found(config(named, surfaces=surfaces, floor=floor, rest=swept)) == []


def test_the_larger_of_two_needs_no_partner() -> None:
    bounces = SLIDES.replace("friction: 0.5", "restitution: 0.5")
    assert found(config(bounces)) == []


NAMED_FLOOR = "    floor: {shape: {kind: plane}, surface: ice}\n"
NAMED = "  surfaces: {ice: {restitution: 0}, rubber: {friction: 0.5}}\n"
PAIR = "  surface_pairs: {wet: {between: [ice, rubber], %s}}\n"


def test_friction_that_is_written_of_the_pair_is_meant() -> None:
    rubber = SLIDES.replace("{friction: 0.5}", "rubber")
    (defect,) = found(config(rubber, floor=NAMED_FLOOR, surfaces=NAMED))
    assert "touches floor" in defect.message
    friction = NAMED + PAIR % "friction: 0.1"
    assert found(config(rubber, floor=NAMED_FLOOR, surfaces=friction)) == []
    restitution = NAMED + PAIR % "restitution: 0.1"
    (defect,) = found(config(rubber, floor=NAMED_FLOOR, surfaces=restitution))
    assert "touches floor" in defect.message
