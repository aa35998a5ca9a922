"""An ellipsoid's mass, by its closed form and by that of a ball; what is none is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lavendersim.cell.shapes import Ellipsoid, Sphere
from lavendersim.errors import LavenderError
from lavendersim.experiment import load_experiment_text


def test_mass_and_moments_are_those_of_the_integral() -> None:
    """Over a ball: x -> (a x, b y, c z), so that <x^2> = a^2/5."""
    a, b, c = 0.2, 0.5, 0.3
    found = Ellipsoid(kind="ellipsoid", semi_axes=(a, b, c)).homogeneous()
    # Midpoint sums over the octant of the ball, in polar coordinates: (1/400)^2 of the value.
    grid = (np.arange(200) + 0.5) / 200
    r, u, turn = np.meshgrid(grid, grid, 0.5 * math.pi * grid, indexing="ij")
    across = np.sqrt(1.0 - u * u)
    x, y, z = a * r * across * np.cos(turn), b * r * across * np.sin(turn), c * r * u
    cell = a * b * c * r * r * 0.5 * math.pi / 200**3
    assert found.volume == pytest.approx(8.0 * cell.sum(), rel=2e-5)
    moments = [((p * p + q * q) * cell).sum() / cell.sum() for p, q in ((y, z), (x, z), (x, y))]
    assert found.moments == pytest.approx(moments, rel=2e-5)


def test_equal_axes_are_a_ball() -> None:
    ball, round_one = (
        Sphere(kind="sphere", radius=0.3),
        Ellipsoid(kind="ellipsoid", semi_axes=(0.3, 0.3, 0.3)),
    )
    assert round_one.homogeneous().moments == pytest.approx(ball.homogeneous().moments, rel=4e-16)
    assert round_one.homogeneous().volume == pytest.approx(ball.homogeneous().volume, rel=4e-16)
    assert round_one.bounding_radius() == ball.bounding_radius()


@pytest.mark.parametrize("axes", ["[0.1, 0, 0.2]", "[0.1, -1, 0.2]", "[0.1, 0.2]", "0.3"])
def test_axes_that_span_no_body_are_refused_where_they_stand(axes: str) -> None:
    text = f"""
scene:
  bodies:
    it: {{shape: {{kind: ellipsoid, semi_axes: {axes}}}, mass: 1, position: [0, 0, 0]}}
duration: 1
"""
    with pytest.raises(LavenderError, match=r"a\.yaml:4:\d+: .*semi_axes"):
        load_experiment_text(text, "a.yaml")


def test_it_just_fits_the_box_of_its_size() -> None:
    found = Ellipsoid(kind="ellipsoid", semi_axes=(0.2, 0.5, 0.3))
    for axis, edge in zip(np.eye(3), found.size, strict=True):
        assert found.extent(tuple(axis)) == 0.5 * edge
