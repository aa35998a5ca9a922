"""Every contact that touches stands once in the list of each of its bodies, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.engine.contact_lists import allocate_contact_lists, make_list_contacts
from lavendersim.engine.spec import Spec

READ = ("pair", "a", "b", "nx", "ny", "nz")
CONTACT = np.dtype([(name, "f8" if name[0] == "n" else "i8") for name in READ] + [("phi", "f8")])
WIDEST = 0.3
BODIES, ROOM = 7, 40


def listed(lists, body: int) -> list[int]:
    """Return the contacts in the list of a body, sorted; a circle is cut where it shows."""
    found, entry = [], int(lists.first[body])
    while entry >= 0 and len(found) <= 2 * ROOM:
        found.append(entry // 2)
        entry = int(lists.following[entry])
    return sorted(found)


@pytest.mark.parametrize("count", [0, 1, ROOM])
def test_lists_have_the_contacts_of_each_body(count: int) -> None:
    rng = np.random.default_rng(3)
    list_contacts = make_list_contacts(Spec())
    lists = allocate_contact_lists(BODIES, ROOM)
    for _ in range(2):  # lists of the step before leave nothing
        contacts = np.recarray(ROOM, CONTACT)
        contacts.a = rng.integers(0, BODIES, ROOM)
        contacts.b = (contacts.a + rng.integers(1, BODIES, ROOM)) % BODIES
        contacts.pair = rng.permutation(ROOM)
        contacts.nx, contacts.ny, contacts.nz = rng.normal(size=(3, ROOM))
        contacts.phi = rng.choice([-0.1, WIDEST, 1.001 * WIDEST, 2.0], ROOM)
        list_contacts(contacts, count, WIDEST, lists)
        near = contacts.phi[:count] <= WIDEST
        for body in range(BODIES):
            own = (contacts.a[:count] == body) | (contacts.b[:count] == body)
            assert listed(lists, body) == np.flatnonzero(own & near).tolist()
        for name in READ:
            copied, own = lists.listed[name][:count], contacts[name][:count]
            np.testing.assert_array_equal(copied[near], own[near])
