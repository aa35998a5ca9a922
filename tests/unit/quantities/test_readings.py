"""What a measure or a panel that does not say takes of a log: anything."""

from __future__ import annotations

from lavendersim.quantities.readings import CONTACTS, EVERYTHING, POSES, SUMS, Reader


def test_a_kind_that_does_not_say_takes_contacts_and_poses() -> None:
    assert Reader.reads({}) == EVERYTHING == CONTACTS | POSES


def test_a_kind_takes_what_it_says_whatever_is_given() -> None:
    class OfSums(Reader):
        READS = SUMS

    assert OfSums.reads({"kind": "sums"}) == frozenset()
