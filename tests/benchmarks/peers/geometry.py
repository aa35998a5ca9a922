"""How deep bodies overlap, from their poses alone. No engine is asked.

Boxes by separating axes: the depth is the least overlap of the two shadows over the fifteen
directions (three faces each, nine products of edges). Spheres in closed form, corners for planes.
"""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np

from .description import Body, Box, Plane, Scene, Sphere

# Edges at a smaller sine are parallel: a face says the same, and the product has lost its digits.
PARALLEL: Final = 1e-6
CORNERS: Final = np.array(list(product((-1.0, 1.0), repeat=3)))


def matrices(quaternions: np.ndarray) -> np.ndarray:
    """Return body-to-world matrices, shape (n, 3, 3), of quaternions w x y z, shape (n, 4)."""
    w, x, y, z = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def box_box(
    apart: np.ndarray, turns: tuple[np.ndarray, np.ndarray], halves: tuple[np.ndarray, np.ndarray]
) -> np.ndarray:
    """Return the depth of n pairs of boxes, negative where they are apart.

    apart: centre of B minus centre of A (n, 3) [m]; turns: matrices of A and B (n, 3, 3);
    halves: half edges (n, 3) [m].
    """
    faces = np.concatenate([np.swapaxes(turn, 1, 2) for turn in turns], axis=1)  # (n, 6, 3)
    edges = np.cross(faces[:, :3, None], faces[:, None, 3:]).reshape(len(apart), 9, 3)
    length = np.linalg.norm(edges, axis=2, keepdims=True)
    parallel = length < PARALLEL
    axes = np.concatenate([faces, edges / np.where(parallel, 1.0, length)], axis=1)
    reach = sum(
        (np.abs(axes @ turn) * half[:, None]).sum(axis=2)
        for turn, half in zip(turns, halves, strict=True)
    )
    overlap = reach - np.abs((axes * apart[:, None]).sum(axis=2))
    overlap[:, 6:][parallel[:, :, 0]] = np.inf
    found: np.ndarray = overlap.min(axis=1)
    return found


def sphere_box(offset: np.ndarray, turn: np.ndarray, half: np.ndarray, radius: float) -> float:
    """Return how deep a sphere lies in a box; offset: centre minus the box's centre [m]."""
    over = np.abs(turn.T @ offset) - half
    outside = float(np.linalg.norm(np.maximum(over, 0.0)))
    return radius - outside - min(float(over.max()), 0.0)


def in_plane(plane: Plane, body: Body, centre: np.ndarray, turn: np.ndarray) -> float:
    """Return how deep a body lies below a plane."""
    normal = np.array(plane.normal)
    height = float(normal @ centre) - plane.offset
    if isinstance(body.shape, Sphere):
        return body.shape.radius - height
    assert isinstance(body.shape, Box)
    corners = CORNERS * (0.5 * np.array(body.shape.size)) @ turn.T
    return float(-(corners @ normal).min()) - height


def _among_spheres(centres: np.ndarray, radii: np.ndarray) -> float:
    """Return the greatest depth among spheres; neighbours along x are enough to look at."""
    order = np.argsort(centres[:, 0])
    centres, radii = centres[order], radii[order]
    deepest = -np.inf
    last = np.searchsorted(centres[:, 0], centres[:, 0] + 2.0 * radii.max(), side="right")
    for k, end in enumerate(last):
        if end > k + 1:
            away = np.linalg.norm(centres[k + 1 : end] - centres[k], axis=1)
            deepest = max(deepest, float((radii[k] + radii[k + 1 : end] - away).max()))
    return deepest


def _among_boxes(centres: np.ndarray, turns: np.ndarray, halves: np.ndarray) -> float:
    bound = np.linalg.norm(halves, axis=1)
    away = np.linalg.norm(centres[:, None] - centres, axis=2)
    a, b = np.nonzero(np.triu(away < bound[:, None] + bound, 1))
    if not len(a):
        return -np.inf
    depths = box_box(centres[b] - centres[a], (turns[a], turns[b]), (halves[a], halves[b]))
    return float(depths.max())


def deepest(scene: Scene, poses: np.ndarray) -> float:
    """Return the greatest depth [m] in the scene at one instant; poses: (movable, 7), >= 0."""
    moving = scene.movable
    static = np.array([[*body.position, *body.orientation] for body in scene.fixed])
    everything = np.concatenate([poses, static.reshape(-1, 7)])
    if not np.isfinite(everything).all():
        return np.inf
    bodies, turns = (*moving, *scene.fixed), matrices(everything[:, 3:])
    spheres = [k for k, body in enumerate(bodies) if isinstance(body.shape, Sphere)]
    boxes = [k for k, body in enumerate(bodies) if isinstance(body.shape, Box)]
    centres = everything[:, :3]
    found = [0.0]
    for plane in (body.shape for body in scene.fixed if isinstance(body.shape, Plane)):
        found += [in_plane(plane, body, centres[k], turns[k]) for k, body in enumerate(moving)]
    if len(spheres) > 1:
        radii = np.array([bodies[k].shape.radius for k in spheres])  # type: ignore[union-attr]
        found.append(_among_spheres(centres[spheres], radii))
    halves = {k: 0.5 * np.array(bodies[k].shape.size) for k in boxes}  # type: ignore[union-attr]
    if len(boxes) > 1:
        stacked = np.array([halves[k] for k in boxes])
        found.append(_among_boxes(centres[boxes], turns[boxes], stacked))
    for k, j in product(spheres, boxes):
        radius = bodies[k].shape.radius  # type: ignore[union-attr]
        found.append(sphere_box(centres[k] - centres[j], turns[j], halves[j], radius))
    return max(found)
