"""Engines that pack contacts by eight have something to share; no others do."""

from __future__ import annotations

from lavendersim.engine.atomics import CAN_WAIT
from lavendersim.engine.solvers.packed.layout import allocate_packed
from lavendersim.engine.solvers.packed.members import packed_of, serve_for
from lavendersim.engine.spec import Spec

PACKS = Spec(effects=("friction", "contact_torque", "rotation"), order="coloured")


def test_packed_contacts_are_found_in_what_a_solver_works_in() -> None:
    packed = allocate_packed(PACKS, 2, 8, eight=True)
    assert packed_of(packed) is (packed if CAN_WAIT else None)
    assert packed_of(()) is None


def test_members_of_no_team_return_at_once() -> None:
    if CAN_WAIT:
        serve_for(PACKS)(allocate_packed(PACKS, 0, 0, eight=True))
