"""What a periodic cell cannot be with is refused at its key, with what would do."""

from __future__ import annotations

import pytest

from tests.marked_config import assert_refused, config, refusals, scene

BALL = "ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1]}"
FLOOR = "floor: {shape: {kind: plane}}"


def cell(*bodies: str, periodic: str = "{x: [0, 1]}", **sections: str) -> str:
    return config(scene=scene(*(bodies or (FLOOR, BALL)), periodic=periodic, **sections))


def test_a_floor_along_the_axis_and_small_bodies_are_right() -> None:
    assert refusals(cell()) == []


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        (
            "wall: {§shape: {kind: plane, normal: [1, 0, 1]}}",
            "shape: the scene is periodic along x, which wall does not contain; expected a plane "
            "whose normal is across it",
        ),
        (
            "slab: {§shape: {kind: box, size: [0.4, 0.3, 0.1]}, fixed: true, position: [0, 0, 0]}",
            "shape: the scene repeats itself along x after 1 m; expected bodies less than half of "
            "that across, and slab has 0.509902 m",
        ),
        (
            "bowl: {§shape: {kind: bowl, radius: 3}, position: [0, 0, 0]}",
            "shape: the scene is periodic, and a bowl has no images yet (bowl)",
        ),
    ],
)
def test_shapes_without_images_are_refused(body: str, sentence: str) -> None:
    assert_refused(cell(BALL, body), sentence)


def test_connections_are_refused() -> None:
    other = BALL.replace("ball:", "other:").replace("[0, 0, 1]", "[0.3, 0, 1]")
    spring = "[{a: ball, b: other, stiffness: 1}]"
    sentence = (
        "springs: the scene is periodic, and none reaches across its faces yet; leave one out"
    )
    (said,) = refusals(cell(BALL, other, springs=spring))
    assert said.endswith(sentence)


@pytest.mark.parametrize(
    ("periodic", "sentence"),
    [
        ("{x: §[1, 0]}", "x: expected the lower end first, found 1, 0"),
        ("§{}", "periodic: expected one of x, y and z, such as x: [0, 1]"),
        ("{x: §[0]}", "x: expected a list of 2 numbers [m], found a list of 1"),
    ],
)
def test_the_ends_of_a_cell_ascend(periodic: str, sentence: str) -> None:
    assert_refused(cell(periodic=periodic), sentence)
