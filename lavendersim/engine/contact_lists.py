"""What each body touches, as linked lists: contacts of one body are found without reading all.

Side 0 of contact c is its body A, side 1 its body B; entry 2 c + side of `following` is the next
entry of the same body, -1 the end.

Lists jump among contacts, whose rows are large: what their readers ask of one is copied.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np

from .compile import kernel
from .records import F8, I8, U8, Field, dtype
from .spec import Spec

LISTED: Final[list[Field]] = [
    ("pair", I8),  # row of the pair table
    ("a", U8),
    ("b", U8),
    ("nx", F8),  # unit normal from A to B
    ("ny", F8),
    ("nz", F8),
]


_LISTED = dtype(LISTED)


class ContactLists(NamedTuple):
    """One list a body."""

    first: np.ndarray  # (bodies,) int64, the first entry of a body, or -1
    following: np.ndarray  # (2 contacts,) int64
    listed: np.ndarray  # (contacts,) LISTED, of contacts that are in lists


def allocate_contact_lists(bodies: int, contacts: int) -> ContactLists:
    """Return arrays for so many bodies and contacts."""
    return ContactLists(
        np.zeros(bodies, np.int64), np.zeros(2 * contacts, np.int64), np.zeros(contacts, _LISTED)
    )


def make_list_contacts(spec: Spec) -> Any:
    """Return `kernel(contacts, count, widest, lists)`: of the first `count` rows.

    widest: gap of what is listed, at most [m].
    """

    def list_contacts(contacts, count, widest, lists):
        first, following, listed = lists
        for i in range(first.shape[0]):
            first[i] = -1
        for c in range(count):
            contact = contacts[c]
            if contact.phi > widest:
                continue
            a, b, row = contact.a, contact.b, listed[c]
            row.pair, row.a, row.b = contact.pair, a, b
            row.nx, row.ny, row.nz = contact.nx, contact.ny, contact.nz
            following[2 * c], first[a] = first[a], 2 * c
            following[2 * c + 1], first[b] = first[b], 2 * c + 1

    return kernel(list_contacts, spec)
