"""Resolving surfaces of triangles: checked vertices and triangles, of a height field its own."""

from __future__ import annotations

from lavendersim.cell.shapes import CellMesh
from lavendersim.experiment.models.meshes import MOST_TRIANGLES, HeightField, Mesh
from lavendersim.experiment.resolve.placement import SceneError
from lavendersim.quantities.quantity import LARGEST, Vector3

Triangles = tuple[tuple[int, int, int], ...]


def resolve_surface(shape: Mesh | HeightField) -> CellMesh:
    """Return a surface whose triangles hang together; raises SceneError, path from the shape."""
    from lavendersim.geometry.triangle_mesh import MeshError, surface_of  # few scenes need it

    if isinstance(shape, HeightField):
        vertices, triangles = _of_heights(shape)
    else:
        vertices, triangles = _scaled(shape), shape.triangles or ()
        for number, triangle in enumerate(triangles):
            for corner, row in enumerate(triangle):
                if row >= len(vertices):
                    sentence = f"there are {len(vertices)} vertices, counted from 0; found {row}"
                    raise SceneError(("triangles", number, corner), sentence)
    try:
        surface_of(vertices, triangles)
    except MeshError as error:
        if isinstance(shape, Mesh):
            where: tuple[str | int, ...] = ("triangles", error.triangle)
            raise SceneError(where, f"triangle {error.triangle}: {error}") from None
        row, column = divmod(error.triangle // 2, len(shape.heights[0]) - 1)
        cell = f"a triangle between rows {row} and {row + 1}, heights {column} and {column + 1}"
        raise SceneError(("heights",), f"{cell}: {error}") from None
    return CellMesh(kind="mesh", vertices=vertices, triangles=triangles)


def _scaled(mesh: Mesh) -> tuple[Vector3, ...]:
    """Return the vertices of a mesh [m]; raises SceneError where one is too far away."""
    vertices, scale = mesh.vertices or (), mesh.scale
    if scale == 1.0:
        return vertices
    if not scale * max(abs(x) for vertex in vertices for x in vertex) <= LARGEST:
        raise SceneError(("scale",), f"scale: expected vertices within {LARGEST:g} [m]")
    return tuple((scale * x, scale * y, scale * z) for x, y, z in vertices)


def _of_heights(field: HeightField) -> tuple[tuple[Vector3, ...], Triangles]:
    """Return the points of the grid, x after x, and two triangles a cell.

    Diagonals of neighbouring cells meet, or lean the other way: no direction is preferred.
    """
    rows, columns = len(field.heights), len(field.heights[0])
    for number, row in enumerate(field.heights):
        if len(row) != columns:
            sentence = f"expected {columns} heights, as in the first row, found {len(row)}"
            raise SceneError(("heights", number), sentence)
    count = 2 * (rows - 1) * (columns - 1)
    if count > MOST_TRIANGLES:
        sentence = f"heights: expected at most {MOST_TRIANGLES} triangles, found {count}"
        raise SceneError(("heights",), sentence)
    dx, dy = field.spacing
    vertices = tuple(
        ((i - 0.5 * (rows - 1)) * dx, (j - 0.5 * (columns - 1)) * dy, height)
        for i, row in enumerate(field.heights)
        for j, height in enumerate(row)
    )
    triangles: list[tuple[int, int, int]] = []
    for i in range(rows - 1):
        for j in range(columns - 1):
            a, b = i * columns + j, i * columns + j + 1
            c, d = a + columns, b + columns
            if (i + j) % 2 == 0:
                triangles += [(a, c, d), (a, d, b)]
            else:
                triangles += [(a, c, b), (c, d, b)]
    return vertices, tuple(triangles)
