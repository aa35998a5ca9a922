"""A start so fast that bodies may pass through each other, where nothing looks ahead."""

from __future__ import annotations

import pytest

from tests.unit.lint.scenes import config, found

SPHERE = "shape: {kind: sphere, radius: 0.01}, mass: 1, position: [0, 0, 1]"
BALL = f"ball: {{{SPHERE}, velocity: [%g, 0, 0]}}"
WALL = "wall: {shape: {kind: box, size: [0.02, 2, 2]}, fixed: true, position: [1, 0, 1]}"


@pytest.mark.parametrize(
    ("speed", "numerics", "crosses"),
    [
        # Ball and wall are 0.02 m + 0.02 m thick: at 1/100 s that is 4 m/s.
        (4.1, "{preset: chapter, timestep: 1/100}", True),
        (3.9, "{preset: chapter, timestep: 1/100}", False),
        (4.1, "{preset: chapter, timestep: 1/200}", False),
        (100, "{timestep: 1/100}", False),  # contacts are made ahead
    ],
)
def test_by_speed_timestep_and_whether_contacts_are_made_ahead(
    speed: float, numerics: str, crosses: bool
) -> None:
    text = config(BALL % speed, WALL, rest=f"numerics: {numerics}\nalways: {{}}\n")
    messages = [defect.message for defect in found(text)]
    assert [message.split(":")[0] for message in messages] == ["velocity"] * crosses
    if crosses:
        assert "ball and wall may pass through each other" in messages[0]


@pytest.mark.parametrize(("speed", "crosses"), [(1.1, True), (0.9, False)])
def test_a_mesh_is_as_thick_as_the_half_of_a_body_before_it(speed: float, crosses: bool) -> None:
    """Half a ball is 0.01 m thick: at 1/100 s that is 1 m/s."""
    field = "kind: height_field, heights: [[0, 0], [0, 0]], spacing: [9, 9]"
    mesh = f"ramp: {{shape: {{{field}}}, position: [0, 0, -5]}}"
    rest = "numerics: {preset: chapter, timestep: 1/100}\nalways: {}\n"
    messages = [defect.message for defect in found(config(BALL % speed, mesh, rest=rest))]
    assert ["ball may pass through ramp" in message for message in messages] == [True] * crosses


def test_a_plane_is_not_passed() -> None:
    falls = (BALL % 0).replace("velocity: [0, 0, 0]", "velocity: [0, 0, -1000]")
    rest = "numerics: {preset: chapter}\nalways: {}\n"
    assert found(config(falls, rest=rest)) == []
