"""Tables of convex polyhedra that kernels can read: vertices, faces, their loops and edges.

    hull h           vertices[vertex_start[h] : vertex_start[h + 1]]
                     faces    face_start[h] .. face_start[h + 1] - 1
    face f           normals[f], offsets[f]: its points have n . x = offset, n outward
                     corners  loops[loop_start[f] : loop_start[f + 1]], rows of `vertices`, turning
                     left about n
    edge k           leads from loops[k] to the next corner of its face; edges[k]: where its hull
                     lists it first, which is k itself or the edge of a neighbour, led backwards
The last row of the tables is the box with half edges 1, so that boxes and hulls share their code: a
box is that row stretched by its half edges.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

# Names of contact points hold a face and a corner of it in so many bits (`manifold.patch`).
MOST_FACES = 1 << 12
MOST_CORNERS = 1 << 8

Polyhedron = tuple[np.ndarray, Sequence[Sequence[int]]]  # vertices (n, 3) [m], loops of corners

UNIT_BOX: Polyhedron = (
    np.array([[x, y, z] for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)]),
    ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)),
)


class HullGeometry(NamedTuple):
    """Tables of all hulls of a scene in their bodies' frames, and the unit box behind them."""

    vertices: np.ndarray  # (n, 3) [m]
    vertex_start: np.ndarray  # (hulls + 2,)
    normals: np.ndarray  # (faces, 3), unit, outward
    offsets: np.ndarray  # (faces,) [m]
    face_start: np.ndarray  # (hulls + 2,)
    loops: np.ndarray  # (corners,) rows of `vertices`
    loop_start: np.ndarray  # (faces + 1,)
    edges: np.ndarray  # (corners,) rows of `loops`


def face_plane(corners: np.ndarray) -> tuple[np.ndarray, float]:
    """Return unit normal and offset [m] of a flat loop of corners (n, 3), by Newell's sum."""
    middle = corners.mean(axis=0)
    from_middle = corners - middle
    normal = np.cross(from_middle, np.roll(from_middle, -1, axis=0)).sum(axis=0)
    normal /= np.linalg.norm(normal)
    return normal, float(np.max(corners @ normal))


def first_mentions(faces: Sequence[Sequence[int]], first: int) -> list[int]:
    """Return for every edge of the loops where it is listed first, counted from `first`."""
    known: dict[tuple[int, int], int] = {}
    mentions: list[int] = []
    for loop in faces:
        for start, end in zip(loop, [*loop[1:], loop[0]], strict=True):
            own = first + len(mentions)
            mentions.append(known.setdefault((min(start, end), max(start, end)), own))
    return mentions


def hull_geometry(hulls: Sequence[Polyhedron] = ()) -> HullGeometry:
    """Return the tables of `hulls`, row by row, and of the unit box as the last row.

    Vertices are relative to the centre of mass, in the body's frame [m]; loops turn left seen from
    outside. The offset of a face is that of its outermost corner, so no corner lies beyond it.
    """
    return _tables(hulls) if hulls else _box_alone()


@cache
def _box_alone() -> HullGeometry:
    return _tables(())


def _tables(hulls: Sequence[Polyhedron]) -> HullGeometry:
    vertices: list[np.ndarray] = []
    normals: list[np.ndarray] = []
    offsets: list[float] = []
    loops: list[int] = []
    edges: list[int] = []
    vertex_start, face_start, loop_start = [0], [0], [0]
    for points, faces in (*hulls, UNIT_BOX):
        if len(faces) > MOST_FACES or max(len(loop) for loop in faces) > MOST_CORNERS:
            raise ValueError(
                f"a hull has at most {MOST_FACES} faces of at most {MOST_CORNERS} corners"
            )
        first = vertex_start[-1]
        corners = np.asarray(points, float)
        vertices.append(corners)
        edges.extend(first_mentions(faces, len(loops)))
        for loop in faces:
            normal, offset = face_plane(corners[list(loop)])
            normals.append(normal)
            offsets.append(offset)
            loops.extend(first + int(k) for k in loop)
            loop_start.append(len(loops))
        vertex_start.append(first + len(corners))
        face_start.append(len(normals))
    return HullGeometry(
        np.ascontiguousarray(np.concatenate(vertices)),
        np.array(vertex_start, np.int64),
        np.array(normals),
        np.array(offsets),
        np.array(face_start, np.int64),
        np.array(loops, np.int64),
        np.array(loop_start, np.int64),
        np.array(edges, np.int64),
    )
