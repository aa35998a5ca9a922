"""Shapes in their principal frames: points and inertia turned back are those as written."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from lavendersim.cell.shapes import Box, CellCompound, CellHull, Sphere
from lavendersim.experiment.models.shapes import AxisAngle, Compound, Hull, Part
from lavendersim.experiment.resolve.placement import SceneError
from lavendersim.experiment.resolve.shape import quaternion_of, resolve_shape


def matrix(quaternion) -> np.ndarray:
    """Rotation by the sandwich product with each unit vector, written out."""
    w, *v = quaternion
    v = np.array(v)
    return np.array([
        (w * w - v @ v) * e + 2 * (v @ e) * v + 2 * w * np.cross(v, e) for e in np.eye(3)
    ]).T  # fmt: skip


TURN = AxisAngle(axis=(1 / 3, 2 / 3, 2 / 3), degrees=50.0)
ROTATION = matrix(quaternion_of(TURN))
HALF = np.array([0.5, 1.0, 1.5])
CORNERS = np.array(list(itertools.product(*zip(-HALF, HALF, strict=True)))) @ ROTATION.T
CENTRE = np.array([3.0, -1.0, 2.0])
BLOCK = Hull(kind="hull", points=tuple(map(tuple, CORNERS + CENTRE)))
# edges 1, 2, 3: volume 6, moments (b^2 + c^2)/12 per mass
MOMENTS = np.array([13.0, 10.0, 5.0]) / 12.0


def test_a_turned_block_of_points_has_the_moments_and_the_frame_of_the_block() -> None:
    solid = resolve_shape(BLOCK)
    assert isinstance(solid.shape, CellHull)
    assert solid.volume == pytest.approx(6.0, rel=1e-14)
    assert sorted(solid.inertia_per_mass) == pytest.approx(sorted(MOMENTS), rel=1e-13)
    axes = matrix(solid.axes)
    tensor = axes @ np.diag(solid.inertia_per_mass) @ axes.T
    assert tensor == pytest.approx(ROTATION @ np.diag(MOMENTS) @ ROTATION.T, abs=1e-13)
    back = np.array(solid.shape.points) @ axes.T + solid.shape.centre
    found = sorted(tuple(point) for point in back.round(9) + 0.0)
    assert found == sorted(tuple(point) for point in (CORNERS + CENTRE).round(9) + 0.0)


def test_two_cubes_side_by_side_are_one_block() -> None:
    """Steiner's theorem, taken by hand: the compound of two unit cubes is a block 2 x 1 x 1."""
    cube = Box(kind="box", size=(1.0, 1.0, 1.0))
    parts = (Part(shape=cube, position=(5.0, 0.0, 0.0)), Part(shape=cube, position=(6.0, 0.0, 0.0)))
    solid = resolve_shape(Compound(kind="compound", parts=parts))
    assert isinstance(solid.shape, CellCompound)
    assert solid.shape.centre == pytest.approx((5.5, 0.0, 0.0))
    assert solid.volume == pytest.approx(2.0)
    axes = matrix(solid.axes)
    tensor = axes @ np.diag(solid.inertia_per_mass) @ axes.T
    assert tensor == pytest.approx(np.diag([2.0, 5.0, 5.0]) / 12.0, abs=1e-15)
    places = np.array([part.position for part in solid.shape.parts]) @ axes.T
    assert places == pytest.approx(np.array([[-0.5, 0, 0], [0.5, 0, 0]]), abs=1e-15)


def test_a_turned_hull_in_a_compound_keeps_its_points_in_the_world() -> None:
    part = Part(shape=BLOCK, position=(1.0, 2.0, 3.0), orientation=TURN)
    solid = resolve_shape(Compound(kind="compound", parts=(part,)))
    (inner,) = solid.shape.parts
    axes, turn = matrix(solid.axes), matrix(inner.orientation)
    points = np.array(inner.shape.points) @ turn.T + inner.position
    world = points @ axes.T + solid.shape.centre
    expected = CORNERS @ ROTATION.T + np.array([1.0, 2.0, 3.0])  # a part stands by its centre
    order = lambda rows: sorted(tuple(row) for row in rows.round(9) + 0.0)  # noqa: E731
    assert order(world) == order(expected)


def test_a_ball_is_its_own_frame() -> None:
    ball = Sphere(kind="sphere", radius=0.5)
    shape, volume, moments, axes = resolve_shape(ball)
    assert shape is ball
    assert volume == pytest.approx(math.pi / 6.0)
    assert moments == pytest.approx((0.1, 0.1, 0.1))  # 2/5 r^2
    assert axes == (1.0, 0.0, 0.0, 0.0)


def test_a_flat_hull_is_refused_by_its_path() -> None:
    flat = Hull(kind="hull", points=((0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)))
    with pytest.raises(SceneError, match="lie in one plane") as alone:
        resolve_shape(flat)
    assert alone.value.path == ("points",)
    parts = (Part(shape=Sphere(kind="sphere", radius=1.0)), Part(shape=flat))
    with pytest.raises(SceneError) as below:
        resolve_shape(Compound(kind="compound", parts=parts))
    assert below.value.path == ("parts", 1, "shape", "points")
