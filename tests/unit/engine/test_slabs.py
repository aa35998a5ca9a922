"""Slabs: contacts of a large scene in the order of its longest axis, colours within each slab."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from interpreted import interpreted, records

from lavendersim.engine import ordering, slabs
from lavendersim.engine.record_layout import allocate_bodies, contact_dtype
from lavendersim.engine.slabs import LAYERS, allocate_slabs, make_lay_bodies, make_sort_by_slabs
from lavendersim.engine.spec import Spec

SPEC = Spec(order="coloured", solver="adaptive", effects=("packed_sweeps",))


def laid(places: np.ndarray, fixed: int = 0) -> np.ndarray:
    """Return the layers of bodies at these places, of which the first so many are fixed."""
    bodies, work = allocate_bodies(SPEC, len(places)), allocate_slabs(len(places), 0)
    for axis, column in zip("xyz", places.T, strict=True):
        bodies[axis] = column
    bodies["inv_m"][fixed:] = 1.0
    with np.errstate(over="ignore"):
        interpreted(make_lay_bodies(SPEC))(records(bodies), records(work))
    return work.body_layer


@pytest.mark.parametrize("axis", range(3))
def test_layers_follow_the_longest_axis_wherever_the_scene_is(axis: int, rng) -> None:
    size = np.array([1.0, 2.0, 3.0])
    size[axis] = 20.0
    places = rng.uniform(-0.5, 0.5, (200, 3)) * size
    places[:3] = 1e6  # fixed: they do not count
    layers = laid(places, fixed=3)
    assert (layers[:3] == LAYERS).all()
    by_place = np.argsort(places[3:, axis])
    assert (np.diff(layers[3:][by_place]) >= 0).all()
    # uniform over L: a spread of L / sqrt(12), so 4 spreads of layers are 1.15 L
    assert np.ptp(layers[3:]) > 0.8 * LAYERS
    far = laid(places + np.array([1e3, -1e3, 1e3]), fixed=3)
    assert np.abs(far - layers).max() <= 1  # but for the last digits of places


@pytest.mark.parametrize(
    "places", [np.ones((4, 3)), *(np.eye(3) * far for far in (2e154, 1e200)), np.zeros((0, 3))]
)
def test_bodies_without_a_spread_that_is_a_number_lie_in_one_layer(places: np.ndarray) -> None:
    assert not laid(places).any()


@pytest.mark.parametrize("thick", [1, 7, 1000])
def test_contacts_go_slab_by_slab_and_keep_their_order_in_each(
    thick: int, rng, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(slabs, "THICK", thick)
    work, count = allocate_slabs(0, 300), 300
    work.layer[:] = rng.choice([0, 3, 4, 500, LAYERS - 1, LAYERS], count)
    before = rng.permutation(count).astype(np.uint64)
    order, place = before.copy(), np.empty(count, np.int64)
    interpreted(make_sort_by_slabs(SPEC))(order, count, records(work))
    assert sorted(order.tolist()) == list(range(count))
    place[before.astype(np.int64)] = np.arange(count)
    slab = work.slab[work.layer[order.astype(np.int64)]]
    assert (np.diff(slab) >= 0).all()
    for own in range(slab[-1] + 1):
        members = order[slab == own].astype(np.int64)
        assert (np.diff(place[members]) > 0).all()
        assert own == slab[-1] or len(members) >= thick
    # whole layers, and no more of them than it takes
    layers = [set(work.layer[order[slab == own].astype(np.int64)]) for own in range(slab[-1] + 1)]
    assert sum(map(len, layers)) == len(set().union(*layers)) == 6
    assert (slab[-1] > 0) == (thick < count)


def test_only_scenes_of_many_contacts_are_cut(rng, monkeypatch: pytest.MonkeyPatch) -> None:
    """A row of balls: every other contact first, or so slab by slab from one end to the other."""
    count = 64
    contacts, bodies = np.zeros(count, contact_dtype(SPEC)), allocate_bodies(SPEC, count + 1)
    contacts["a"], contacts["b"] = np.arange(count), np.arange(1, count + 1)
    contacts["key"] = np.arange(count)
    bodies["x"], bodies["inv_m"] = np.arange(count + 1.0), 1.0

    def found(fewest: int) -> list[Any]:
        monkeypatch.setattr(ordering, "FEWEST_CONTACTS", fewest)
        monkeypatch.setattr(slabs, "THICK", 8)
        work = ordering.allocate_ordering(SPEC, len(bodies), count)
        order_contacts = interpreted(ordering.make(SPEC))
        order_contacts(records(bodies), records(contacts), count, work)
        return work.order.tolist()

    alternating = [*range(0, count, 2), *range(1, count, 2)]
    assert found(count + 1) == alternating
    cut = found(count)
    assert sorted(cut) == list(range(count))
    for k in range(0, count, 8):
        assert cut[k : k + 8] == [*range(k, k + 8, 2), *range(k + 1, k + 8, 2)]


def test_an_engine_that_does_not_pack_has_no_slabs() -> None:
    assert ordering.allocate_ordering(SPEC.without("packed_sweeps"), 3, 5).slabs == ()
