"""The broad phase is on from one pair above what is looked at one by one."""

from __future__ import annotations

import pytest
from plain_facts import facts

from lavendersim.engine.effects.broad_phase import EFFECT, MOST_PAIRS


@pytest.mark.parametrize(
    ("pairs", "on", "said"),
    [
        (0, False, "no pairs of bodies"),
        (1, False, "only 1 pair of bodies"),
        (MOST_PAIRS, False, f"only {MOST_PAIRS} pairs of bodies"),
        (MOST_PAIRS + 1, True, f"{MOST_PAIRS + 1} pairs of bodies"),
    ],
)
def test_many_pairs_require_it(pairs: int, on: bool, said: str) -> None:
    found = EFFECT.decide(facts(pair_count=pairs))
    assert found.on is on
    assert found.reason.startswith(said)
