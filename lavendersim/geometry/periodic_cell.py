"""Places in a periodic cell: within it, or nearest to others (minimum image convention)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from lavendersim.geometry.rotations import Floats


def _ends(periodic: Any) -> Iterator[tuple[int, float, float]]:
    """Yield each periodic axis with both ends of the cell [m]; nothing without a cell."""
    for axis, name in enumerate("xyz"):
        ends = getattr(periodic, name, None)
        if ends is not None:
            yield axis, ends[0], ends[1]


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
