"""Volume, centre of mass and inertia of homogeneous solids.

J is the inertia about the centre of mass over the mass [m^2]. Primitives say their own, in closed
form (`cell/shapes`); of the others:

    hull      tetrahedra from a point inside to every triangle (a, b, c) of its faces:
              V = sum det/6,  int x x^T = sum det/120 (s s^T + a a^T + b b^T + c c^T),
              det = a.(b x c),  s = a + b + c
    compound  the parts' J turned and shifted, each with its share of the sum of their volumes
"""

from __future__ import annotations

import math
from typing import NamedTuple

from lavendersim.geometry.convex_hull import Polyhedron
from lavendersim.geometry.principal_axes import principal
from lavendersim.geometry.quaternions import IDENTITY, Quaternion, to_body
from lavendersim.geometry.vectors import Matrix, Vector3, cross, dot, minus


class Solid(NamedTuple):
    """Volume [m^3], centre of mass [m] and J [m^2] about it, in the shape's own frame."""

    volume: float
    centre: Vector3
    inertia: Matrix

    def principal(self) -> tuple[Vector3, Quaternion]:
        """Return the principal moments of J, and the rotation from their axes to the frame."""
        return principal(self.inertia)


class Placed(NamedTuple):
    """A part of a compound: the solid, and where its centre of mass stands and how it is turned."""

    solid: Solid
    position: Vector3
    orientation: Quaternion = IDENTITY


ORIGIN: Vector3 = (0.0, 0.0, 0.0)
_AXES: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def _diagonal(x: float, y: float, z: float) -> Matrix:
    return ((x, 0.0, 0.0), (0.0, y, 0.0), (0.0, 0.0, z))


def homogeneous(volume: float, moments: Vector3) -> Solid:
    """Return the solid whose frame is its principal frame."""
    return Solid(volume, ORIGIN, _diagonal(*moments))


def polyhedron(hull: Polyhedron) -> Solid:
    """Return the solid inside of flat faces that turn left seen from outside."""
    count = len(hull.points)
    inside: Vector3 = (
        math.fsum(point[0] for point in hull.points) / count,
        math.fsum(point[1] for point in hull.points) / count,
        math.fsum(point[2] for point in hull.points) / count,
    )
    corners = [minus(point, inside) for point in hull.points]
    volume, first = 0.0, [0.0, 0.0, 0.0]
    second = [[0.0, 0.0, 0.0] for _ in range(3)]
    for face in hull.faces:
        a = corners[face[0]]
        for k in range(1, len(face) - 1):
            b, c = corners[face[k]], corners[face[k + 1]]
            det = dot(a, cross(b, c))
            s = [a[i] + b[i] + c[i] for i in range(3)]
            volume += det / 6.0
            for i in range(3):
                first[i] += det / 24.0 * s[i]
                for j in range(3):
                    moments = s[i] * s[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]
                    second[i][j] += det / 120.0 * moments
    away = (first[0] / volume, first[1] / volume, first[2] / volume)
    spread = [[second[i][j] / volume - away[i] * away[j] for j in range(3)] for i in range(3)]
    trace = spread[0][0] + spread[1][1] + spread[2][2]
    centre = (inside[0] + away[0], inside[1] + away[1], inside[2] + away[2])
    return Solid(volume, centre, _matrix([[-v for v in row] for row in spread], trace))


def together(parts: list[Placed]) -> Solid:
    """Return the solid of several, as if those that overlap did not."""
    volume = math.fsum(part.solid.volume for part in parts)
    shares = [part.solid.volume / volume for part in parts]
    places = [part.position for part in parts]
    centre = (
        math.fsum(share * place[0] for share, place in zip(shares, places, strict=True)),
        math.fsum(share * place[1] for share, place in zip(shares, places, strict=True)),
        math.fsum(share * place[2] for share, place in zip(shares, places, strict=True)),
    )
    total = [[0.0, 0.0, 0.0] for _ in range(3)]
    for share, part in zip(shares, parts, strict=True):
        away = minus(part.position, centre)
        own = _turned(part.solid.inertia, part.orientation)
        square = dot(away, away)
        for i in range(3):
            for j in range(3):
                shift = (square if i == j else 0.0) - away[i] * away[j]
                total[i][j] += share * (own[i][j] + shift)
    return Solid(volume, centre, _matrix(total, 0.0))


def _turned(inertia: Matrix, orientation: Quaternion) -> Matrix:
    """Return R J R^T."""
    if orientation == IDENTITY:
        return inertia
    rows = [to_body(orientation, axis) for axis in _AXES]  # of R, and R J by J's symmetry
    halves = [tuple(dot(row, column) for column in inertia) for row in rows]
    return _matrix([[dot((x, y, z), other) for other in rows] for x, y, z in halves], 0.0)


def _matrix(rows: list[list[float]], diagonal: float) -> Matrix:
    """Return rows as a symmetric matrix, `diagonal` added."""
    xy, xz, yz = (0.5 * (rows[i][j] + rows[j][i]) for i, j in ((0, 1), (0, 2), (1, 2)))
    xx, yy, zz = (rows[i][i] + diagonal for i in range(3))
    return ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
