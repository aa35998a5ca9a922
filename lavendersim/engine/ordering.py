"""The order in which sweeps visit contacts: greedy colouring of manifolds, or another.

    coloured    what the processor does best, see below; the default
    forward     as the contacts were found: by bodies, in the order of the file
    backward    the other way round
    symmetric   forward and backward in turn, sweep by sweep (`sweep`)
    random      shuffled anew in every step, by the number of the step alone
A sweep is sequential: a row needs the velocities its predecessor wrote. Rows of one manifold share
both bodies, so visiting them in a run makes the processor wait for each. The coloured order colours
the manifolds greedily, such that no two of one colour share a movable body, and takes one row of
each manifold in turn:

    colour 0: first rows of all its manifolds, then their second rows, ...; colour 1: ...

A large scene that packs its sweeps has this order slab by slab (`slabs`).

It is a fixed permutation of the same Gauss-Seidel sweep; the result depends on nothing but the
contacts. Bodies with 63 manifolds and more share the last colour, which costs only time.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .compile import kernel
from .slabs import FEWEST_CONTACTS, allocate_slabs, has_slabs, make_lay_bodies, make_sort_by_slabs
from .spec import Spec

COLOURS = 64
MANIFOLD_ROWS = 4
# Below this many rows the order costs more than it saves.
FEWEST = 8
BUCKETS = COLOURS * MANIFOLD_ROWS
# Random numbers by Park and Miller 1988, with the multiplier of their 1993 revision: every product
# fits into 63 bits.
MODULUS, MULTIPLIER = 2147483647, 48271


class Ordering(NamedTuple):
    """The order of the sweeps, and what it is found with."""

    order: np.ndarray  # (contacts,) uint64, the row that is visited k-th
    colour_mask: np.ndarray  # (bodies,) int64, bit set of the colours of a body's manifolds
    bucket_ends: np.ndarray  # (BUCKETS + 1,) int64, rows before each bucket, then its end
    bucket_of: np.ndarray  # (contacts,) int64, colour and place in the manifold
    slabs: Any  # of an engine that has them: `Slabs`, or ()


def allocate_ordering(spec: Spec, bodies: int, contacts: int) -> Ordering:
    """Return arrays for so many bodies and contacts."""
    return Ordering(
        order=np.zeros(contacts, np.uint64),
        colour_mask=np.zeros(bodies, np.int64),
        bucket_ends=np.zeros(BUCKETS + 1, np.int64),
        bucket_of=np.zeros(contacts, np.int64),
        slabs=allocate_slabs(bodies, contacts) if has_slabs(spec) else (),
    )


def make(spec: Spec):
    """Return `kernel(bodies, contacts, count, ordering)` that fills `ordering.order`."""
    if spec.order != "coloured":
        return _make_listed(spec)
    in_slabs = has_slabs(spec)
    lay_bodies: Any = make_lay_bodies(spec) if in_slabs else None
    sort_by_slabs: Any = make_sort_by_slabs(spec) if in_slabs else None

    def order_contacts(bodies, contacts, count, ordering):
        order, colour_mask = ordering.order, ordering.colour_mask
        bucket_ends, bucket_of = ordering.bucket_ends, ordering.bucket_of
        if count < FEWEST:
            for c in range(count):
                order[c] = c
            return
        for i in range(bodies.shape[0]):
            colour_mask[i] = 0
        if in_slabs:
            slabs, many = ordering.slabs, count >= FEWEST_CONTACTS
            if many:
                lay_bodies(bodies, slabs)
        colour, row, last = 0, 0, 0
        for c in range(count):
            contact = contacts[c]
            if c == 0 or contact.key != contacts[c - 1].key:
                a, b = contact.a, contact.b
                used = 0
                if bodies[a].inv_m > 0.0:
                    used |= colour_mask[a]
                if bodies[b].inv_m > 0.0:
                    used |= colour_mask[b]
                colour = 0
                while colour < COLOURS - 2 and (used >> colour) & 1:
                    colour += 1
                colour_mask[a] |= 1 << colour
                colour_mask[b] |= 1 << colour
                row = 0
            bucket = colour * MANIFOLD_ROWS + row
            row = min(row + 1, MANIFOLD_ROWS - 1)
            bucket_of[c] = bucket
            last = max(last, bucket)
            if in_slabs:
                if many:
                    a, b = contact.a, contact.b
                    slabs.layer[c] = min(slabs.body_layer[a], slabs.body_layer[b])
        # A stack has two colours: buckets that hold nothing would cost more than its rows.
        for k in range(last + 2):
            bucket_ends[k] = 0
        for c in range(count):
            bucket_ends[bucket_of[c] + 1] += 1
        for k in range(last):
            bucket_ends[k + 1] += bucket_ends[k]
        for c in range(count):
            bucket = bucket_of[c]
            order[bucket_ends[bucket]] = c
            bucket_ends[bucket] += 1
        if in_slabs:
            if many:
                sort_by_slabs(order, count, slabs)

    return kernel(order_contacts, spec)


def _make_listed(spec: Spec):
    backward = spec.order == "backward"

    def list_contacts(bodies, contacts, count, ordering):
        for c in range(count):
            ordering.order[c] = count - 1 - c if backward else c

    return kernel(list_contacts, spec)


def make_shuffle(spec: Spec):
    """Return `kernel(order, count, step)`: by Fisher and Yates, the same for the same step."""

    def shuffle(order, count, step):
        state = (step % MODULUS) * MULTIPLIER % MODULUS + 1
        for _ in range(2):  # or steps that follow each other would begin alike
            state = state * MULTIPLIER % MODULUS
        for c in range(count - 1, 0, -1):
            state = state * MULTIPLIER % MODULUS
            k = state * (c + 1) // MODULUS  # the high bits: 0 to c
            order[c], order[k] = order[k], order[c]

    return kernel(shuffle, spec)


def make_turn_round(spec: Spec):
    """Return `kernel(order, count)`: last first."""

    def turn_round(order, count):
        for c in range(count // 2):
            order[c], order[count - 1 - c] = order[count - 1 - c], order[c]

    return kernel(turn_round, spec)
