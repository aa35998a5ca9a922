"""The engine's tables of triangle meshes (`engine.collide.mesh_tables`), filled from cells.

Triangles whose planes are the same but for round-off are one face; of an edge between two faces the
straight pieces are one. The tree of boxes halves the triangles along the longest axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from lavendersim.cell import CellMesh
from lavendersim.engine.collide.mesh_tables import (
    CONCAVE,
    CONVEX,
    CORNER,
    EDGE,
    FLAT,
    FOLDED,
    FREE,
    GROUP,
    NODE,
    SIDE,
    SPOKE,
    TRIANGLE,
    XYZ,
    MeshTables,
)
from lavendersim.engine.records import dtype
from lavendersim.geometry.triangle_mesh import TriangleSurface, surface_of

# Sine of the angle between two planes, and height of a corner above one in its size, that are
# round-off [-].
SAME_PLANE: Final = 1e-9
# Sine of the angle between two pieces of a straight edge [-].
STRAIGHT: Final = 1e-9
NOTHING: Final = -1


class _Faces(NamedTuple):
    of: np.ndarray  # (T,) group of each triangle
    normals: np.ndarray  # (groups, 3)
    offsets: np.ndarray  # (groups,)


def mesh_tables(meshes: Sequence[CellMesh]) -> tuple[MeshTables, list[tuple[int, int]]]:
    """Return the tables, and of each mesh its first node and the one behind its last."""
    filled = [_of_one(mesh) for mesh in meshes]
    columns: dict[str, list[np.ndarray]] = {name: [] for name in _TABLES}
    spans: list[tuple[int, int]] = []
    for one in filled:
        first = {name: sum(map(len, columns[name])) for name in _TABLES}
        spans.append((first["nodes"], first["nodes"] + len(one["nodes"])))
        for (table, field), target in _ROWS.items():
            known = one[table][field]
            known[known >= 0] += first[target]
        for name in _TABLES:
            columns[name].append(one[name])
    empty = np.zeros(0)
    # A plan that scenes share may have none in one of them.
    tables = {
        name: np.concatenate([np.zeros(0, dtype(_TABLES[name])), *parts])
        for name, parts in columns.items()
    }
    room = dict.fromkeys(("stamp", "row", "points", "normals", "counts"), empty)
    return MeshTables(**tables, **room), spans


_TABLES: Final = {
    "nodes": NODE,
    "triangles": TRIANGLE,
    "groups": GROUP,
    "sides": SIDE,
    "edges": EDGE,
    "corners": CORNER,
    "spokes": SPOKE,
}
# Fields that are rows of another table.
_ROWS: Final = {
    ("nodes", "skip"): "nodes",
    ("nodes", "triangle"): "triangles",
    ("triangles", "group"): "groups",
    ("sides", "edge"): "edges",
    ("edges", "start"): "corners",
    ("edges", "end"): "corners",
    ("corners", "first"): "spokes",
    ("corners", "last"): "spokes",
}


def _of_one(mesh: CellMesh) -> dict[str, np.ndarray]:
    surface = surface_of(mesh.vertices, mesh.triangles)
    faces = _faces(surface)
    sides = _sides(surface, faces)
    corners, spokes = _corners(surface, sides)
    edges = _edges(surface, faces, sides)
    triangles = np.zeros(len(faces.of), dtype(TRIANGLE))
    triangles["group"] = faces.of
    groups = np.zeros(len(faces.offsets), dtype(GROUP))
    _put(groups, "n", faces.normals)
    groups["offset"] = faces.offsets
    return {
        "nodes": _nodes(surface),
        "triangles": triangles,
        "groups": groups,
        "sides": sides,
        "edges": edges,
        "corners": corners,
        "spokes": spokes,
    }


def _put(rows: np.ndarray, name: str, vectors: np.ndarray) -> None:
    for k, axis in enumerate(XYZ):
        rows[f"{name}{axis}"] = vectors[..., k]


def _vector(row: Any, name: str) -> np.ndarray:
    return np.array([row[f"{name}{axis}"] for axis in XYZ])


def _faces(surface: TriangleSurface) -> _Faces:
    """Triangles that hang together and lie in the plane of the first of them."""
    of = np.full(len(surface.triangles), NOTHING, np.int64)
    normals: list[np.ndarray] = []
    offsets: list[float] = []
    size = float(np.abs(surface.vertices).max())
    for seed in range(len(of)):
        if of[seed] >= 0:
            continue
        normal = surface.normals[seed]
        offset = float(surface.vertices[surface.triangles[seed, 0]] @ normal)
        of[seed], waiting = len(offsets), [seed]
        while waiting:
            for other in surface.beyond[waiting.pop()].tolist():
                if other < 0 or of[other] >= 0:
                    continue
                heights = surface.vertices[surface.triangles[other]] @ normal - offset
                turned = np.cross(normal, surface.normals[other])
                along = float(normal @ surface.normals[other]) > 0.0
                level = float(np.abs(heights).max()) <= SAME_PLANE * size
                if along and level and float(turned @ turned) <= SAME_PLANE**2:
                    of[other] = len(offsets)
                    waiting.append(other)
        normals.append(normal)
        offsets.append(offset)
    return _Faces(of, np.array(normals), np.array(offsets))


def _sides(surface: TriangleSurface, faces: _Faces) -> np.ndarray:
    """Return rows of SIDE, three of each triangle."""
    count = len(surface.triangles)
    sides = np.zeros(3 * count, dtype(SIDE))
    start = surface.vertices[surface.triangles]
    along = surface.vertices[np.roll(surface.triangles, -1, axis=1)] - start
    along /= np.linalg.norm(along, axis=2)[..., None]
    own = faces.normals[faces.of][:, None, :]
    _put(sides, "", start.reshape(-1, 3))
    _put(sides, "m", np.cross(own, along).reshape(-1, 3))
    beyond = surface.beyond
    other = faces.normals[faces.of[beyond]]
    _put(sides, "n", np.where(beyond[..., None] >= 0, other, own).reshape(-1, 3))
    bend = np.einsum("ijk,ijk->ij", np.cross(own, other), along)  # > 0: the surface turns away
    kind = np.where(bend > 0.0, CONVEX, CONCAVE)
    opposite = np.einsum("ijk,ijk->ij", np.broadcast_to(own, other.shape), other) < 0.0
    kind[opposite & (np.abs(bend) <= SAME_PLANE)] = FOLDED
    kind[faces.of[beyond] == faces.of[:, None]] = FLAT
    kind[beyond < 0] = FREE
    sides["kind"] = kind.reshape(-1)
    sides["edge"] = NOTHING
    return sides


def _corners(surface: TriangleSurface, sides: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return rows of CORNER, one of each vertex, and of SPOKE."""
    count = len(surface.vertices)
    start, end = surface.triangles.reshape(-1), np.roll(surface.triangles, -1, axis=1).reshape(-1)
    free = sides["kind"] == FREE
    origin = np.concatenate([start, end[free]])  # each side from its start, free ones from both
    towards = np.concatenate([end, start[free]])
    order = np.argsort(origin, kind="stable")
    ways = surface.vertices[towards[order]] - surface.vertices[origin[order]]
    spokes = np.zeros(len(order), dtype(SPOKE))
    _put(spokes, "", ways / np.linalg.norm(ways, axis=1)[:, None])
    corners = np.zeros(count, dtype(CORNER))
    corners["first"] = np.searchsorted(origin[order], np.arange(count), side="left")
    corners["last"] = np.searchsorted(origin[order], np.arange(count), side="right")
    corners["free"][origin[np.isin(origin, np.concatenate([start[free], end[free]]))]] = 1
    summed = np.zeros((count, 3))
    for k in range(3):
        at = surface.triangles[:, k]
        one = surface.vertices[surface.triangles[:, (k + 1) % 3]] - surface.vertices[at]
        other = surface.vertices[surface.triangles[:, (k + 2) % 3]] - surface.vertices[at]
        cosine = np.einsum("ij,ij->i", one, other)
        cosine /= np.linalg.norm(one, axis=1) * np.linalg.norm(other, axis=1)
        angle = np.arccos(np.clip(cosine, -1.0, 1.0))
        np.add.at(summed, at, angle[:, None] * surface.normals)
    _put(corners, "n", summed)
    return corners, spokes


