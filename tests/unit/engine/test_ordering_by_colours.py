"""The coloured order: rows of one colour share no body that moves, each manifold's in turn."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted, records

from lavendersim.engine import ordering
from lavendersim.engine.ordering import COLOURS, FEWEST, MANIFOLD_ROWS
from lavendersim.engine.record_layout import allocate_bodies, contact_dtype
from lavendersim.engine.spec import Spec

SPEC = Spec(order="coloured")


def ordered(manifolds: list[tuple[int, int, int]], bodies: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the order, and the bucket of each contact; a manifold: two bodies and its rows."""
    rows = [(a, b, k) for k, (a, b, count) in enumerate(manifolds) for _ in range(count)]
    contacts, found = np.zeros(len(rows), contact_dtype(SPEC)), allocate_bodies(SPEC, bodies)
    contacts["a"], contacts["b"], contacts["key"] = np.array(rows).T
    found["inv_m"][1:] = 1.0
    work = ordering.allocate_ordering(SPEC, bodies, len(rows))
    order_contacts = interpreted(ordering.make(SPEC))
    order_contacts(records(found), records(contacts), len(rows), work)
    return work.order[: len(rows)], work.bucket_of[: len(rows)]


@pytest.mark.parametrize("count", [3, 12, 40])
def test_rows_of_a_colour_share_no_body_that_moves(count: int, rng) -> None:
    """Body 0 is fixed, and in as many of them as may be."""
    pairs = [sorted(rng.choice(9, 2, replace=False).tolist()) for _ in range(count)]
    manifolds = [(a, b, int(rng.integers(1, 6))) for a, b in pairs]
    order, buckets = ordered(manifolds, 9)
    ends = np.array([(a, b) for a, b, rows in manifolds for _ in range(rows)])
    numbers = np.repeat(np.arange(count), [rows for _, _, rows in manifolds])
    assert sorted(order.tolist()) == list(range(len(ends)))
    if len(ends) < FEWEST:
        assert order.tolist() == list(range(len(ends)))
        return
    assert (np.diff(buckets[order]) >= 0).all()
    colours, places = np.divmod(buckets, MANIFOLD_ROWS)
    assert colours.max() < COLOURS - 1
    assert colours.max() > 1
    for k in range(count):
        own = numbers == k
        assert len(set(colours[own])) == 1
        assert places[own].tolist() == [min(r, MANIFOLD_ROWS - 1) for r in range(own.sum())]
    for colour in set(colours.tolist()):
        moving = [body for k in set(numbers[colours == colour]) for body in pairs[k] if body > 0]
        assert len(moving) == len(set(moving))
