"""Angles between orientations, near 0 and at half a turn."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.geometry.poses import turns


@pytest.mark.parametrize("angle", [1e-12, 1e-3, 1.0, np.pi])
def test_an_angle_keeps_its_digits(angle: float) -> None:
    """About x: (cos(a/2), sin(a/2), 0, 0). cos(a/2) rounds by 1e-16, which is 4e-16 of an angle."""
    pose = np.array([0, 0, 0, 1.0, 0, 0, 0])
    turned = np.array([0, 0, 0, np.cos(angle / 2), np.sin(angle / 2), 0, 0])
    assert turns(pose, turned) == pytest.approx(angle, rel=1e-15, abs=1e-15)
    assert turns(pose, np.where(np.arange(7) < 3, 0, -turned)) == pytest.approx(
        angle, rel=1e-15, abs=1e-15
    )
