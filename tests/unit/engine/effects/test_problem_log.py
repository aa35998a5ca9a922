"""What a problem's free velocities are is kept as it was before any contact impulse."""

from __future__ import annotations

import numpy as np
from interpreted import interpreted, records
from plain_facts import facts, pair_facts

from lavendersim.engine.effects.problem_log import EFFECT, make
from lavendersim.engine.record_layout import allocate_velocities
from lavendersim.engine.spec import Spec

PAIRS = (pair_facts("floor", "box"),)


def test_velocities_are_kept_whole_and_apart_from_what_follows(rng) -> None:
    spec = Spec(effects=("friction", "problem_log", "rotation"))
    velocities, free = allocate_velocities(spec, 3), allocate_velocities(spec, 3)
    for name in velocities.dtype.names or ():
        velocities[name] = rng.normal(size=3)
    before = velocities.copy()
    interpreted(make(spec))(records(velocities), records(free))
    velocities["vx"] += 1.0
    np.testing.assert_array_equal(free, before)


def test_it_is_on_where_problems_are_asked_for_and_there_are_any() -> None:
    assert EFFECT.decide(facts(pairs=PAIRS, problems=True)).on
    assert not EFFECT.decide(facts(pairs=PAIRS)).on
    assert not EFFECT.decide(facts(problems=True)).on
    assert not EFFECT.decide(facts(pairs=PAIRS, problems=True, record=False)).on
