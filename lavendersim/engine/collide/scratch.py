"""Scratch memory of collision kernels: one set per thread, overwritten by every pair.

Kernels allocate nothing: every array they need lies here, under its name.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from ..records import POINT, dtype
from .convex.hull_geometry import HullGeometry, hull_geometry
from .mesh_tables import MeshTables, with_room
from .records import FACE, NOT_CONVERGED, PLANE_OF_FEATURE, SEPARATION, VECTOR, VERTEX

# Points of one manifold of boxes: two polygons of at most eight vertices each.
MANIFOLD_POINTS = 16
# Corners of the polygon that stands for a cylinder's cap (shapes/cylinder.py).
CAP_CORNERS = 8
# Vertices of a simplex, and one that waits for acceptance (gjk.py).
SIMPLEX_VERTICES = 4
NEW_VERTEX = 4
# Vertices and faces of the expanding polytope: a convex polyhedron with v corners has at most
# 2 v - 4 triangles; faces that were cut off keep their rows.
EPA_VERTICES = 128
EPA_FACES = 1024


# Looked up for each scene they would take half of what its scratch takes.
_POINT, _VECTOR, _VERTEX, _PLANE, _SEPARATION, _FACE, _NOT_CONVERGED = map(
    dtype, (POINT, VECTOR, VERTEX, PLANE_OF_FEATURE, SEPARATION, FACE, NOT_CONVERGED)
)


class Manifold(NamedTuple):
    """What a pair's kernel writes: contact points that share a normal."""

    points: np.ndarray  # (n,) POINT; behind those of the manifold the candidates left out
    normal: np.ndarray  # (3,) unit, from A to B; where pairs have them (`own_normals`), those of
    # single points behind it
    reduction: np.ndarray  # (2,) int64, see `manifold.point`


class BoxFrame(NamedTuple):
    """A box while two of them are compared: axis i is the row axes[i], in world coordinates."""

    axes: np.ndarray  # (3, 3)
    half: np.ndarray  # (3,) half edge lengths [m]
    centre: np.ndarray  # (3,) [m]
    offset: np.ndarray  # (3,) from A's centre to B's, along these axes [m]


class Polytope(NamedTuple):
    """The expanding polytope (polytope.py): a closed mesh of triangles."""

    vertices: np.ndarray  # (EPA_VERTICES,) VERTEX
    faces: np.ndarray  # (EPA_FACES,) FACE
    corners: np.ndarray  # (EPA_FACES, 3) vertices of a face, turning left seen from outside
    neighbours: np.ndarray  # (EPA_FACES, 3) faces across its edges: edge k leads from corner k
    queue: np.ndarray  # (EPA_FACES,) faces seen from the new vertex
    horizon: np.ndarray  # (EPA_VERTICES,) new face whose edge on the horizon begins there, or -1


class Outline(NamedTuple):
    """A feature's loop of corners or two ends, and the plane that it lies in."""

    corners: np.ndarray  # (n,) VECTOR
    plane: np.ndarray  # (1,) PLANE_OF_FEATURE
    pull: np.ndarray  # (3,) gravity: where what stands on a round cap tips to [m/s^2]


class Scratch(NamedTuple):
    """Small arrays that each pair overwrites, and the hulls' tables, which stay as they are."""

    manifold: Manifold
    box_a: BoxFrame
    box_b: BoxFrame
    cosines: np.ndarray  # (3, 3) of the angles between axes of A and of B
    hulls: HullGeometry
    simplex: np.ndarray  # (SIMPLEX_VERTICES + 1,) VERTEX
    weights: np.ndarray  # (SIMPLEX_VERTICES,) barycentric coordinates of the nearest point
    separation: np.ndarray  # (1,) SEPARATION, what GJK and EPA found
    best: np.ndarray  # (1,) SEPARATION, while `ascend` looks for a better one
    not_converged: np.ndarray  # (1,) NOT_CONVERGED, calls since it was read last
    polytope: Polytope
    outline_a: Outline
    outline_b: Outline
    polygon: np.ndarray  # POINT rows: two polygons being cut
    meshes: Any  # tables of triangle meshes: `mesh_tables.MeshTables`, or ()


def _longest_and_most(hulls: HullGeometry) -> tuple[int, int]:
    """Return the most corners of a face, or of a cap, and the most vertices of a hull."""
    longest = max(int(np.diff(hulls.loop_start).max()), CAP_CORNERS)
    return longest, int(np.diff(hulls.vertex_start).max())


@cache
def _of_the_box() -> tuple[int, int]:
    return _longest_and_most(hull_geometry())


def allocate_scratch(
    geometry: HullGeometry | None = None,
    own_normals: bool = False,
    meshes: MeshTables | None = None,
    bodies: np.dtype | None = None,
) -> Scratch:
    """Return scratch for one thread, around the tables of a scene's hulls and meshes.

    own_normals: whether points of a manifold may have normals of their own. bodies: the record of a
    body, where there are meshes.
    """
    hulls = hull_geometry() if geometry is None else geometry
    longest, most = _longest_and_most(hulls) if len(hulls.vertex_start) > 2 else _of_the_box()

    # A polygon of n corners cut by m sides has at most n + 2 m (manifold/polygon_clip), and a cut
    # looks for two rows more; two halves.
    rows = max(2 * (3 * longest + 2), most)
    points = max(MANIFOLD_POINTS, rows)
    own_meshes: Any = ()
    if meshes is not None:
        assert bodies is not None
        own_meshes = with_room(meshes, bodies, points)
        points = max(points, len(own_meshes.points))

    def box() -> BoxFrame:
        return BoxFrame(
            axes=np.zeros((3, 3)), half=np.zeros(3), centre=np.zeros(3), offset=np.zeros(3)
        )

    pull = np.zeros(3)

    def outline() -> Outline:
        return Outline(
            corners=np.zeros(longest, _VECTOR),
            plane=np.zeros(1, _PLANE),
            pull=pull,
        )

    return Scratch(
        manifold=Manifold(
            points=np.zeros(points, _POINT),
            normal=np.zeros(3 + (3 * points if own_normals else 0)),
            reduction=np.zeros(2, np.int64),
        ),
        box_a=box(),
        box_b=box(),
        cosines=np.zeros((3, 3)),
        hulls=hulls,
        simplex=np.zeros(SIMPLEX_VERTICES + 1, _VERTEX),
        weights=np.zeros(SIMPLEX_VERTICES),
        separation=np.zeros(1, _SEPARATION),
        best=np.zeros(1, _SEPARATION),
        not_converged=np.zeros(1, _NOT_CONVERGED),
        polytope=Polytope(
            vertices=np.zeros(EPA_VERTICES, _VERTEX),
            faces=np.zeros(EPA_FACES, _FACE),
            corners=np.zeros((EPA_FACES, 3), np.int64),
            neighbours=np.zeros((EPA_FACES, 3), np.int64),
            queue=np.zeros(EPA_FACES, np.int64),
            horizon=np.zeros(EPA_VERTICES, np.int64),
        ),
        outline_a=outline(),
        outline_b=outline(),
        polygon=np.zeros(rows, _POINT),
        meshes=own_meshes,
    )
