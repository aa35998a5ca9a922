"""The tree finds every box that overlaps another; its curve visits each cell and makes no jumps."""

from __future__ import annotations

from itertools import combinations, pairwise, product

import numpy as np
import pytest
from interpreted import interpreted, records

from lavendersim.engine.collide.broad import tree
from lavendersim.engine.collide.broad.tree import BOUNDS, DIGITS, LEAF, LEVELS, PLACE_BITS
from lavendersim.engine.records import dtype

TOP = 1 << PLACE_BITS
hilbert, spread, cell, size_class, overlap, may_pair = (
    interpreted(one)
    for one in (
        tree.hilbert,
        tree.spread,
        tree.cell,
        tree.size_class,
        tree.overlap,
        tree.may_pair,
    )
)


def test_spread_puts_bit_k_at_3k(rng) -> None:
    for n in (0, 1, TOP - 1, *rng.integers(0, TOP, 20).tolist()):
        bits = sum(((n >> k) & 1) << (3 * k) for k in range(PLACE_BITS))
        assert spread(n) == bits


def test_the_curve_visits_every_cell_once_and_steps_to_a_neighbour() -> None:
    """The 8^3 cells of a corner of the cube, and of a place within it, are a piece of the curve."""
    for corner in ((0, 0, 0), (8 * 4321, 8 * 77, 8 * 99999)):
        cells = [tuple(np.add(corner, c).tolist()) for c in product(range(8), repeat=3)]
        places = {hilbert(*c): c for c in cells}
        assert len(places) == 512
        order = sorted(places)
        assert order == list(range(order[0], order[0] + 512))
        for one, other in pairwise(order):
            assert np.abs(np.subtract(places[one], places[other])).sum() == 1


def test_places_on_the_curve_use_all_their_bits() -> None:
    assert {hilbert(*c) for c in product((0, TOP - 1), repeat=3)} >= {0, 8**PLACE_BITS - 1}


def test_cells_share_the_unit_interval_and_hold_what_lies_outside() -> None:
    assert [cell(x) for x in (-1.0, 0.0, 0.5, 1.0, 7.0, np.nan)] == [
        0,
        0,
        TOP // 2,
        TOP - 1,
        TOP - 1,
        0,
    ]
    assert cell(1.9 / TOP) == 1


def test_classes_of_size_are_a_factor_16_wide() -> None:
    found = [
        size_class(100.0 * f, 100.0) for f in (1.0, 1 / 15.9, 1 / 16.1, 1 / 255, 1 / 257, 1e-30)
    ]
    assert found == [0, 0, 1, 1, 2, 7]


@pytest.mark.parametrize("count", [0, 1, 5, 300])
def test_codes_are_sorted_stably_and_carry_their_bodies(count: int, rng) -> None:
    high = rng.integers(0, 8, count) << 60  # the classes, in the highest digit
    codes = high | rng.integers(0, 4, count) << 22 | rng.integers(0, 3, count)
    order, expected = np.arange(count), np.argsort(codes, kind="stable")
    before = codes.copy()
    spare = np.zeros((2, count), np.int64)
    interpreted(tree.sort_by_code)(codes, order, *spare, np.zeros(DIGITS + 1, np.int64), count)
    np.testing.assert_array_equal(order, expected)
    np.testing.assert_array_equal(codes, before[expected])


def random_leaves(rng, count: int) -> np.ndarray:
    leaves = np.zeros(count, dtype(LEAF))
    centre, half = rng.uniform(size=(count, 3)), rng.uniform(0.01, 0.08, (count, 3))
    for k, axis in enumerate("xyz"):
        leaves[f"low_{axis}"], leaves[f"high_{axis}"] = (
            centre[:, k] - half[:, k],
            centre[:, k] + half[:, k],
        )
        leaves[axis] = centre[:, k]
    leaves["radius"] = np.linalg.norm(half, axis=1)
    leaves["body"] = leaves["owner"] = np.arange(count)
    return leaves


def overlaps(a, b) -> bool:
    """Whether no axis parts two boxes."""
    return not any(
        a[f"high_{axis}"] < b[f"low_{axis}"] or b[f"high_{axis}"] < a[f"low_{axis}"]
        for axis in "xyz"
    )


@pytest.mark.parametrize("axis", "xyz")
def test_boxes_overlap_up_to_the_last_point_on_every_axis(axis: str) -> None:
    leaves = np.zeros(2, dtype(LEAF))
    for name in "xyz":
        leaves[f"high_{name}"] = 1.0
    a, b = records(leaves)
    for low, meets in ((1.0, True), (1.0 + 1e-15, False)):
        leaves[1][f"low_{axis}"], leaves[1][f"high_{axis}"] = low, 2.0
        assert bool(overlap(a, b)) is bool(overlap(b, a)) is meets


def test_leaves_pair_where_box_and_sphere_meet_unless_still_or_of_one_owner(rng) -> None:
    leaves = random_leaves(rng, 2)
    a, b = records(leaves)
    for k, axis in enumerate("xyz"):
        leaves[axis] = 0.0
        leaves[f"low_{axis}"], leaves[f"high_{axis}"] = -1.0, 1.0
        leaves[1][axis] = (2.0, 1.0, 2.0)[k]  # 3 apart
    leaves["radius"] = 2.0, 1.0
    assert may_pair(a, b)
    b.radius = 0.99
    assert not may_pair(a, b)
    b.radius = 1.0
    a.still = 1
    assert may_pair(a, b)
    b.still = 1
    assert not may_pair(a, b)
    a.still, b.owner = 0, a.owner
    assert not may_pair(a, b)
    b.owner, b.low_y, b.high_y = 1, 5.0, 6.0
    assert not may_pair(a, b)


@pytest.mark.parametrize("count", [1, 4, 5, 16, 17, 70, 300])
def test_the_walk_visits_every_group_that_a_box_overlaps_and_nodes_hold_their_leaves(
    count: int, rng
) -> None:
    leaves = random_leaves(rng, count)
    order = np.argsort(leaves["x"])  # so that nodes hold neighbours, and a walk leaves some out
    leaves = leaves[order]
    nodes = np.zeros(tree.node_count(count), dtype(BOUNDS))
    starts = np.zeros(LEVELS, np.int64)
    interpreted(tree.build_nodes)(records(leaves), count, records(nodes), starts)
    for level in range(1, LEVELS):
        width = -(-count // 4**level)
        for n in range(width):
            held, node = leaves[n * 4**level : (n + 1) * 4**level], nodes[starts[level] + n]
            for axis in "xyz":
                assert node[f"low_{axis}"] == held[f"low_{axis}"].min()
                assert node[f"high_{axis}"] == held[f"high_{axis}"].max()
        if width == 1:
            assert starts[level] + 1 == len(nodes)
            break
    next_group = interpreted(tree.next_group)
    groups = (count + 3) // 4
    for g in range(0, groups, max(1, groups // 12)):
        seen, other = [], g + 1
        while other < groups:
            other = next_group(records(nodes), starts, groups, records(nodes)[g], other)
            if other < groups:
                seen.append(other)
            other += 1
        assert seen == [k for k in range(g + 1, groups) if overlaps(nodes[g], nodes[k])]
    if count == 70:
        pairs = [overlaps(a, b) for a, b in combinations(leaves, 2)]
        assert 0 < sum(pairs) < len(pairs)
