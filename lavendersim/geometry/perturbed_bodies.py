"""Bodies moved a little at the start, drawn by a seed, so that no symmetry of a scene is luck.

Each movable body is moved by up to `distance` along each world axis, then put back along gravity
and along the normals of the planes, and of the faces of fixed boxes, that some body touches: bodies
stay on their floors and at their walls, towers on each other.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lavendersim.cell.body import CellBody
from lavendersim.cell.shapes import Box, Plane
from lavendersim.geometry.bodies import is_movable, rotation_of
from lavendersim.geometry.shapes import extent
from lavendersim.quantities.quantity import Vector3

Floats = NDArray[np.float64]
INDEPENDENT: Final = 1e-9  # what is left of a unit normal within the span of others: round-off


def perturbed(
    bodies: Mapping[str, CellBody], seed: int, distance: float, gravity: Vector3
) -> dict[str, CellBody]:
    """Return the bodies at their perturbed places; distance [m], gravity [m/s^2]."""
    kept = _directions(bodies, distance, gravity)
    # `random()` alone gives the same numbers in every version of Python.
    draw = random.Random(seed).random
    found = {}
    for name, body in bodies.items():
        if is_movable(body):
            shift = distance * (2.0 * np.array([draw(), draw(), draw()]) - 1.0)
            shift -= kept.T @ (kept @ shift)
            x, y, z = (float(one) for one in np.array(body.position) + shift)
            body = body.model_copy(update={"position": (x, y, z)})
        found[name] = body
    return found


def _directions(bodies: Mapping[str, CellBody], distance: float, gravity: Vector3) -> Floats:
    """Return orthonormal directions along which nothing is moved (k, 3)."""
    movable = [body for body in bodies.values() if is_movable(body)]
    planes = [body.shape for body in bodies.values() if isinstance(body.shape, Plane)]
    normals = [np.array(plane.normal) for plane in planes if _stood_on(plane, movable, distance)]
    for body in bodies.values():
        if isinstance(body.shape, Box) and not is_movable(body):
            normals += _touched_faces(body, body.shape, movable, distance)
    pull = np.array(gravity)
    if pull.any():
        normals.append(pull / np.linalg.norm(pull))
    kept = np.zeros((0, 3))
    for normal in normals:
        rest = normal - kept.T @ (kept @ normal)
        if (size := float(np.linalg.norm(rest))) > INDEPENDENT:
            kept = np.vstack([kept, rest / size])
    return kept


def _touched_faces(
    box: CellBody, shape: Box, movable: list[CellBody], within: float
) -> list[Floats]:
    """Return the axes of a box at whose faces some body is as near as bodies are moved."""
    turn, half = rotation_of(box), 0.5 * np.array(shape.size)
    found = []
    for body in movable:
        away = turn.T @ (np.array(body.position) - np.array(box.position))
        own = rotation_of(body)
        reach = [  # towards the box and away from it, along each of its axes
            (extent(body.shape, own, -axis), extent(body.shape, own, axis)) for axis in turn.T
        ]
        gaps = [
            max(place - low, -place - high) - size
            for place, (low, high), size in zip(away, reach, half, strict=True)
        ]
        nearest = int(np.argmax(gaps))  # outside the box it is apart along this axis, or along none
        if abs(gaps[nearest]) < within:
            found.append(turn[:, nearest])
    return found


def _stood_on(plane: Plane, movable: list[CellBody], within: float) -> bool:
    """Return whether some body is as near to a plane as bodies are moved."""
    normal = np.array(plane.normal)
    return any(
        float(normal @ np.array(body.position))
        - extent(body.shape, rotation_of(body), -normal)
        - plane.offset
        < within
        for body in movable
    )
