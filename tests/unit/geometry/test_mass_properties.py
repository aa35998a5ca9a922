"""Volumes, centres of mass and inertias against integrals that are done another way."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss

from lavendersim.cell.shapes import Box, Capsule, Cylinder, Sphere
from lavendersim.experiment.models.shapes import Compound, Hull, Part
from lavendersim.experiment.resolve.shape import resolve_shape
from lavendersim.geometry.convex_hull import convex_hull
from lavendersim.geometry.mass_properties import Solid, homogeneous, polyhedron

CORNERS = [(x, y, z) for x in (0.0, 0.4) for y in (0.0, 0.6) for z in (0.0, 1.0)]
BOX = Box(kind="box", size=(0.4, 0.6, 1.0))
NODES, WEIGHTS = leggauss(4)  # exact for polynomials up to degree 7; z^2 rho^2 has degree 4


def revolved(pieces) -> tuple[float, float, float]:
    """Volume, J_x, J_z of a solid of revolution: discs of squared radius rho2(z) between ends."""
    volume = across = along = 0.0
    for low, high, rho2 in pieces:
        z = 0.5 * (low + high) + 0.5 * (high - low) * NODES
        slices = 0.5 * (high - low) * WEIGHTS * math.pi * rho2(z)
        volume += slices.sum()
        across += (slices * (rho2(z) / 4.0 + z * z)).sum()
        along += (slices * rho2(z) / 2.0).sum()
    return volume, across / volume, along / volume


def rod(radius: float, length: float, ends: bool):
    half = 0.5 * length
    bar = (-half, half, lambda z: np.full_like(z, radius**2))
    if not ends:
        return [bar]
    low = (-half - radius, -half, lambda z: radius**2 - (z + half) ** 2)
    high = (half, half + radius, lambda z: radius**2 - (z - half) ** 2)
    return [bar, low, high]


@pytest.mark.parametrize(
    ("shape", "pieces"),
    [
        (Sphere(kind="sphere", radius=0.3), rod(0.3, 0.0, True)[1:]),
        (Cylinder(kind="cylinder", radius=0.3, length=0.7), rod(0.3, 0.7, False)),
        (Capsule(kind="capsule", radius=0.3, length=0.7), rod(0.3, 0.7, True)),
        (Capsule(kind="capsule", radius=0.02, length=2.0), rod(0.02, 2.0, True)),
    ],
)
def test_round_shapes_are_the_sum_of_their_discs(shape, pieces) -> None:
    found = shape.homogeneous()
    volume, across, along = revolved(pieces)
    # a few dozen roundings of numbers of one sign
    assert found.volume == pytest.approx(volume, rel=1e-14)
    assert found.moments == pytest.approx([across, across, along], rel=1e-14)


def assert_equal(one: Solid, other: Solid, tolerance: float = 4e-15) -> None:
    """Sums of a few dozen terms of order one: 1e-16 each."""
    assert one.volume == pytest.approx(other.volume, rel=tolerance)
    np.testing.assert_allclose(one.centre, other.centre, atol=tolerance)
    np.testing.assert_allclose(one.inertia, other.inertia, atol=tolerance)


def test_hull_of_a_boxs_corners_is_the_box() -> None:
    block = homogeneous(*BOX.homogeneous())
    hull = polyhedron(convex_hull(CORNERS))
    assert_equal(hull, Solid(block.volume, (0.2, 0.3, 0.5), block.inertia))


def test_regular_prism_of_many_sides_has_the_closed_form_of_its_polygon() -> None:
    # regular n-gon, circumradius r, cut into triangles: V = n/2 r^2 sin(2 pi/n) l and
    # J_z = r^2/6 (2 + cos(2 pi/n)), J_x = J_z/2 + l^2/12
    n, r, length = 24, 0.3, 0.8
    ring = [
        (r * math.cos(2 * math.pi * k / n), r * math.sin(2 * math.pi * k / n)) for k in range(n)
    ]
    solid = polyhedron(convex_hull([(x, y, z) for x, y in ring for z in (0.0, length)]))
    around = r * r / 6.0 * (2.0 + math.cos(2 * math.pi / n))
    across = around / 2.0 + length**2 / 12.0
    volume = n / 2 * r * r * math.sin(2 * math.pi / n) * length
    exact = Solid(volume, (0, 0, 0.4), ((across, 0, 0), (0, across, 0), (0, 0, around)))
    assert_equal(solid, exact)


def test_corner_tetrahedron() -> None:
    # conv(0, e_x, e_y, e_z): V = 1/6, centre 1/4, covariance of a simplex of 4 corners with
    # variance 3/80 and covariance -1/80 of its coordinates; J = tr(C) 1 - C
    solid = polyhedron(convex_hull([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]))
    cut = [[6 / 80 if i == j else 1 / 80 for j in range(3)] for i in range(3)]
    assert_equal(solid, Solid(1 / 6, (0.25, 0.25, 0.25), tuple(map(tuple, cut))))


def test_halves_of_a_box_are_the_box() -> None:
    """Cut in two along y, one half turned in itself: as the box, but for its place."""
    half = Box(kind="box", size=(0.4, 0.3, 1.0))
    turned = {"orientation": (0.0, 0.0, 0.0, 1.0)}  # by 180 degrees about z: the same half
    parts = (
        Part(shape=half, position=(2.0, -0.15, 1.0)),
        Part(shape=half, position=(2.0, 0.15, 1.0), **turned),
    )
    whole = resolve_shape(Compound(kind="compound", parts=parts))
    block = resolve_shape(BOX)
    assert whole.volume == pytest.approx(block.volume, rel=1e-15)
    assert whole.inertia_per_mass == pytest.approx(block.inertia_per_mass, rel=4e-15)
    assert whole.axes == (1.0, 0.0, 0.0, 0.0)
    assert whole.shape.centre == pytest.approx((2.0, 0.0, 1.0), abs=1e-15)


def test_mass_of_a_far_part_counts_by_its_volume() -> None:
    # 1 m^3 at x = 0 and 8 m^3 at x = 9: centre at 8, J_z = sum of shares (own + distance^2)
    small, large = (Box(kind="box", size=(s, s, s)) for s in (1.0, 2.0))
    parts = (Part(shape=small), Part(shape=large, position=(9.0, 0.0, 0.0)))
    solid = resolve_shape(Compound(kind="compound", parts=parts))
    assert solid.shape.centre == pytest.approx((8.0, 0.0, 0.0), abs=2e-15)
    own = 1 / 9 * 1 / 6 + 8 / 9 * 4 / 6
    assert solid.inertia_per_mass == pytest.approx((own, own + 8.0, own + 8.0), rel=1e-15)


def test_hull_part_of_a_compound_is_the_hull_alone() -> None:
    points = tuple((x + 0.1 * y, y, z + 0.3 * x) for x, y, z in CORNERS)
    alone = resolve_shape(Hull(kind="hull", points=points))
    part = Part(shape=Hull(kind="hull", points=points), position=(3.0, -1.0, 2.0))
    within = resolve_shape(Compound(kind="compound", parts=(part,)))
    assert within.volume == alone.volume
    assert within.inertia_per_mass == pytest.approx(alone.inertia_per_mass, rel=1e-14)
    assert within.shape.centre == pytest.approx((3.0, -1.0, 2.0), abs=1e-15)
