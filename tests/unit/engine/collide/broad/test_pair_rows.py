"""Pairs, found in any order, become rows in ascending order of their key, with their template."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from interpreted import interpreted, records

from lavendersim.engine.collide.broad.broad_phase import allocate_broad_phase
from lavendersim.engine.collide.broad.pair_rows import make_put_pair, make_write_rows
from lavendersim.engine.record_layout import template_dtype
from lavendersim.engine.records import BODY, PAIR, dtype
from lavendersim.engine.spec import Spec

SURFACE = [("friction", "f8"), ("restitution", "f8")]
SPEC = Spec(("broad_phase",))
N = 7


def table(rng) -> np.ndarray:
    """Return templates of three classes; class 2 never touches itself."""
    templates = np.zeros((3, 3), template_dtype(SURFACE))
    templates["kind"] = np.arange(9).reshape(3, 3)
    templates["kind"][2, 2] = -1
    templates["swap"] = [[0, 1, 0], [0, 1, 0], [1, 0, 0]]
    templates["friction"], templates["restitution"] = rng.uniform(size=(2, 3, 3))
    return templates


def bodies_of(materials) -> np.ndarray:
    bodies = np.zeros(len(materials), dtype(BODY, [("material", "i8")]))
    bodies["material"] = materials
    return bodies


def put(bodies, templates, pairs, room: int):
    work = allocate_broad_phase(len(bodies), room)
    put_pair, found = interpreted(make_put_pair(SPEC)), 0
    for i, j in pairs:
        found = put_pair(records(bodies), records(templates), i, j, records(work), found)
    return work, found


@pytest.mark.parametrize("first", [0, 3])
def test_rows_are_those_of_a_sort_by_both_bodies(rng, first: int) -> None:
    """From the first row on that is free: before it are those of ropes and joints."""
    templates, bodies = table(rng), bodies_of(rng.integers(0, 3, N))
    every = list(combinations(range(N), 2))
    for count in (0, 1, 8, len(every)):
        chosen = [every[k] for k in rng.permutation(len(every))[:count]]
        either = [pair if rng.random() < 0.5 else pair[::-1] for pair in chosen]
        work, found = put(bodies, templates, either, len(every))
        material = bodies["material"]
        expected = sorted(
            p for p in chosen if templates[material[p[0]], material[p[1]]]["kind"] >= 0
        )
        assert found == len(expected)
        rows = np.zeros(first + len(every), dtype(PAIR, SURFACE))
        write = interpreted(make_write_rows(SPEC, [name for name, _ in SURFACE]))
        write(records(bodies), records(templates), records(work), found, records(rows), first)
        assert not rows[:first]["kind"].any()
        for row, (i, j) in zip(rows[first : first + found], expected, strict=True):
            template = templates[material[i], material[j]]
            assert row["key"] == i * N + j
            assert (row["a"], row["b"]) == ((j, i) if template["swap"] else (i, j))
            for name in ("kind", "friction", "restitution"):
                assert row[name] == template[name]
        assert not rows[first + found :]["key"].any()


def test_pairs_beyond_the_room_are_counted_and_not_kept(rng) -> None:
    every = list(combinations(range(N), 2))
    work, found = put(bodies_of([0] * N), table(rng), every, 4)
    assert found == len(every)
    assert list(zip(work.found.first, work.found.second, strict=True)) == every[:4]


def test_a_template_without_a_surface_gives_its_kind_alone(rng) -> None:
    templates, bodies = table(rng), bodies_of([0, 1])
    work, found = put(bodies, templates, [(1, 0)], 1)
    rows = np.zeros(1, dtype(PAIR))
    make = interpreted(make_write_rows(SPEC, []))
    make(records(bodies), records(templates), records(work), found, records(rows), 0)
    assert rows[0].tolist() == (1, 0, 1, 1)  # a, b by the template's swap, its kind, key 0 N + 1
