"""Bodies that start inside one another or behind a plane.

Planes: exactly, by the body's extent against the normal. Spheres, boxes, capsules: the depth of
`measures.penetration`. Every other pair: GJK between the corners of both, each drawn in by
DRAWN_IN towards its centre, so that what merely touches is not found.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from lavendersim.cell import CellBody, Plane
from lavendersim.cell.shapes import CellSimple
from lavendersim.errors import Defect
from lavendersim.experiment import Cell, body_path
from lavendersim.geometry.bodies import is_movable, rotation_of
from lavendersim.geometry.point_sets import hulls_meet
from lavendersim.geometry.rotations import Floats, rotation_matrix
from lavendersim.geometry.shapes import extent, half_space, pieces, thickness
from lavendersim.measures.penetration import depths
from lavendersim.measures.solids import PlacedSolids, kind_of, near_pairs, size_of, sums_of

DRAWN_IN: Final = 0.01  # share of a shape's size that counts as touching
MOST_PAIRS: Final = 2000  # that GJK looks at, some 0.2 ms each


def overlaps(cell: Cell) -> Iterator[Defect]:
    """Yield a defect at the deepest body behind a plane, and at the deepest inside another."""
    bodies = cell.config.scene.bodies
    behind = max(_behind_planes(bodies), default=None)
    if behind is not None:
        depth, name, plane = behind
        yield _defect(cell, name, f"{name} starts {depth:.3g} m behind the surface of {plane}")
    inside = _inside(bodies)
    if inside:
        depth, name, other = max(inside)
        far = f"{depth:.3g} m " if depth > 0.0 else ""
        more = f"; so do {len(inside) - 1} more pairs" if len(inside) > 1 else ""
        yield _defect(cell, name, f"{name} starts {far}inside {other}{more}")


def _defect(cell: Cell, name: str, sentence: str) -> Defect:
    tree, path = cell.tree, body_path(cell.tree, name)
    written = next((key for key in ("position", "release") if tree.get(*path, key)), None)
    return cell.defect((*path, written) if written else path, sentence)


def _behind_planes(bodies: dict[str, CellBody]) -> Iterator[tuple[float, str, str]]:
    """Yield depth [m], body and plane wherever a movable body reaches far behind one."""
    planes = {name: half_space(b.shape) for name, b in bodies.items() if isinstance(b.shape, Plane)}
    for name, body in bodies.items() if planes else ():
        if not is_movable(body):
            continue
        turn = rotation_of(body)
        for plane, (normal, offset) in planes.items():
            reach = extent(body.shape, turn, -normal)
            depth = offset + reach - float(normal @ np.asarray(body.position))
            if depth > DRAWN_IN * thickness(body.shape):
                yield depth, name, plane


def _inside(bodies: dict[str, CellBody]) -> list[tuple[float, str, str]]:
    """Return depth [m] (0 where it is not known) and names of every pair that overlaps."""
    solids = {name: body for name, body in bodies.items() if not isinstance(body.shape, Plane)}
    names, shapes, positions, turns, movable = [], [], [], [], []
    for name, body in solids.items():
        turn = rotation_of(body)
        for piece in pieces(body.shape):
            names.append(name)
            shapes.append(piece.shape)
            positions.append(np.asarray(body.position) + turn @ piece.position)
            turns.append(turn @ rotation_matrix(piece.orientation))
            movable.append(is_movable(body))
    if len(solids) < 2:
        return []
    placed = PlacedSolids(
        np.array(positions), np.array(turns), np.array([size_of(shape) for shape in shapes])
    )
    bounds = sums_of(shapes)
    balls = np.array([shape.bounding_radius() for shape in shapes])
    bounds = bounds._replace(ball=np.minimum(bounds.ball, balls))  # of what is no sum
    kinds = np.array([kind_of(shape) for shape in shapes])
    thick = np.array([thickness(shape) for shape in shapes])
    a, b = near_pairs(bounds, placed, np.array(movable))
    found: dict[tuple[str, str], float] = {}
    for one, other in set(zip(kinds[a].tolist(), kinds[b].tolist(), strict=True)):
        rows = (kinds[a] == one) & (kinds[b] == other)
        first, second = a[rows], b[rows]
        deep = depths(one, other, placed.take(first), placed.take(second))
        touching = DRAWN_IN * np.minimum(thick[first], thick[second])
        unknown = np.isnan(deep)
        for i, j, depth in zip(
            first[deep > touching], second[deep > touching], deep[deep > touching], strict=True
        ):
            _note(found, names[j], names[i], float(depth))
        for i, j in zip(first[unknown][:MOST_PAIRS], second[unknown][:MOST_PAIRS], strict=True):
            if names[i] != names[j] and hulls_meet(
                _corners(shapes[i], placed.position[i], placed.rotation[i]),
                _corners(shapes[j], placed.position[j], placed.rotation[j]),
            ):
                _note(found, names[j], names[i], 0.0)
    return [(depth, *pair) for pair, depth in found.items()]


def _note(found: dict[tuple[str, str], float], name: str, other: str, depth: float) -> None:
    if name != other:  # parts of one body
        found[name, other] = max(depth, found.get((name, other), 0.0))


def _corners(shape: CellSimple, position: Floats, rotation: Floats) -> Floats:
    """Return the corners of a shape in the world, drawn in towards its centre [m]."""
    corners: Floats = position + (1.0 - DRAWN_IN) * np.asarray(shape.corners()) @ rotation.T
    return corners
