"""The rerun archetypes that draw the pieces of a body: one for each kind of piece."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import rerun as rr

from lavendersim.cell import (
    Box,
    Capsule,
    CellHull,
    CellMesh,
    Cone,
    Convex,
    Cylinder,
    Ellipsoid,
    Sphere,
)
from lavendersim.geometry.convex_hull import Polyhedron, convex_hull
from lavendersim.geometry.rotations import rotated
from lavendersim.geometry.shapes import Piece
from lavendersim.replay.shapes import XYZW, Vector

# Of the faces of a movable hull: forces act at surfaces and point into bodies, so they must be seen
# through them.
VEIL = 60
LINE_SHADE = 0.5  # sides of triangles are as bright as this share of their faces


class BodyLook(NamedTuple):
    """How one body is drawn."""

    colour: tuple[int, int, int]
    solid: bool
    label: str
    labelled: bool

    @property
    def words(self) -> dict[str, Any]:
        """The arguments that rerun's solids share."""
        return {
            "colors": [self.colour],
            "fill_mode": "Solid" if self.solid else "TransparentFillMajorWireframe",
            "labels": [self.label],
            "show_labels": self.labelled,
        }


def archetypes(pieces: Sequence[Piece], look: BodyLook) -> dict[str, list[Any]]:
    """Return by kind what draws all pieces of that kind, in the body's frame."""
    kinds = dict.fromkeys(piece.shape.kind for piece in pieces)
    return {kind: _draw([p for p in pieces if p.shape.kind == kind], look) for kind in kinds}


def _draw(pieces: Sequence[Piece], look: BodyLook) -> list[Any]:
    """Return what draws pieces of one kind."""
    shapes = [piece.shape for piece in pieces]
    centres = np.array([piece.position for piece in pieces])
    turns = np.array([piece.orientation[XYZW] for piece in pieces])
    boxes = [shape for shape in shapes if isinstance(shape, Box)]
    if boxes:
        sizes = np.array([box.size for box in boxes])
        return [rr.Boxes3D(half_sizes=sizes / 2, centers=centres, quaternions=turns, **look.words)]
    balls = [shape for shape in shapes if isinstance(shape, Sphere)]
    if balls:
        radii = np.array([ball.radius for ball in balls])
        return [rr.Ellipsoids3D(radii=radii, centers=centres, quaternions=turns, **look.words)]
    ellipsoids = [shape for shape in shapes if isinstance(shape, Ellipsoid)]
    if ellipsoids:
        axes = np.array([one.semi_axes for one in ellipsoids])
        return [rr.Ellipsoids3D(half_sizes=axes, centers=centres, quaternions=turns, **look.words)]
    bars = [shape for shape in shapes if isinstance(shape, Capsule | Cylinder)]
    if not bars:
        return _polyhedra(pieces, [_polyhedron(shape) for shape in shapes], look)
    radii, lengths = np.array([[bar.radius, bar.length] for bar in bars]).T
    size: dict[str, Any] = {"lengths": lengths, "radii": radii, "quaternions": turns}
    if isinstance(bars[0], Cylinder):
        return [rr.Cylinders3D(**size, centers=centres, **look.words)]
    # rerun's capsules begin in their origin
    begins = [
        piece.position - rotated(piece.orientation, np.array([0.0, 0.0, 0.5 * length]))
        for piece, length in zip(pieces, lengths, strict=True)
    ]
    return [rr.Capsules3D(**size, translations=np.array(begins), **look.words)]


def _polyhedron(shape: Convex) -> Polyhedron:
    """Return a hull as it is, any other shape as the hull of its corners."""
    if isinstance(shape, CellHull):
        return Polyhedron(shape.points, shape.faces)
    if isinstance(shape, Cone):  # which may be too flat for a search
        return Polyhedron(shape.corners(), shape.faces())
    return convex_hull(shape.corners())


def _polyhedra(
    pieces: Sequence[Piece], polyhedra: Sequence[Polyhedron], look: BodyLook
) -> list[Any]:
    """Return the faces of all polyhedra as one mesh, and their edges as lines."""
    corners: list[Vector] = []
    triangles: list[tuple[int, int, int]] = []
    edges: list[Vector] = []
    for piece, hull in zip(pieces, polyhedra, strict=True):
        first = sum(len(points) for points in corners)
        local = np.array(hull.points)
        points = piece.position + rotated(piece.orientation, local)
        corners.append(points)
        for face in hull.faces:
            loop = [int(corner) for corner in face]
            edges.append(points[[*loop, loop[0]]])
            fan = pairwise(loop[1:])
            triangles += [(first + loop[0], first + one, first + two) for one, two in fan]
    return _faces(np.concatenate(corners), triangles, edges, look)


def surface(mesh: CellMesh, look: BodyLook) -> list[Any]:
    """Return the triangles of a surface, and their sides as lines."""
    points = np.array(mesh.vertices, float)
    loops = [points[[*triangle, triangle[0]]] for triangle in mesh.triangles]
    red, green, blue = (int(LINE_SHADE * part) for part in look.colour)
    return _faces(points, list(mesh.triangles), loops, look, (red, green, blue))


def _faces(
    corners: Vector,
    triangles: list[tuple[int, int, int]],
    edges: list[Vector],
    look: BodyLook,
    line_colour: tuple[int, int, int] | None = None,
) -> list[Any]:
    # Every triangle has corners of its own, or faces would be shaded as if they were round.
    flat = corners[np.array(triangles).ravel()]
    alpha = 255 if look.solid else VEIL
    mesh = rr.Mesh3D(
        vertex_positions=flat,
        triangle_indices=np.arange(len(flat)).reshape(-1, 3),
        albedo_factor=(*look.colour, alpha),
    )
    lines = rr.LineStrips3D(
        edges,
        colors=[line_colour or look.colour],
        radii=rr.Radius.ui_points(1.5),
        labels=[look.label],
        show_labels=look.labelled,
    )
    return [mesh, lines]
