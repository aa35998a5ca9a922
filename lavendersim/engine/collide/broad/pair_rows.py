"""Rows of the pair table in ascending order of their key, by two stable counting sorts.

key = i N + j,   i < j rows of the two bodies, N rows in all
"""

from __future__ import annotations

from collections.abc import Sequence

from ...compile import kernel
from ...records import ROPE
from ...spec import Spec
from ...step_terms import step_terms


def make_copy_fields(spec: Spec, names: Sequence[str]):
    """Return `kernel(row, template)` that copies the named fields."""
    if not names:

        def copy_nothing(row, template):
            pass

        return kernel(copy_nothing, spec)
    name = names[0]
    copy_others = make_copy_fields(spec, names[1:])

    def copy_fields(row, template):
        row[name] = template[name]
        copy_others(row, template)

    return kernel(copy_fields, spec)


def make_put_pair(spec: Spec):
    """Return `kernel(bodies, templates, i, j, work, found) -> found`, one more if they may touch.

    A pair beyond the rows there are is counted, not kept.
    """

    def put_pair(bodies, templates, i, j, work, found):
        first, second = min(i, j), max(i, j)
        if templates[bodies[first].material, bodies[second].material].kind < 0:
            return found
        pairs = work.found
        if found < pairs.first.shape[0]:
            pairs.first[found], pairs.second[found] = first, second
        return found + 1

    return kernel(put_pair, spec)


def make_without_joined(spec: Spec):
    """Return `kernel(bodies, pairs, kept, work, found) -> found`: pairs of joined bodies left out.

    The first `kept` rows of pairs are joints and then ropes, those of joints by the bodies of their
    ends; hz of an end is 1 where the two bodies touch each other, too.
    """

    def are_joined(bodies, pairs, kept, a, b):
        low, high = 0, kept
        while low < high:
            middle = (low + high) // 2
            row = pairs[middle]
            first, second = bodies[row.a].owner, bodies[row.b].owner
            if row.kind < ROPE and (first < a or (first == a and second < b)):
                low = middle + 1
            else:
                high = middle
        while low < kept:
            row = pairs[low]
            if row.kind == ROPE or bodies[row.a].owner != a or bodies[row.b].owner != b:
                return False
            if bodies[row.a].hz == 0.0:
                return True
            low += 1
        return False

    are_joined = kernel(are_joined, spec)

    def without_joined(bodies, pairs, kept, work, found):
        listed, left = work.found, 0
        for p in range(found):
            i, j = listed.first[p], listed.second[p]
            one, other = bodies[i].owner, bodies[j].owner
            if not are_joined(bodies, pairs, kept, min(one, other), max(one, other)):
                listed.first[left], listed.second[left] = i, j
                left += 1
        return left

    return kernel(without_joined, spec)


def make_write_rows(spec: Spec, surface: Sequence[str]):
    """Return `kernel(bodies, templates, work, found, pairs, first) -> count`: from the first on.

    surface: fields of the templates. A pair that is found twice has one row.
    Two stable counting sorts, by the second and then by the first body: linear whatever the keys.
    """
    copy_surface, periodic = make_copy_fields(spec, surface), step_terms(spec).periodic

    def sort(by, pairs, target, counts, bodies_count, found):
        # Stable, by a column of bodies.
        for k in range(bodies_count + 1):
            counts[k] = 0
        for p in range(found):
            counts[by[p] + 1] += 1
        for k in range(bodies_count):
            counts[k + 1] += counts[k]
        for p in range(found):
            place = counts[by[p]]
            counts[by[p]] = place + 1
            target.first[place], target.second[place] = pairs.first[p], pairs.second[p]

    sort = kernel(sort, spec)

    def write_rows(bodies, templates, work, found, pairs, first):
        bodies_count, by_second, in_order = bodies.shape[0], work.sorted, work.found
        sort(work.found.second, work.found, by_second, work.counts, bodies_count, found)
        sort(by_second.first, by_second, in_order, work.counts, bodies_count, found)
        made = 0
        for p in range(found):
            i, j = in_order.first[p], in_order.second[p]
            if periodic:  # they may meet as one and the other's image, and the other way round
                if p > 0 and in_order.first[p - 1] == i and in_order.second[p - 1] == j:
                    continue
            template, row = templates[bodies[i].material, bodies[j].material], pairs[first + made]
            row.kind, row.key = template.kind, i * bodies_count + j
            if template.swap == 1:
                row.a, row.b = j, i
            else:
                row.a, row.b = i, j
            copy_surface(row, template)
            made += 1
        return made

    return kernel(write_rows, spec)
