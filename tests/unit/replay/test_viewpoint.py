"""What a person says of the view: a side, or a place in metres, and nothing else."""

from __future__ import annotations

import pytest

from lavendersim.errors import UsageError
from lavendersim.replay.viewpoint import SIDES, camera_from


@pytest.mark.parametrize("side", SIDES)
def test_a_side_is_itself(side: str) -> None:
    assert camera_from(side) == side


def test_a_place_is_three_numbers() -> None:
    assert camera_from("1, -2.5,3e1") == (1.0, -2.5, 30.0)


@pytest.mark.parametrize(
    ("text", "hint"),
    [("abov", 'did you mean "above"?'), ("1,2", 'got "1,2"'), ("1,2,nan", "finite"), ("", "front")],
)
def test_anything_else_is_refused(text: str, hint: str) -> None:
    with pytest.raises(UsageError, match="--camera: expected") as caught:
        camera_from(text)
    assert hint in str(caught.value)


def test_no_side_looks_along_the_direction_that_is_up() -> None:
    for x, y, z in SIDES.values():
        assert x * x + y * y > 1e-7 * z * z
