"""Bodies that start inside one another, behind a plane or in the wall of a cavity.

Planes: exactly, by the body's extent against the normal. Meshes: by the body's centre: where that
is behind a triangle nothing of it touches. Spheres, boxes, capsules: the depth of
`measures.penetration`. Every other pair: GJK between the corners of both, each drawn in by
DRAWN_IN towards its centre, so that what merely touches is not found.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np

from lavendersim.cell import Cavity, CellBody, CellMesh, Drum, Plane, Sphere
from lavendersim.cell.shapes import CellSimple
from lavendersim.engine.effects import holding
from lavendersim.errors import Defect
from lavendersim.experiment import Cell, body_path
from lavendersim.geometry.bodies import is_movable, rotation_of, vector
from lavendersim.geometry.minkowski_sums import Sums, extents, sums_of
from lavendersim.geometry.point_sets import hulls_meet
from lavendersim.geometry.rotations import Floats, rotation_matrices, rotation_matrix
from lavendersim.geometry.shapes import extent, half_space, pieces, thickness
from lavendersim.measures.penetration import depths
from lavendersim.measures.solids import (
    PlacedSolids,
    kind_of,
    near_pairs,
    size_of,
)

DRAWN_IN: Final = 0.01  # share of a shape's size that counts as touching
MOST_PAIRS: Final = 2000  # that GJK looks at, some 0.2 ms each
MOST_TRIANGLES: Final = 200_000  # that centres are checked against, some 1 us each


class Parts(NamedTuple):
    """The convex solids of all bodies that are no planes, in the world."""

    names: list[str]  # of the body that each is of
    shapes: list[CellSimple]
    placed: PlacedSolids
    sums: Sums
    thickness: Floats  # [m]
    movable: np.ndarray


class Inside(NamedTuple):
    """A body that begins in another one, or behind a plane or a wall; ordered by depth."""

    depth: float  # [m], 0 where it is not known
    name: str
    other: str  # a body, a plane or a cavity


def overlaps(cell: Cell) -> Iterator[Defect]:
    """Yield a defect at the deepest body behind a plane or a wall, and at the deepest inside
    another.
    """
    bodies = cell.config.scene.bodies
    parts = _parts(bodies)
    if not parts.names:
        return
    found = (
        *_behind_planes(bodies, parts),
        *_in_walls(bodies, parts),
        *_behind_meshes(bodies, parts),
    )
    behind = max(found, default=None)
    if behind is not None:
        how = f"starts {behind.depth:.3g} m behind the surface of {behind.other}"
        yield _defect(cell, behind.name, f"{behind.name} {how}")
    joined = [{*one.between} for one in holding(cell.config.scene).values() if not one.collide]
    inside = [one for one in _inside(parts) if {one.name, one.other} not in joined]
    if inside:
        deepest = max(inside)
        far = f"{deepest.depth:.3g} m " if deepest.depth > 0.0 else ""
        more = f"; so do {len(inside) - 1} more pairs" if len(inside) > 1 else ""
        how = f"starts {far}inside {deepest.other}{more}"
        yield _defect(cell, deepest.name, f"{deepest.name} {how}")


def _defect(cell: Cell, name: str, sentence: str) -> Defect:
    tree, path = cell.tree, body_path(cell.tree, name)
    written = next((key for key in ("position", "release") if tree.get(*path, key)), None)
    return cell.defect((*path, written) if written else path, sentence)


def _parts(bodies: dict[str, CellBody]) -> Parts:
    solids = {
        name: body
        for name, body in bodies.items()
        if not isinstance(body.shape, Plane | Cavity | CellMesh)
    }
    centres = np.array([body.position for body in solids.values()]).reshape(-1, 3)
    turns = rotation_matrices(
        np.array([body.orientation for body in solids.values()]).reshape(-1, 4)
    )
    names: list[str] = []
    shapes: list[CellSimple] = []
    movable: list[bool] = []
    positions: list[Floats] = []
    rotations: list[Floats] = []
    for (name, body), centre, turn in zip(solids.items(), centres, turns, strict=True):
        for shape, position, orientation in pieces(body.shape):
            names.append(name)
            shapes.append(shape)
            movable.append(is_movable(body))
            one = body.shape is shape
            positions.append(centre if one else centre + turn @ position)
            rotations.append(turn if one else turn @ rotation_matrix(orientation))
    sizes = np.array([size_of(shape) for shape in shapes]).reshape(-1, 3)
    placed = PlacedSolids(
        np.array(positions).reshape(-1, 3), np.array(rotations).reshape(-1, 3, 3), sizes
    )
    thick = np.array([thickness(shape) for shape in shapes])
    return Parts(names, shapes, placed, sums_of(shapes), thick, np.array(movable, dtype=bool))


def _behind_planes(bodies: dict[str, CellBody], parts: Parts) -> Iterator[Inside]:
    """Yield of each plane the movable solid that reaches farthest behind it."""
    placed = parts.placed
    for name, body in bodies.items():
        if not isinstance(body.shape, Plane):
            continue
        normal, offset = half_space(body.shape)
        reach = extents(parts.sums, placed.rotation, -normal)
        for row in np.flatnonzero(np.isinf(reach)):  # of what is no sum
            reach[row] = extent(parts.shapes[row], placed.rotation[row], -normal)
        depth = offset + reach - placed.position @ normal
        depth[~parts.movable | (depth <= DRAWN_IN * parts.thickness)] = 0.0
        deepest = int(np.argmax(depth))
        if depth[deepest] > 0.0:
            yield Inside(float(depth[deepest]), parts.names[deepest], name)


def _in_walls(bodies: dict[str, CellBody], parts: Parts) -> Iterator[Inside]:
    """Yield of each cavity the movable solids that reach into its wall, by their corners."""
    for name, body in bodies.items():
        if not isinstance(body.shape, Cavity):
            continue
        across = np.eye(3)
        if isinstance(body.shape, Drum):
            along = rotation_of(body)[:, 2]
            across = across - np.outer(along, along)
        for row in np.flatnonzero(parts.movable):
            shape, centre = parts.shapes[row], parts.placed.position[row] - vector(body.position)
            ball = shape.radius if isinstance(shape, Sphere) else 0.0
            corners = np.zeros((1, 3)) if ball else np.array(shape.corners())
            points = centre + corners @ parts.placed.rotation[row].T
            depth = float(np.linalg.norm(points @ across, axis=1).max()) + ball - body.shape.radius
            if depth > DRAWN_IN * parts.thickness[row]:
                yield Inside(depth, parts.names[row], name)


def _behind_meshes(bodies: dict[str, CellBody], parts: Parts) -> Iterator[Inside]:
    """Yield of each mesh the movable solids whose centre is behind it where it is nearest."""
    left = MOST_TRIANGLES
    for name, body in bodies.items():
        if not isinstance(body.shape, CellMesh):
            continue
        from lavendersim.geometry.triangle_mesh import depth_behind, surface_of  # few need it

        surface = surface_of(body.shape.vertices, body.shape.triangles)
        centres = (parts.placed.position - vector(body.position)) @ rotation_of(body)
        for row in np.flatnonzero(parts.movable):
            left -= len(surface.triangles)
            if left < 0:
                return
            depth = depth_behind(surface, centres[row])
            if depth > DRAWN_IN * parts.thickness[row]:
                yield Inside(depth, parts.names[row], name)


def _inside(parts: Parts) -> list[Inside]:
    """Return every pair of bodies that overlaps."""
    names, shapes, placed = parts.names, parts.shapes, parts.placed
    balls = np.array([shape.bounding_radius() for shape in shapes])
    bounds = parts.sums._replace(ball=np.minimum(parts.sums.ball, balls))  # of what is no sum
    kinds = np.array([kind_of(shape) for shape in shapes])
    a, b = near_pairs(bounds, placed, parts.movable)
    touching = DRAWN_IN * np.minimum(parts.thickness[a], parts.thickness[b])
    apart = np.linalg.norm(placed.position[a] - placed.position[b], axis=1)
    near = balls[a] + balls[b] - apart > touching  # no pair is deeper than its bounding spheres
    a, b, touching = a[near], b[near], touching[near]
    deep = np.full(len(a), np.nan)
    for one, other in sorted(set(zip(kinds[a].tolist(), kinds[b].tolist(), strict=True))):
        rows = (kinds[a] == one) & (kinds[b] == other)
        deep[rows] = depths(one, other, placed.take(a[rows]), placed.take(b[rows]))
    found: dict[tuple[str, str], float] = {}
    for row in np.flatnonzero(deep > touching):
        _note(found, names[b[row]], names[a[row]], float(deep[row]))
    for row in np.flatnonzero(np.isnan(deep))[:MOST_PAIRS]:
        first, second = (
            _corners(shapes[k], placed.position[k], placed.rotation[k]) for k in (a[row], b[row])
        )
        if names[a[row]] != names[b[row]] and hulls_meet(first, second):
            _note(found, names[b[row]], names[a[row]], 0.0)
    return [Inside(depth, *pair) for pair, depth in found.items()]


def _note(found: dict[tuple[str, str], float], name: str, other: str, depth: float) -> None:
    if name != other:  # parts of one body
        found[name, other] = max(depth, found.get((name, other), 0.0))


def _corners(shape: CellSimple, position: Floats, rotation: Floats) -> Floats:
    """Return the corners of a shape in the world, drawn in towards its centre [m]."""
    corners: Floats = position + (1.0 - DRAWN_IN) * np.asarray(shape.corners()) @ rotation.T
    return corners
