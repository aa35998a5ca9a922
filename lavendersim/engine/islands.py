"""Islands: movable bodies that contacts join, however indirectly, by union-find (Tarjan 1975).

Over the contacts between two movable bodies; `parent` holds a forest, a root is its own parent. The
lesser root always becomes the root of both, so that an island's label is its least body, whatever
the order of the contacts; paths are halved on every walk, so that a walk costs next to nothing.
Immovable bodies join nothing: two stacks on one floor are two islands.
"""

from __future__ import annotations

from typing import Any

from .compile import kernel
from .spec import Spec

# Label of a body that no contact can move.
NO_ISLAND = -1


def make_label_islands(spec: Spec) -> Any:
    """Return `kernel(contacts, count, bodies, parent)`: an island's label for each row of `bodies`.

    parent: (bodies,) int64, overwritten: the least row of the body's island, the body's own row
    where nothing movable touches it, NO_ISLAND for fixed and kinematic bodies and for parts.
    """

    def root_of(parent, i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    root_of = kernel(root_of, spec)

    def label_islands(contacts, count, bodies, parent):
        for i in range(bodies.shape[0]):
            parent[i] = i if bodies[i].inv_m > 0.0 else NO_ISLAND
        for c in range(count):
            contact = contacts[c]
            a, b = parent[contact.a], parent[contact.b]
            if a >= 0 and b >= 0:
                a, b = root_of(parent, a), root_of(parent, b)
                if a < b:
                    parent[b] = a
                else:
                    parent[a] = b
        # A parent is never greater than its child: in ascending order its label is final already.
        for i in range(bodies.shape[0]):
            if parent[i] >= 0:
                parent[i] = parent[parent[i]]

    return kernel(label_islands, spec)