class _Piece(NamedTuple):
    side: int
    start: int
    end: int


def _edges(surface: TriangleSurface, faces: _Faces, sides: np.ndarray) -> np.ndarray:
    """Return rows of EDGE and write which of them sides are, each straight piece once."""
    ends = np.roll(surface.triangles, -1, axis=1).reshape(-1).tolist()
    starts = surface.triangles.reshape(-1).tolist()
    beyond = surface.beyond.reshape(-1).tolist()
    kinds, groups = sides["kind"].tolist(), faces.of.tolist()
    around: dict[int, set[int]] = {}
    for triangle, corners in enumerate(surface.triangles.tolist()):
        for corner in corners:
            around.setdefault(corner, set()).add(groups[triangle])
    pieces: dict[tuple[int, int], dict[int, list[_Piece]]] = {}
    twin = {(start, end): side for side, (start, end) in enumerate(zip(starts, ends, strict=True))}
    sharp: list[tuple[tuple[int, int], _Piece]] = []
    for side, kind in enumerate(kinds):
        own = groups[side // 3]
        other = groups[beyond[side]] if beyond[side] >= 0 else NOTHING
        if kind == FREE or (kind in (CONVEX, FOLDED) and own < other):
            piece = _Piece(side, starts[side], ends[side])
            sharp.append(((own, other), piece))
            at = pieces.setdefault((own, other), {})
            at.setdefault(piece.start, []).append(piece)
            at.setdefault(piece.end, []).append(piece)
    rows: list[tuple[int, int, int]] = []  # a side of it, and its two corners
    taken: set[int] = set()

    def grown(key: tuple[int, int], piece: _Piece, at: int) -> int:
        """Return the corner where the edge through a piece ends beyond one of its ends."""
        way = surface.vertices[at] - surface.vertices[piece.start + piece.end - at]
        way /= np.linalg.norm(way)
        while around[at] == {one for one in key if one >= 0}:
            for following in pieces[key][at]:
                if following.side in taken:
                    continue
                end = following.start + following.end - at
                other = surface.vertices[end] - surface.vertices[at]
                turn = np.cross(way, other / np.linalg.norm(other))
                if float(way @ other) > 0.0 and float(turn @ turn) <= STRAIGHT**2:
                    taken.add(following.side)
                    sides["edge"][following.side] = len(rows)
                    at = end
                    break
            else:
                break
        return at

    for key, piece in sharp:
        if piece.side in taken:
            continue
        taken.add(piece.side)
        sides["edge"][piece.side] = len(rows)
        start, end = grown(key, piece, piece.start), grown(key, piece, piece.end)
        rows.append((piece.side, start, end))
    for side in range(len(sides)):
        if kinds[side] in (CONVEX, FOLDED) and sides["edge"][side] < 0:
            sides["edge"][side] = sides["edge"][twin[ends[side], starts[side]]]
    edges = np.zeros(len(rows), dtype(EDGE))
    for edge, (side, start, end) in zip(edges, rows, strict=True):
        p, q = surface.vertices[start], surface.vertices[end]
        edge["start"], edge["end"] = start, end
        _put(edge, "", 0.5 * (p + q))
        _put(edge, "h", 0.5 * (q - p))
        edge["length"] = 0.5 * np.linalg.norm(q - p)
        for name, of in (("1", side), ("2", twin.get((ends[side], starts[side]), side))):
            _put(edge, f"m{name}", _vector(sides[of], "m"))
            _put(edge, f"n{name}", faces.normals[groups[of // 3]])
        edge["free"] = 1 if kinds[side] == FREE else 0
    return edges


def _nodes(surface: TriangleSurface) -> np.ndarray:
    """Return the tree of boxes in the order of a walk."""
    corners = surface.vertices[surface.triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    nodes = np.zeros(2 * len(corners) - 1, dtype(NODE))
    waiting, place = [np.arange(len(corners))], 0
    while waiting:
        rows = waiting.pop()
        node = nodes[place]
        least, most = low[rows].min(axis=0), high[rows].max(axis=0)
        _put(node, "low_", least)
        _put(node, "high_", most)
        place += 1
        node["skip"] = place + 2 * len(rows) - 2
        node["triangle"] = rows[0] if len(rows) == 1 else NOTHING
        if len(rows) > 1:
            axis = int(np.argmax(most - least))
            half = len(rows) // 2
            order = np.argsort(low[rows, axis] + high[rows, axis], kind="stable")
            waiting += [rows[order[half:]], rows[order[:half]]]
    return nodes
