"""The URDF <visual> elements that show a shape in its body.

URDF knows boxes, spheres and cylinders without files. A capsule is a cylinder and two spheres. Any
other shape is drawn by its edges or those of its corners' hull, a cavity by circles, a mesh by the
sides of its triangles, thin cylinders: a mesh would be a file beside the log. Shapes are given in
the body's frame, so nothing here knows where the body is, but for planes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.cell import (
    Bowl,
    Box,
    Capsule,
    Cavity,
    CellCompound,
    CellHull,
    CellMesh,
    CellShape,
    CellSimple,
    Cone,
    Cylinder,
    Plane,
    Sphere,
)
from lavendersim.cell.shapes.shape import ROUND, ball, circle
from lavendersim.geometry.convex_hull import Polyhedron, convex_hull
from lavendersim.geometry.rotations import frame_along, rotation_matrix

PLANE_THICKNESS = 0.02  # m; thin beside any body, thick enough to be seen edge-on
MOST_SIDES = 2000  # of a mesh that are drawn
SIDE_SHARE = 0.002  # radius of a drawn side of a triangle by the reach of its mesh
EDGE_SHARE = 0.01  # radius of a drawn edge by the reach of its hull

Matrix = NDArray[np.float64]


class Visual(NamedTuple):
    """One primitive: its URDF element, where its centre stands in the body and how it is turned."""

    geometry: str
    position: Matrix
    rotation: Matrix

    def within(self, position: Matrix, rotation: Matrix) -> Visual:
        """Return the same as part of something that is placed itself."""
        return Visual(self.geometry, position + rotation @ self.position, rotation @ self.rotation)

    @property
    def origin(self) -> str:
        """The <origin> element."""
        angles = numbers(roll_pitch_yaw(self.rotation))
        return f'<origin xyz="{numbers(self.position)}" rpy="{angles}"/>'


def visuals(shape: CellShape, pose: Matrix, plane_side: float) -> list[Visual]:
    """Return what shows a shape.

    pose: of the body, x y z qw qx qy qz. plane_side: of the square that stands for a plane [m].
    """
    if isinstance(shape, Cavity):
        return list(_circles(shape))
    if isinstance(shape, CellMesh):
        return list(_sides(shape))
    if isinstance(shape, Plane):
        return [_plane(shape, pose, plane_side)]
    if isinstance(shape, CellCompound):
        return [
            visual.within(np.array(part.position, float), rotation_matrix(part.orientation))
            for part in shape.parts
            for visual in _solid(part.shape)
        ]
    return list(_solid(shape))


def _solid(shape: CellSimple) -> Iterator[Visual]:
    match shape:
        case Sphere():
            yield _centred(_sphere(shape.radius))
        case Box():
            yield _centred(f'<box size="{numbers(shape.size)}"/>')
        case Cylinder():
            yield _centred(_cylinder(shape.radius, shape.length))
        case Capsule():
            yield _centred(_cylinder(shape.radius, shape.length))
            for end in (-0.5, 0.5):
                place = np.array([0.0, 0.0, end * shape.length])
                yield Visual(_sphere(shape.radius), place, np.eye(3))
        case CellHull():
            yield from _edges(Polyhedron(shape.points, shape.faces))
        case Cone():
            yield from _edges(Polyhedron(shape.corners(), shape.faces()))
        case _:
            yield from _edges(convex_hull(shape.corners()))


def _edges(hull: Polyhedron) -> Iterator[Visual]:
    points = np.array(hull.points, float)
    radius = EDGE_SHARE * float(np.linalg.norm(points, axis=1).max())
    yield from _bars(points, _pairs(hull.faces), radius)


def _sides(mesh: CellMesh) -> Iterator[Visual]:
    """Yield thin bars along the sides of triangles, of many those of some, evenly among them."""
    points = np.array(mesh.vertices, float)
    sides = _pairs(mesh.triangles)
    stride = 1 + (len(sides) - 1) // MOST_SIDES
    radius = SIDE_SHARE * mesh.bounding_radius()
    yield from _bars(points, sides[::stride], radius)


def _pairs(faces: Sequence[Sequence[int]]) -> list[tuple[int, int]]:
    """Return the corners of every edge of faces, each edge once."""
    pairs = {
        (min(one, other), max(one, other))
        for face in faces
        for one, other in zip(face, [*face[1:], face[0]], strict=True)
    }
    return sorted(pairs)


def _bars(points: Matrix, pairs: Sequence[tuple[int, int]], radius: float) -> Iterator[Visual]:
    for one, other in pairs:
        along = points[other] - points[one]
        length = float(np.linalg.norm(along))
        middle = 0.5 * (points[one] + points[other])
        yield Visual(_cylinder(radius, length), middle, frame_along(along / length))


def _plane(shape: Plane, pose: Matrix, side: float) -> Visual:
    """Return a thin box whose top is the plane, placed against the plane body's own pose."""
    normal = np.array(shape.normal, float)
    normal /= np.linalg.norm(normal)
    centre = normal * (shape.offset - PLANE_THICKNESS / 2)
    body = rotation_matrix(pose[3:])
    box = f'<box size="{numbers((side, side, PLANE_THICKNESS))}"/>'
    return Visual(box, body.T @ (centre - pose[:3]), body.T @ frame_along(normal))


def _circles(cavity: Cavity) -> Iterator[Visual]:
    """Yield thin bars along circles of a cavity: what is inside is seen between them."""
    radius = cavity.radius
    if isinstance(cavity, Bowl):
        loops = np.array(ball(radius, 0.0), float).reshape(-1, ROUND, 3)
    else:
        loops = np.array([circle(radius, height) for height in (-radius, 0.0, radius)], float)
    for loop in loops:
        for one, other in zip(loop, np.roll(loop, -1, axis=0), strict=True):
            along = other - one
            length = float(np.linalg.norm(along))
            bar = _cylinder(EDGE_SHARE * radius, length)
            yield Visual(bar, 0.5 * (one + other), frame_along(along / length))


def _centred(geometry: str) -> Visual:
    return Visual(geometry, np.zeros(3), np.eye(3))


def _sphere(radius: float) -> str:
    return f'<sphere radius="{float(radius)!r}"/>'


def _cylinder(radius: float, length: float) -> str:
    return f'<cylinder radius="{radius!r}" length="{length!r}"/>'


def roll_pitch_yaw(matrix: Matrix) -> tuple[float, float, float]:
    """Return URDF's angles: Rz(yaw) Ry(pitch) Rx(roll)."""
    level = math.hypot(matrix[2, 1], matrix[2, 2])  # cosine of the pitch
    pitch = math.atan2(-matrix[2, 0], level)
    if level < 1e-9:  # straight up or down: roll and yaw turn about one axis, yaw takes it all
        return 0.0, pitch, math.atan2(-matrix[0, 1], matrix[1, 1])
    roll = math.atan2(matrix[2, 1], matrix[2, 2])
    return roll, pitch, math.atan2(matrix[1, 0], matrix[0, 0])


def numbers(values: Any) -> str:
    """Return numbers as URDF lists them, with all their digits."""
    return " ".join(repr(float(value)) for value in values)
