"""Broad phase: the pairs of bodies that may touch, by a tree of bounds, listed anew when needed.

    place bounds    where each body may be in the next steps            `fat_bounds`
    sort, build     a bounding volume hierarchy over them               `tree`
    walk            pairs of bounds that overlap; planes and cavities against all
    write           rows of the pair table, ascending in their key      `pair_rows`

The list is valid as long as every body stays in its fat bounds.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...compile import kernel
from ...records import BOWL, DRUM, I8, PLANE, Field, dtype
from ...row_terms import row_terms
from ...spec import Spec
from ...step_terms import step_terms
from ..rope import make_count_connections
from ..shapes import has_cavity
from .fat_bounds import FAT_BOUNDS, make_is_valid, make_place_bounds
from .images import make_sort_images
from .pair_rows import make_put_pair, make_without_joined, make_write_rows
from .tree import (
    BOUNDS,
    DIGITS,
    LEAF,
    LEVELS,
    build_nodes,
    make_complete_leaf,
    make_has_leaf,
    may_pair,
    next_group,
    node_count,
    overlap,
    sort_by_code,
    sort_code,
)

STATE: list[Field] = [
    ("listed", I8),  # 1 while the pairs are those of the fat bounds
    ("count", I8),  # pairs of the list
    ("needed", I8),  # rows required when it was made, more than there were if it failed
    ("rebuilds", I8),
]


class PairColumns(NamedTuple):
    """Bodies of pairs in columns; first < second."""

    first: np.ndarray  # (P,)
    second: np.ndarray  # (P,)


class BroadPhaseWork(NamedTuple):
    """What is kept between steps, and buffers. N bodies, P rows of pairs."""

    state: np.ndarray  # (1,) STATE
    fat_bounds: np.ndarray  # (N,) FAT_BOUNDS
    leaves: np.ndarray  # (M,) LEAF, sorted; M: bodies, and images that they may have
    nodes: np.ndarray  # BOUNDS of the levels above
    starts: np.ndarray  # (LEVELS,)
    codes: np.ndarray  # (M,)
    order: np.ndarray  # (M,) body of each leaf; with images, body times ALL and the image's code
    other_codes: np.ndarray
    other_order: np.ndarray
    counts: np.ndarray  # digits of the sort, or bodies
    found: PairColumns  # the pairs, before and after each sort
    sorted: PairColumns


def allocate_broad_phase(body_count: int, pair_capacity: int, images: int = 1) -> BroadPhaseWork:
    """Return work arrays that hold no list yet; to enlarge them, allocate anew.

    images: of a body, itself included (`most_images`).
    """
    leaves = images * body_count

    def numbers(count: int) -> np.ndarray:
        return np.zeros(count, np.int64)

    def columns() -> PairColumns:
        return PairColumns(first=numbers(pair_capacity), second=numbers(pair_capacity))

    return BroadPhaseWork(
        state=np.zeros(1, dtype(STATE)),
        fat_bounds=np.zeros(body_count, dtype(FAT_BOUNDS)),
        leaves=np.zeros(leaves, dtype(LEAF)),
        nodes=np.zeros(node_count(leaves), dtype(BOUNDS)),
        starts=numbers(LEVELS),
        codes=numbers(leaves),
        order=numbers(leaves),
        other_codes=numbers(leaves),
        other_order=numbers(leaves),
        counts=numbers(max(DIGITS, body_count) + 1),
        found=columns(),
        sorted=columns(),
    )


def make_sort_leaves(spec: Spec):
    """Return `kernel(bodies, work) -> leaves`: bodies with bounds, sorted for the tree."""
    has_leaf, complete_leaf = make_has_leaf(spec), make_complete_leaf(spec)

    def sort_leaves(bodies, work):
        fat_bounds, codes, order, leaves = work.fat_bounds, work.codes, work.order, work.leaves
        low_x, low_y, low_z = np.inf, np.inf, np.inf
        high_x, high_y, high_z = -np.inf, -np.inf, -np.inf
        largest, count = 0.0, 0
        for i in range(bodies.shape[0]):
            if not has_leaf(bodies[i]):
                continue
            r = fat_bounds[i]
            low_x, low_y, low_z = min(low_x, r.x), min(low_y, r.y), min(low_z, r.z)
            high_x, high_y, high_z = max(high_x, r.x), max(high_y, r.y), max(high_z, r.z)
            largest = max(largest, max(r.ex, max(r.ey, r.ez)))
            order[count] = i
            count += 1
        # One scale for all axes: cells are cubes, or a flat scene would be cut into pillars.
        side = 1.0 / max(high_x - low_x, max(high_y - low_y, high_z - low_z))
        for k in range(count):
            r = fat_bounds[order[k]]
            codes[k] = sort_code(r.x - low_x, r.y - low_y, r.z - low_z, side, r, largest)
        sort_by_code(codes, order, work.other_codes, work.other_order, work.counts, count)
        for k in range(count):
            i = order[k]
            r, leaf = fat_bounds[i], leaves[k]
            leaf.x, leaf.y, leaf.z = r.x, r.y, r.z
            complete_leaf(leaf, bodies, i, r)
        return count

    return kernel(sort_leaves, spec)


def make(spec: Spec, surface: list[Field] | tuple[Field, ...] = ()):
    """Return `kernel(bodies, velocities, pairs, templates, params, work) -> count`.

    -1 when there are too few rows; `work.state["needed"]` says how many it takes.
    surface: the fields that templates have beside `kind` and `swap` (`record_layout`). Rows
    of `bodies` need `material`; with the effect `compound`, parts need `owner`, the row of their
    body, and every other row has its own there. Pairs that nothing can push get no row. Rows of
    ropes and joints stay where they are, before all others; bodies that a joint joins are no pair.
    """
    connects, joins, cavities = spec.connects, row_terms(spec).bilateral, has_cavity(spec)
    count_connections: Any = make_count_connections(spec) if connects else None
    without_joined: Any = make_without_joined(spec) if joins else None
    is_valid, place_bounds, sort_leaves = (
        make_is_valid(spec),
        make_place_bounds(spec),
        make_sort_images(spec) if step_terms(spec).periodic else make_sort_leaves(spec),
    )
    put_pair = make_put_pair(spec)
    write_rows = make_write_rows(spec, [name for name, _ in surface])

    def find_pairs(bodies, templates, work):
        leaves, nodes, starts = work.leaves, work.nodes, work.starts
        count, found = sort_leaves(bodies, work), 0
        build_nodes(leaves, count, nodes, starts)
        groups = (count + 3) // 4
        for g in range(groups):
            other = g  # among themselves first
            while other < groups:
                end = min(4 * other + 4, count)
                for i in range(4 * g, min(4 * g + 4, count)):
                    if overlap(leaves[i], nodes[other]):
                        for j in range(max(4 * other, i + 1), end):
                            if may_pair(leaves[i], leaves[j]):
                                a, b = leaves[i].body, leaves[j].body
                                found = put_pair(bodies, templates, a, b, work, found)
                other = next_group(nodes, starts, groups, nodes[g], other + 1)
        for i in range(bodies.shape[0]):
            if cavities:  # all that is in one may touch it
                if bodies[i].shape == BOWL or bodies[i].shape == DRUM:
                    for k in range(count):
                        if leaves[k].still == 0:
                            found = put_pair(bodies, templates, i, leaves[k].body, work, found)
            if bodies[i].shape != PLANE:
                continue
            nx, ny, nz = bodies[i].hx, bodies[i].hy, bodies[i].hz
            for k in range(count):
                leaf = leaves[k]
                height = nx * leaf.x + ny * leaf.y + nz * leaf.z - bodies[i].offset
                r = work.fat_bounds[leaf.body]
                depth = min(leaf.radius, abs(nx) * r.ex + abs(ny) * r.ey + abs(nz) * r.ez)
                if height <= depth and leaf.still == 0:
                    found = put_pair(bodies, templates, i, leaf.body, work, found)
        return found

    find_pairs = kernel(find_pairs, spec)

    def broad_phase(bodies, velocities, pairs, templates, params, work):
        state, kept = work.state[0], 0
        if connects:
            kept = count_connections(pairs)
        if state.listed == 1:
            if is_valid(bodies, velocities, params, work.fat_bounds):
                return kept + state.count
        state.listed = 0
        place_bounds(bodies, velocities, params, work.fat_bounds)
        found = find_pairs(bodies, templates, work)
        if joins:
            if found <= work.found.first.shape[0]:
                found = without_joined(bodies, pairs, kept, work, found)
        state.needed = kept + found
        if found > min(pairs.shape[0] - kept, work.found.first.shape[0]):
            return -1
        count = write_rows(bodies, templates, work, found, pairs, kept)
        state.listed, state.count = 1, count
        state.rebuilds += 1
        return kept + count

    return kernel(broad_phase, spec)
