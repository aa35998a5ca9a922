"""Tables of triangle meshes that kernels read: a tree of boxes, triangles, planes, sharp edges.

    node k      a box around the nodes k + 1 ... skip - 1, or around its triangle; in this order a
                walk goes on at k + 1 where it meets the box, else at skip
    group       triangles in one plane that hang together: one face, whose inner edges are none
    side 3t+k   of triangle t, from corner k to the next: what lies beyond it
    edge        a convex, folded or free edge, as long as it is straight between the same two faces
    corner      an end of edges, with the directions of all sides of triangles that end there

All coordinates are those of the body's frame [m].
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..records import F8, I8, POINT, Field, dtype

XYZ = "xyz"

# What lies beyond a side: nothing; the same plane; a face that turns away; one that comes towards;
# one that turns right round, so that the side is the rim of a sheet with two faces.
FREE, FLAT, CONVEX, CONCAVE, FOLDED = 0, 1, 2, 3, 4


def _vector(name: str) -> list[Field]:
    return [(f"{name}{axis}", F8) for axis in XYZ]


NODE: list[Field] = [*_vector("low_"), *_vector("high_"), ("skip", I8), ("triangle", I8)]
TRIANGLE: list[Field] = [("group", I8)]
GROUP: list[Field] = [*_vector("n"), ("offset", F8), ("seen", I8)]
SIDE: list[Field] = [
    *_vector(""),  # a point of it
    *_vector("m"),  # unit, across it, in the triangle's plane, into the triangle
    *_vector("n"),  # unit normal of the face beyond it
    ("kind", I8),
    ("edge", I8),  # row of `edges`, -1: not sharp
]
EDGE: list[Field] = [
    *_vector(""),  # its middle
    *_vector("h"),  # half its way, from corner `start` to corner `end`
    ("length", F8),  # half of it
    *_vector("m1"),  # across it into its first face, and the second
    *_vector("n1"),  # their normals
    *_vector("m2"),
    *_vector("n2"),
    ("free", I8),  # 1: it has no second face
    ("start", I8),
    ("end", I8),
    ("seen", I8),
]
CORNER: list[Field] = [
    *_vector("n"),  # sum of the normals of its faces, weighed by their angles
    ("free", I8),  # 1: on the rim of the surface
    ("first", I8),  # of `spokes`, and behind the last
    ("last", I8),
]
SPOKE: list[Field] = _vector("")


class MeshTables(NamedTuple):
    """Tables of all meshes of a scene, and what a pair's kernel works in."""

    nodes: np.ndarray
    triangles: np.ndarray
    groups: np.ndarray
    sides: np.ndarray
    edges: np.ndarray
    corners: np.ndarray
    spokes: np.ndarray  # unit directions from corners
    stamp: np.ndarray  # (1,) int64: groups and edges `seen` by the manifold of this number
    row: np.ndarray  # (1,) as bodies: a face as a plane, an edge as a segment
    points: np.ndarray  # (n,) POINT of the manifold; behind them, from the end, those left out
    normals: np.ndarray  # (3 n,) of these points
    counts: np.ndarray  # (2,) int64: points of the manifold, left out


def with_room(tables: MeshTables, bodies: np.dtype, most_points: int) -> MeshTables:
    """Return tables with what kernels work in; most_points: of one body on one face.

    What they have `seen` is marked in copies: engines of one scene share the tables.
    """
    sharp, faces = len(tables.edges), len(tables.groups)
    room = 2 * most_points * min(faces, 64) + 4 * (faces + sharp) + 64
    return tables._replace(
        groups=tables.groups.copy(),
        edges=tables.edges.copy(),
        stamp=np.zeros(1, np.int64),
        row=np.zeros(1, bodies),
        points=np.zeros(room, dtype(POINT)),
        normals=np.zeros(3 * room),
        counts=np.zeros(2, np.int64),
    )
