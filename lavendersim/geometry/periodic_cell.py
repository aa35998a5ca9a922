"""Places in a periodic cell: within it, or nearest to others (minimum image convention)."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np

from lavendersim.geometry.rotations import Floats


def _ends(periodic: Any) -> Iterator[tuple[int, float, float]]:
    """Yield each periodic axis with both ends of the cell [m]; nothing without a cell."""
    for axis, name in enumerate("xyz"):
        ends = getattr(periodic, name, None)
        if ends is not None:
            yield axis, ends[0], ends[1]


def bounds_with_cell(low: Floats, high: Floats, periodic: Any) -> tuple[Floats, Floats]:
    """Return the bounds (3,) of a box [m] that has the cell in it, too, where that has ends."""
    low, high = low.copy(), high.copy()
    for axis, lower, upper in _ends(periodic):
        low[axis], high[axis] = min(low[axis], lower), max(high[axis], upper)
    return low, high


def edges_of_cell(low: Floats, high: Floats, periodic: Any) -> Floats:
    """Return both ends of the edges of the cell (12, 2, 3) [m]; (0, 2, 3) without one.

    low, high: bounds (3,) of what is drawn, to which it goes where it is not periodic.
    """
    low, high = low.copy(), high.copy()
    for axis, lower, upper in _ends(periodic):
        low[axis], high[axis] = lower, upper
    edges = []
    for axis in range(3) if periodic is not None else ():
        others = [k for k in range(3) if k != axis]
        for ends in product(*((low[k], high[k]) for k in others)):
            edge = np.array([low, high])
            edge[:, others] = ends
            edges.append(edge)
    return np.reshape(edges, (-1, 2, 3))


def faces_of_cell(periodic: Any) -> Iterator[tuple[Floats, float]]:
    """Yield the normal (3,) and the offset [m] of each face that is one of the cell's ends."""
    for axis, *ends in _ends(periodic):
        for end in ends:
            yield np.eye(3)[axis], end


def wrapped(places: Floats, periodic: Any) -> Floats:
    """Return places (..., 3) [m], each moved by whole periods into the cell.

    periodic: of a scene, with both ends of the cell along x, y and z; None: as they are.
    """
    found = places
    for axis, low, high in _ends(periodic):
        found = found.copy() if found is places else found
        along = places[..., axis]
        found[..., axis] = along - (high - low) * np.floor((along - low) / (high - low))
    return found


def in_cell(poses: Floats, periodic: Any) -> Floats:
    """Return poses (..., 7) whose places are wrapped; without a cell those that were given."""
    if periodic is None:
        return poses
    return np.concatenate([wrapped(poses[..., :3], periodic), poses[..., 3:]], axis=-1)


def nearest_images(places: Floats, others: Floats, periodic: Any) -> Floats:
    """Return the images of places (..., 3) [m] that are nearest to others."""
    found = places
    for axis, low, high in _ends(periodic):
        found = found.copy() if found is places else found
        away = (others[..., axis] - places[..., axis]) / (high - low)
        found[..., axis] += (high - low) * np.floor(away + 0.5)
    return found


def images_that_reach(places: Floats, half: Floats, periodic: Any) -> tuple[Any, Floats]:
    """Return rows (m,) and places (m, 3) [m]: all in the cell, and those of images that reach in.

    half: (n, 3) of the bounds round each place [m]; less than half a period along every axis. Two
    boxes of which any images meet have two among these that do.
    """
    rows, found = np.arange(len(places)), wrapped(places, periodic)
    for axis, low, high in _ends(periodic):
        along, reach = found[:, axis], half[rows, axis]
        moves = np.zeros((1, 3))
        moves[0, axis] = high - low
        below, above = along - reach <= low, along + reach >= high
        found = np.concatenate([found, found[below] + moves, found[above] - moves])
        rows = np.concatenate([rows, rows[below], rows[above]])
    return rows, found
