"""A force is the simplest kind where it is constant in world axes, at the centre of mass."""

from __future__ import annotations

from typing import Any

import pytest

from lavendersim.cell.scene import CellForce

FORCE: dict[str, Any] = {
    **{"body": "ball", "from": 0.0, "to": 1.0},
    **{"force": (1.0, 0.0, 0.0), "torque": (0.0, 0.0, 0.0)},
}


def test_a_force_without_more_is_constant_at_the_centre() -> None:
    assert CellForce(**FORCE).constant_at_centre


@pytest.mark.parametrize("more", [{"frame": "body"}, {"point": (0.0, 0.0, 0.1)}])
def test_a_force_that_turns_or_has_a_lever_is_not(more: dict[str, Any]) -> None:
    assert not CellForce(**FORCE, **more).constant_at_centre
