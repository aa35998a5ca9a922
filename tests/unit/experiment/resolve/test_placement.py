"""A release puts the surface of a body where its clearance and phase say, above any plane."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from lavendersim.cell.body import Release
from lavendersim.cell.shapes import Box, Plane, Sphere
from lavendersim.experiment.resolve.placement import SceneError, released_position
from lavendersim.geometry.quaternions import from_axis_angle
from lavendersim.geometry.support import extent_against
from lavendersim.geometry.vectors import unit

DOWN = (0.0, 0.0, -9.81)
UPRIGHT = (1.0, 0.0, 0.0, 0.0)
BALL = Sphere(kind="sphere", radius=0.1)
BOX = Box(kind="box", size=(0.2, 0.4, 0.6))
STEP = Fraction(1, 240)


def place(release: Release, plane: Plane, shape: Sphere | Box = BALL) -> tuple[float, ...]:
    return released_position(release, plane, shape, UPRIGHT, DOWN, STEP)


def test_clearance_is_between_the_surfaces() -> None:
    floor = Plane(kind="plane", offset=0.5)
    assert place(Release(above="floor", clearance=1.0), floor) == (0.0, 0.0, 1.6)
    assert place(Release(above="floor", clearance=1.0), floor, BOX) == (0.0, 0.0, 1.8)


def test_phase_of_one_is_the_fall_of_one_step_at_impact() -> None:
    floor = Plane(kind="plane")
    start = place(Release(above="floor", clearance=1.0), floor)[2]
    shifted = place(Release(above="floor", clearance=1.0, phase=Fraction(1)), floor)[2]
    # sqrt(2 g h) dt; the difference of two numbers near 1 has an error of 2^-52
    assert shifted - start == pytest.approx(math.sqrt(2 * 9.81 * 1.0) / 240, abs=2**-51)


def test_clearance_above_a_slope_is_along_its_normal() -> None:
    normal = unit((0.0, 1.0, 1.0))
    slope = Plane(kind="plane", normal=normal, offset=0.2)
    for at in (None, (0.3, -0.4)):
        centre = place(Release(above="slope", clearance=0.7, at=at), slope)
        distance = sum(n * c for n, c in zip(normal, centre, strict=True))
        assert distance == pytest.approx(0.2 + 0.7 + 0.1, abs=1e-15)
        assert at is None or centre[:2] == at


def test_phase_needs_gravity_towards_the_plane() -> None:
    ceiling = Plane(kind="plane", normal=(0.0, 0.0, -1.0), offset=-3.0)
    with pytest.raises(SceneError, match="does not pull towards ceiling"):
        place(Release(above="ceiling", clearance=1.0, phase=Fraction(1, 2)), ceiling)


@pytest.mark.parametrize(
    ("axis", "degrees", "expected"),
    [
        ((0.0, 0.0, 1.0), 45.0, 0.3),  # about z: still the half height
        ((1.0, 0.0, 0.0), 90.0, 0.2),  # the y edge stands up
        ((0.0, 1.0, 0.0), 90.0, 0.1),  # the x edge stands up
        ((1.0, 0.0, 0.0), 45.0, (0.2 + 0.3) / math.sqrt(2.0)),
    ],
)
def test_reach_of_a_turned_box(
    axis: tuple[float, float, float], degrees: float, expected: float
) -> None:
    turned = from_axis_angle(axis, degrees)
    assert extent_against(BOX, turned, (0.0, 0.0, 1.0)) == pytest.approx(expected, abs=4e-16)


def test_unit_vector_is_kept_bit_for_bit() -> None:
    assert unit((0.6, 0.8, 0.0)) == (0.6, 0.8, 0.0)


@pytest.mark.parametrize("scale", [1e-300, 1.0, 3.7, 1e300])
def test_unit_of_any_length(scale: float) -> None:
    x, y, z = unit((1.0 * scale, 2.0 * scale, 2.0 * scale))
    assert (x, y, z) == pytest.approx((1 / 3, 2 / 3, 2 / 3), rel=4e-16)
