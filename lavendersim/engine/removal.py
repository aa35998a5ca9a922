"""Taking a body out of an engine between two steps.

What is removed stays where it is, as a body that is fixed and that nothing can touch: without mass
it is in no sum and no force moves it, and no pair of its rows is left. It has no velocity.
"""

from __future__ import annotations

import numpy as np

from .records import NO_PAIR, ROPE

# What says of a body that it moves, or may again.
_MOVES = (
    *("inv_m", "inv_ix", "inv_iy", "inv_iz", "kinematic", "asleep"),
    *("own_inv_m", "own_inv_ix", "own_inv_iy", "own_inv_iz"),
    *("fx", "fy", "fz", "tx", "ty", "tz"),
)


def rows_of(bodies: np.ndarray, body: int) -> np.ndarray:
    """Return which rows of the body table are a body and its parts."""
    if "owner" in (bodies.dtype.names or ()):
        return np.asarray(bodies["owner"] == body, np.bool_)
    return np.asarray(np.arange(len(bodies)) == body, np.bool_)


def hold_still(bodies: np.ndarray, velocities: np.ndarray, rows: np.ndarray) -> None:
    """Make rows fixed, for good."""
    for name in _MOVES:
        if name in (bodies.dtype.names or ()):
            bodies[name][rows] = 0
    velocities[rows] = np.zeros(1, velocities.dtype)


def cut_links(links: np.ndarray, bodies: np.ndarray, body: int) -> None:
    """Take out what joins a body to others; who is joined to nothing else is joined no more."""
    links["active"][(links["a"] == body) | (links["b"] == body)] = 0
    if "joined" in (bodies.dtype.names or ()):
        left = links[links["active"] == 1]
        bodies["joined"] = 0
        bodies["joined"][left["a"]] = 1
        bodies["joined"][left["b"]] = 1


def pairs_without(pairs: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Return the table of pairs without those of some rows of the body table."""
    return np.ascontiguousarray(pairs[~(rows[pairs["a"]] | rows[pairs["b"]])])


def larger_table(pairs: np.ndarray, count: int) -> np.ndarray:
    """Return a table of pairs with so many rows, in which ropes and joints stand as they did."""
    table = np.zeros(count, pairs.dtype)
    ropes = pairs[pairs["kind"] <= ROPE]
    table[: len(ropes)] = ropes
    return table


def connections_without(pairs: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Return the table of a broad phase without ropes and joints of some rows of the body table.

    What it had of other pairs is listed anew.
    """
    if not (pairs["kind"] <= ROPE).any():
        return pairs
    return larger_table(pairs_without(pairs, rows), len(pairs))


def make_untouchable(bodies: np.ndarray, templates: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Give rows a class of their own, which touches nothing; returns the templates with it."""
    classes = len(templates)
    grown = np.zeros((classes + 1, classes + 1), templates.dtype)
    grown["kind"] = NO_PAIR
    grown[:classes, :classes] = templates
    bodies["material"][rows] = classes
    return grown
