"""An estimate of how many contacts a step of a scene will have, before it runs.

    contacts
      settled |          ________    start: bounds that touch, times the points of a manifold
              |       .'             settled: what movable bodies rest on
        start | __..'                until then: what lies below g t^2 / 2 has landed
              +---------+------> t   T = sqrt(2 H / g), H: the height of the scene

A packing of frictional spheres that carries itself has between 4 and 6 neighbours each (Maxwell's
count of constraints), which is two to three contacts a sphere; a body with faces rests on four.
"""

from __future__ import annotations

from math import hypot, inf, sqrt
from typing import Final

import numpy as np

from lavendersim.cell import Cavity, CellBody, CellConfig, CellMesh, Convex, Plane, Sphere
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.meeting_boxes import meeting_boxes
from lavendersim.geometry.minkowski_sums import extents, sums_of
from lavendersim.geometry.rotations import rotation_matrices
from lavendersim.geometry.support import extent_against

FACE_POINTS: Final = 4  # of a manifold, at most
SPHERE_ON_SPHERES: Final = 2  # contacts of each, at the lower end of the count above
TOUCHING: Final = 1e-3  # gap, by the size of the smaller body, that counts as none
AXES: Final = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

Bounds = np.ndarray  # (n, 3) [m]


def expected_contacts(config: CellConfig) -> float:
    """Return about how many contacts a step has, the mean over the run."""
    bodies = list(config.scene.bodies.values())
    solids = [body for body in bodies if not isinstance(body.shape, Plane | Cavity | CellMesh)]
    low, high = _bounds(solids)
    start = _between_solids(solids, low, high) + _on_planes(bodies, solids, high - low)
    gravity = config.scene.gravity
    acceleration = hypot(*gravity)
    if acceleration == 0.0:
        return start
    sizes = (high.max(axis=0) - low.min(axis=0)).tolist()
    # shares of gravity first: with those of any size no product overflows
    height = sum(size * (abs(g) / acceleration) for size, g in zip(sizes, gravity, strict=True))
    fall = sqrt(2.0 * height / acceleration)  # [s]; 0 where coordinates hide what a body measures
    times = config.duration / fall if fall > 0.0 else inf
    # the mean of (t/T)^2, 1 from T on, over the run
    landed = times**2 / 3.0 if times < 1.0 else 1.0 - 2.0 / (3.0 * times)
    return start + landed * (max(start, _settled(solids)) - start)


def _points(body: CellBody) -> int:
    return body.shape.MOST_POINTS if isinstance(body.shape, Convex) else FACE_POINTS


def _settled(solids: list[CellBody]) -> float:
    """Return the contacts of a scene in which every movable body rests on something."""
    movable = [body for body in solids if is_movable(body)]
    spheres = sum(isinstance(body.shape, Sphere) for body in movable)
    several = SPHERE_ON_SPHERES if spheres > 1 else 1
    return sum(several if isinstance(body.shape, Sphere) else _points(body) for body in movable)


def _bounds(solids: list[CellBody]) -> tuple[Bounds, Bounds]:
    """Return the least and the largest coordinates of every body [m]."""
    centres = np.array([body.position for body in solids]).reshape(-1, 3)
    turns = rotation_matrices(np.array([body.orientation for body in solids]).reshape(-1, 4))
    sums = sums_of([body.shape for body in solids])
    half = np.stack([extents(sums, turns, np.array(axis)) for axis in AXES], axis=1)
    low, high = centres - half, centres + half
    for row in np.flatnonzero(np.isinf(half[:, 0])):  # of what is no sum
        for column, direction in enumerate(AXES):
            against = (-direction[0], -direction[1], -direction[2])
            low[row, column] = centres[row, column] - _extent(solids[row], direction)
            high[row, column] = centres[row, column] + _extent(solids[row], against)
    return low, high


def _extent(body: CellBody, direction: tuple[float, float, float]) -> float:
    assert not isinstance(body.shape, Plane | Cavity | CellMesh)  # they have no extent
    return extent_against(body.shape, body.orientation, direction)


def _between_solids(solids: list[CellBody], low: Bounds, high: Bounds) -> float:
    """Return the contacts of bodies whose bounds touch, and of spheres that touch themselves."""
    gap = TOUCHING * (high - low).min(axis=1)
    low, high = low - gap[:, None] / 2, high + gap[:, None] / 2
    first, second = meeting_boxes(low, high)
    movable = np.array([is_movable(body) for body in solids])
    points = np.array([_points(body) for body in solids])
    near = movable[first] | movable[second]
    spheres = np.array([isinstance(body.shape, Sphere) for body in solids])
    radius, centre = (high - low)[:, 0] / 2, (high + low) / 2
    apart = np.linalg.norm(centre[first] - centre[second], axis=1) > radius[first] + radius[second]
    near &= ~(spheres[first] & spheres[second] & apart)
    return float(np.minimum(points[first], points[second])[near].sum())


def _on_planes(bodies: list[CellBody], solids: list[CellBody], sizes: Bounds) -> float:
    """Return the contacts of movable bodies that touch a plane."""
    total = 0.0
    for shape in (body.shape for body in bodies):
        if not isinstance(shape, Plane):
            continue
        length = hypot(*shape.normal)
        x, y, z = (one / length for one in shape.normal)
        for body, size in zip(solids, sizes, strict=True):
            if not is_movable(body):
                continue
            px, py, pz = body.position
            gap = x * px + y * py + z * pz - shape.offset
            if gap - _extent(body, (x, y, z)) <= TOUCHING * size.min():
                total += _points(body)
    return total
