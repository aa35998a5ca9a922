"""Labels of islands against a flood fill; they do not depend on the order of the contacts."""

from __future__ import annotations

import numpy as np
from laboratory import EVERYTHING

from lavendersim.engine.islands import NO_ISLAND, make_label_islands
from lavendersim.engine.records import BODY, CONTACT, dtype

label_islands = make_label_islands(EVERYTHING)


def labels(movable: np.ndarray, joined: np.ndarray) -> np.ndarray:
    bodies = np.zeros(len(movable), dtype(BODY))
    bodies["inv_m"] = movable
    contacts = np.zeros(len(joined), dtype(CONTACT))
    contacts["a"], contacts["b"] = joined[:, 0], joined[:, 1]
    parent = np.full(len(movable), 77)
    label_islands(contacts.view(np.recarray), len(joined), bodies.view(np.recarray), parent)
    return parent


def flooded(movable: np.ndarray, joined: np.ndarray) -> np.ndarray:
    """Relax every contact to the lesser label until nothing changes."""
    found = np.where(movable, np.arange(len(movable)), NO_ISLAND)
    kept = [(a, b) for a, b in joined if movable[a] and movable[b]]
    while True:
        before = found.copy()
        for a, b in kept:
            found[a] = found[b] = min(found[a], found[b])
        if (before == found).all():
            return found


def test_labels_are_the_least_body_of_each_island(rng):
    for _ in range(50):
        count = int(rng.integers(1, 30))
        movable = rng.random(count) < 0.8
        joined = rng.integers(0, count, (int(rng.integers(0, 25)), 2))
        np.testing.assert_array_equal(labels(movable, joined), flooded(movable, joined))


def test_labels_do_not_depend_on_the_order_of_contacts(rng):
    movable = np.ones(40, bool)
    joined = rng.integers(0, 40, (35, 2))
    first = labels(movable, joined)
    for _ in range(5):
        np.testing.assert_array_equal(labels(movable, rng.permutation(joined)), first)


def test_stacks_on_one_floor_are_islands_of_their_own():
    movable = np.array([False, True, True, True, True])
    joined = np.array([(0, 1), (1, 2), (0, 3), (3, 4)])
    assert labels(movable, joined).tolist() == [NO_ISLAND, 1, 1, 3, 3]
