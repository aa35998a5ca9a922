"""The tables of a scene's hulls enter; the small arrays that collision kernels fill anew leave.

Kernels allocate nothing: every array they need lies here, one set per thread.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..records import POINT, dtype
from .convex.hull_geometry import HullGeometry, hull_geometry

# Corners of the polygon that stands for a cylinder's cap (features.py).
CAP_CORNERS = 8
# Support points and faces of the expanding polytope: a convex polyhedron with v corners has at most
# 2 v - 4 triangles; faces that were cut off keep their rows.
EPA_VERTICES = 128
EPA_FACES = 1024


class Mesh(NamedTuple):
    """The expanding polytope (polytope.py)."""

    corners: np.ndarray  # (EPA_VERTICES, 9) like simplex
    planes: np.ndarray  # (EPA_FACES, 4) outward normal and offset of each face
    triangles: np.ndarray  # (EPA_FACES, 7) three corners, three neighbours, alive
    visible: np.ndarray  # (EPA_FACES,) faces seen from the new corner
    stack: np.ndarray  # (EPA_FACES,) faces whose neighbours are still to be looked at
    starts: np.ndarray  # (EPA_VERTICES,) new face that leaves a corner of the horizon


class Scratch(NamedTuple):
    """Small arrays that each pair overwrites, and the hulls' tables, which stay as they are."""

    frame_a: np.ndarray
    frame_b: np.ndarray
    cosines: np.ndarray
    half_a: np.ndarray
    half_b: np.ndarray
    offset_a: np.ndarray
    offset_b: np.ndarray
    hulls: HullGeometry
    simplex: np.ndarray  # (5, 9) corners w = a - b with their a, b; row 4 waits for acceptance
    weights: np.ndarray  # (4,) barycentric coordinates of the simplex's nearest point
    result: np.ndarray  # (10,) n, separation, point of A, point of B (gjk.py)
    nearest: np.ndarray  # (6,) point of A, point of B, while `ascend` looks for better ones
    mesh: Mesh
    frame: np.ndarray  # (9,) t1, t2, n of a manifold
    loop_a: np.ndarray  # (n, 3) corners of A's feature
    loop_b: np.ndarray
    plane_a: np.ndarray  # (7,) outward normal, a point of the plane, radius of a disc
    plane_b: np.ndarray
    polygon: np.ndarray  # POINT rows: two polygons being cut


def allocate_scratch(geometry: HullGeometry | None = None) -> Scratch:
    """Return scratch for one thread, around the tables of a scene's hulls."""
    hulls = hull_geometry() if geometry is None else geometry
    longest = max(int(np.diff(hulls.loop_start).max()), CAP_CORNERS)
    most = int(np.diff(hulls.vertex_start).max())
    return Scratch(
        frame_a=np.zeros((3, 3)),
        frame_b=np.zeros((3, 3)),
        cosines=np.zeros((3, 3)),
        half_a=np.zeros(3),
        half_b=np.zeros(3),
        offset_a=np.zeros(3),
        offset_b=np.zeros(3),
        hulls=hulls,
        simplex=np.zeros((5, 9)),
        weights=np.zeros(4),
        result=np.zeros(10),
        nearest=np.zeros(6),
        mesh=Mesh(
            corners=np.zeros((EPA_VERTICES, 9)),
            planes=np.zeros((EPA_FACES, 4)),
            triangles=np.zeros((EPA_FACES, 7), np.int64),
            visible=np.zeros(EPA_FACES, np.int64),
            stack=np.zeros(EPA_FACES, np.int64),
            starts=np.zeros(EPA_VERTICES, np.int64),
        ),
        frame=np.zeros(9),
        loop_a=np.zeros((longest, 3)),
        loop_b=np.zeros((longest, 3)),
        plane_a=np.zeros(7),
        plane_b=np.zeros(7),
        # A polygon of n corners cut by m sides has at most n + m; one more for the nearest point.
        polygon=np.zeros(max(2 * (2 * longest + 2), most), dtype(POINT)),
    )
