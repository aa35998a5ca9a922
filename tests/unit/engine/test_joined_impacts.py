"""Bodies that joints join have their impact when the first of them has, however long the chain."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from interpreted import interpreted

from lavendersim.engine.joined_impacts import make_share_impacts
from lavendersim.engine.spec import Spec

# A floor, a chain of three and one apart; the ball 4 lies on the floor beside them.
TIMES = [0.9, 0.5, 0.8, 0.2, 0.7]


def contact(a: int, b: int, bilateral: int = 1) -> SimpleNamespace:
    inv_m = [0.0, 1.0, 1.0, 1.0, 1.0]
    return SimpleNamespace(a=a, b=b, bilateral=bilateral, inv_m_a=inv_m[a], inv_m_b=inv_m[b])


@pytest.mark.parametrize("turned_round", [False, True])
def test_a_chain_has_the_first_of_its_impacts(turned_round: bool) -> None:
    rows = [contact(1, 2), contact(3, 2), contact(0, 3), contact(0, 4), contact(2, 4, bilateral=0)]
    rows = rows[::-1] if turned_round else rows
    motion = [SimpleNamespace(tau=tau) for tau in TIMES]
    interpreted(make_share_impacts(Spec()))(rows, len(rows), motion)
    # What does not move has no impact to share, and what only touches has its own.
    assert [one.tau for one in motion] == [0.9, 0.2, 0.2, 0.2, 0.7]
