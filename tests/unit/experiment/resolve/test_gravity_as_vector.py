"""Gravity by its magnitude, its vector or its tilt: the vector that a cell has."""

from __future__ import annotations

import math

import pytest

from lavendersim.experiment import load_experiment_text

TEXT = """\
scene:
  gravity: {gravity}
  bodies: {{ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, position: [0, 0, 1]}}}}
duration: 1
"""


def gravity(specified: str) -> list[float]:
    cell = load_experiment_text(TEXT.format(gravity=specified), "forms.yaml").cells()[0]
    return list(cell.config.scene.gravity)


def test_tilt_of_zero_is_plain_gravity() -> None:
    assert gravity("{}") == [0.0, 0.0, -9.81]
    assert gravity("{magnitude: 3.7}") == [0.0, 0.0, -3.7]


@pytest.mark.parametrize("slope", [0.0, 0.4995, 2.0])
@pytest.mark.parametrize("azimuth", [0.0, 45.0, 157.5])
def test_slope_is_the_ratio_of_gravity_along_and_into_the_floor(
    slope: float, azimuth: float
) -> None:
    x, y, z = gravity(f"{{slope: {slope}, azimuth_degrees: {azimuth}}}")
    # each component: three roundings
    assert math.hypot(x, y) / -z == pytest.approx(slope, rel=1e-15)
    assert math.sqrt(x * x + y * y + z * z) == pytest.approx(9.81, rel=1e-15)
    if slope:
        assert math.degrees(math.atan2(y, x)) == pytest.approx(azimuth, abs=1e-13)


def test_tilt_in_degrees_is_the_slope_of_its_tangent() -> None:
    tilted = gravity("{magnitude: 5, tilt_degrees: 30, azimuth_degrees: 90}")
    assert tilted == pytest.approx([0.0, 2.5, -2.5 * math.sqrt(3.0)], abs=1e-15)
