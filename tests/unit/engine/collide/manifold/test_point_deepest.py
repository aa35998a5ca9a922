"""Of the points of a manifold the deepest comes first."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted, records

from lavendersim.engine.collide.manifold.point import keep_four
from lavendersim.engine.records import POINT, dtype
from lavendersim.engine.vectors import Vec3


@pytest.mark.parametrize("place", range(6))
def test_the_deepest_comes_first_wherever_it_stood(place: int) -> None:
    """In the middle of a pentagon, where no area is made by it."""
    angle = 2.0 * np.pi * np.arange(5) / 5.0
    corners = np.column_stack([np.cos(angle), np.sin(angle)])
    phi = np.full(6, -1.0)
    phi[place] = -2.0
    points = np.zeros(16, dtype(POINT))
    points["x"][:6], points["y"][:6] = np.insert(corners, place, 0.0, axis=0).T
    points["phi"][:6], points["feature"][:6] = phi, np.arange(6)
    assert interpreted(keep_four)(records(points), 6, Vec3(0.0, 0.0, 1.0)) == 4
    assert points["feature"][0] == place


@pytest.mark.parametrize("place", range(1, 6))
def test_the_farthest_from_it_comes_second(place: int) -> None:
    """On a line with the deepest, where no third point makes an area."""
    points = np.zeros(16, dtype(POINT))
    points["x"][:6] = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]
    points["x"][place], points["phi"][0] = 2.0, -1.0
    points["feature"][:6] = np.arange(6)
    interpreted(keep_four)(records(points), 6, Vec3(0.0, 0.0, 1.0))
    assert points["feature"][:2].tolist() == [0, place]
