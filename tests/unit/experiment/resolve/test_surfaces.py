"""Heights become two triangles a cell, whose normals point up; what is no surface is refused."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.experiment.models.meshes import HeightField, Mesh
from lavendersim.experiment.resolve.placement import SceneError
from lavendersim.experiment.resolve.surfaces import resolve_surface
from lavendersim.geometry.triangle_mesh import surface_of


def field(heights) -> HeightField:
    return HeightField(kind="height_field", heights=heights, spacing=(0.5, 0.25))


def test_a_height_field_is_centred_and_has_two_triangles_a_cell() -> None:
    heights = ((0.0, 0.1, 0.3), (0.2, -0.4, 0.0))
    mesh = resolve_surface(field(heights))
    places = np.array(mesh.vertices).reshape(2, 3, 3)
    np.testing.assert_array_equal(places[:, :, 2], heights)
    np.testing.assert_array_equal(places[:, 0, 0], (-0.25, 0.25))
    np.testing.assert_array_equal(places[0, :, 1], (-0.25, 0.0, 0.25))
    surface = surface_of(np.array(mesh.vertices), np.array(mesh.triangles))
    assert len(mesh.triangles) == 4
    assert (surface.normals[:, 2] > 0.0).all()
    assert (surface.beyond >= 0).sum() == 6  # three sides within, seen from both


def test_rows_of_other_lengths_are_refused() -> None:
    with pytest.raises(SceneError, match="expected 2 heights, as in the first row, found 3"):
        resolve_surface(field(((0.0, 0.0), (0.0, 0.0, 0.0))))


def test_a_cell_at_fault_is_named_by_its_place_in_heights() -> None:
    """A slope of 1e9 makes a triangle that is a line but for round-off."""
    heights = ((0.0, 0.0, 0.0), (0.0, 0.0, 1e9))
    with pytest.raises(SceneError, match=r"between rows 0 and 1, heights 1 and 2: .* a line") as it:
        resolve_surface(field(heights))
    assert it.value.path == ("heights",)


def mesh(*triangles) -> Mesh:
    vertices = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0))
    return Mesh(kind="mesh", vertices=vertices, triangles=triangles)


@pytest.mark.parametrize(
    ("triangles", "path", "sentence"),
    [
        (((0, 1, 4),), ("triangles", 0, 2), "there are 4 vertices, counted from 0; found 4"),
        (((0, 1, 2), (0, 1, 3)), ("triangles", 1), "triangle 1: its corners run the other way"),
        (((0, 0, 2),), ("triangles", 0), "triangle 0: its corners lie on a line"),
    ],
)
def test_the_triangle_at_fault_is_named(triangles, path, sentence: str) -> None:
    with pytest.raises(SceneError, match=sentence) as caught:
        resolve_surface(mesh(*triangles))
    assert caught.value.path == path
