"""Slabs of a large scene: contacts are visited slab by slab, by colours within each.

A colour has contacts everywhere. Swept colour by colour, a scene of ten thousand bodies has the
velocities of all of them read a dozen times a sweep, and its records in jumps. A slab is what lies
between two planes across the axis along which the scene is longest; a contact belongs to the lower
of its bodies. Bodies of a slab stay in a near cache while its colours are visited, and no contact
shares a body with slabs far away, so that a later sweep can follow an earlier one while what that
read is still near (`solvers.packed.sweep`).

It is another fixed permutation of the same Gauss-Seidel sweep, by contacts and poses alone.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Any, NamedTuple

import numpy as np

from .compile import kernel
from .spec import Spec

# Contacts from which on a scene has slabs; with fewer its bodies fit into the caches.
FEWEST_CONTACTS = 4096
# Contacts of a slab, at least: of fewer, eight of a colour are rare.
THICK = 1024
# Layers in which bodies are sorted; so many spreads of their positions, beyond which ends lie.
LAYERS = 1024
BEYOND = 2.0


class Slabs(NamedTuple):
    """Where bodies and contacts lie, and what the order by slabs is found with."""

    body_layer: np.ndarray  # (bodies,) int64; LAYERS of what nothing moves
    layer: np.ndarray  # (contacts,) int64 the lower one of a contact's bodies
    slab: np.ndarray  # (LAYERS + 1,) int64 of each layer
    begin: np.ndarray  # (LAYERS + 2,) int64 contacts before each slab, then its end
    sorted: np.ndarray  # (contacts,) uint64


def allocate_slabs(bodies: int, contacts: int) -> Slabs:
    """Return arrays for so many bodies and contacts."""
    return Slabs(
        body_layer=np.zeros(bodies, np.int64),
        layer=np.zeros(contacts, np.int64),
        slab=np.zeros(LAYERS + 1, np.int64),
        begin=np.zeros(LAYERS + 2, np.int64),
        sorted=np.zeros(contacts, np.uint64),
    )


def has_slabs(spec: Spec) -> bool:
    """Whether large scenes of this engine are swept slab by slab."""
    from .solvers.packed.late import packs_late

    return packs_late(spec)


def make_lay_bodies(spec: Spec) -> Any:
    """Return `kernel(bodies, slabs)`: each movable body's layer, along the scene's longest axis."""

    def along(body, axis):
        return body.x if axis == 0 else (body.y if axis == 1 else body.z)

    along = kernel(along, spec)

    def spread_of(bodies, axis):
        # mean and standard deviation [m]
        count, first, total, squares = 0, 0.0, 0.0, 0.0
        for i in range(bodies.shape[0]):
            if bodies[i].inv_m > 0.0:
                x = along(bodies[i], axis)
                if count == 0:
                    first = x
                count += 1
                total += x - first
                squares += (x - first) * (x - first)
        if count == 0:
            return 0.0, 0.0
        mean = total / count
        return first + mean, sqrt(max(squares / count - mean * mean, 0.0))

    spread_of = kernel(spread_of, spec)

    def lay_bodies(bodies, slabs):
        axis, middle, spread = 0, 0.0, 0.0
        for k in range(3):
            mean, wide = spread_of(bodies, k)
            if wide > spread:
                axis, middle, spread = k, mean, wide
        low, per_layer = middle - BEYOND * spread, 0.0
        if 0.0 < spread < inf:
            per_layer = LAYERS / (2.0 * BEYOND * spread)
        for i in range(bodies.shape[0]):
            if bodies[i].inv_m > 0.0:
                layer = (along(bodies[i], axis) - low) * per_layer
                slabs.body_layer[i] = 0
                if layer > 0.0:  # no number lies in the first, too
                    slabs.body_layer[i] = int(min(layer, LAYERS - 1.0))
            else:
                slabs.body_layer[i] = LAYERS

    return kernel(lay_bodies, spec)


def make_sort_by_slabs(spec: Spec) -> Any:
    """Return `kernel(order, count, slabs)`: slab by slab, each in the order that there was.

    slabs.layer: of every contact.
    """

    def sort_by_slabs(order, count, slabs):
        layer, slab, begin = slabs.layer, slabs.slab, slabs.begin
        for k in range(LAYERS + 2):
            begin[k] = 0
        for c in range(count):
            begin[layer[c] + 1] += 1
        # Whole layers, until there are enough contacts.
        own, last = 0, 0
        for k in range(LAYERS + 1):
            slab[k] = own
            last += begin[k + 1]
            begin[k + 1] = 0
            if last >= THICK:
                begin[own + 1] = last
                own, last = own + 1, 0
        begin[own + 1] = last
        for k in range(own + 1):
            begin[k + 1] += begin[k]
        for k in range(count):
            c = order[k]
            place = slab[layer[c]]
            slabs.sorted[begin[place]] = c
            begin[place] += 1
        for k in range(count):
            order[k] = slabs.sorted[k]

    return kernel(sort_by_slabs, spec)
