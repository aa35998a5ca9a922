"""The contacts of each body, as linked lists: rows of one body are found without reading all.

Side 0 of contact c is its body A, side 1 its body B; entry 2 c + side of `following` is the next
entry of the same body, -1 the end.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .compile import kernel
from .spec import Spec


class ContactLists(NamedTuple):
    """One list a body."""

    first: np.ndarray  # (bodies,) int64, the first entry of a body, or -1
    following: np.ndarray  # (2 contacts,) int64


def allocate_contact_lists(bodies: int, contacts: int) -> ContactLists:
    """Return arrays for so many bodies and contacts."""
    return ContactLists(np.zeros(bodies, np.int64), np.zeros(2 * contacts, np.int64))


def make_list_contacts(spec: Spec) -> Any:
    """Return `kernel(contacts, count, lists)` that makes the lists of the first `count` rows."""

    def list_contacts(contacts, count, lists):
        first, following = lists
        for i in range(first.shape[0]):
            first[i] = -1
        for c in range(count):
            a, b = contacts[c].a, contacts[c].b
            following[2 * c], first[a] = first[a], 2 * c
            following[2 * c + 1], first[b] = first[b], 2 * c + 1

    return kernel(list_contacts, spec)
