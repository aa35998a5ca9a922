"""What convex shapes declare of themselves agrees with itself, whatever the shape."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lavendersim.cell.shapes import (
    PRIMITIVES,
    Box,
    Capsule,
    CellHull,
    Cone,
    Cylinder,
    Ellipsoid,
    Sphere,
)

TETRAHEDRON = ((-0.1, -0.2, -0.1), (0.3, -0.2, -0.1), (-0.1, 0.6, -0.1), (-0.1, -0.2, 0.3))
SHAPES = {
    "sphere": Sphere(kind="sphere", radius=0.3),
    "box": Box(kind="box", size=(0.2, 0.5, 0.9)),
    "capsule": Capsule(kind="capsule", radius=0.2, length=0.7),
    "cylinder": Cylinder(kind="cylinder", radius=0.4, length=0.3),
    "cone": Cone(kind="cone", radius=0.3, height=0.7),
    "ellipsoid": Ellipsoid(kind="ellipsoid", semi_axes=(0.2, 0.5, 0.3)),
    "hull": CellHull(
        kind="hull",
        points=TETRAHEDRON,
        faces=((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)),
        centre=(0.0, 0.0, 0.0),
        axes=(1.0, 0.0, 0.0, 0.0),
    ),
}
DIRECTIONS = np.random.default_rng(5).normal(size=(100, 3))
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1)[:, None]


def test_every_primitive_is_here() -> None:
    assert {type(shape) for shape in SHAPES.values()} == {*PRIMITIVES, CellHull}


@pytest.mark.parametrize("name", SHAPES)
def test_corners_span_the_shape(name: str) -> None:
    shape = SHAPES[name]
    corners = np.array(shape.corners())
    for direction in DIRECTIONS:
        extent = shape.extent(tuple(direction))
        reached = float((corners @ direction).max())
        assert reached <= extent * (1.0 + 1e-14)
        # Between circles at 45 degrees a ball's corners reach cos(22.5 degrees) of it at least.
        assert reached >= math.cos(math.radians(22.5)) * extent


@pytest.mark.parametrize("name", SHAPES)
def test_no_direction_reaches_beyond_the_bounding_sphere(name: str) -> None:
    shape = SHAPES[name]
    extents = [shape.extent(tuple(direction)) for direction in DIRECTIONS]
    assert max(extents) <= shape.bounding_radius() * (1.0 + 1e-14)
    widths = [shape.extent(tuple(n)) + shape.extent(tuple(-n)) for n in np.eye(3)]
    assert min(widths) == pytest.approx(shape.thickness(), rel=1e-14)


@pytest.mark.parametrize("name", [name for name in SHAPES if name != "hull"])
def test_the_farthest_point_is_as_far_as_the_support(name: str) -> None:
    shape = SHAPES[name]
    for direction in DIRECTIONS:
        point = np.array(shape.farthest_point(tuple(direction)))
        assert point @ direction == pytest.approx(shape.extent(tuple(direction)), rel=1e-14)


@pytest.mark.parametrize("name", ["box", "capsule", "cylinder"])
def test_what_lies_flat_is_farthest_in_its_middle(name: str) -> None:
    shape = SHAPES[name]
    assert shape.farthest_point((1.0, 0.0, 0.0))[1:] == (0.0, 0.0)
    assert shape.farthest_point((0.0, 0.0, -1.0))[:2] == (0.0, 0.0)


def test_a_hull_has_no_closed_form_of_its_lowest_point() -> None:
    with pytest.raises(ValueError, match="lowest point of a hull"):
        SHAPES["hull"].farthest_point((0.0, 0.0, 1.0))
