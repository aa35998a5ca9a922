"""Pair by pair: of what meets, the rows between the two bodies that approach fastest."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from interpreted import interpreted, records
from plain_facts import body_facts, facts, pair_facts

from lavendersim.engine.approach import FAR, MEETS
from lavendersim.engine.effects.pairwise_impacts import EFFECT, make_mark_impact
from lavendersim.engine.record_layout import allocate_bodies, allocate_pairs, contact_dtype
from lavendersim.engine.records import MOTION, SPHERE, dtype
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("compliance", "contact_spring", "impact_order", "pairwise_impacts"))
SLOP = 1e-4
PARAMS = SimpleNamespace(slop=SLOP, timestep=0.01)


def marked(contacts: np.ndarray, compliance=0.0) -> set[int]:
    bodies, pairs = allocate_bodies(SPEC, 8), allocate_pairs(SPEC, 8)
    bodies["inv_m"], bodies["shape"], bodies["bound"] = 1.0, SPHERE, 0.1
    pairs["compliance"] = compliance
    motion = records(np.zeros(8, dtype(MOTION)))
    mark = interpreted(make_mark_impact(SPEC))
    state = SimpleNamespace(
        contacts=records(contacts), pairs=records(pairs), bodies=records(bodies), motion=motion
    )
    rows = mark(state, len(contacts), PARAMS)
    taking = set(np.flatnonzero(contacts["waits"] == 0).tolist())
    assert rows == len(taking)
    return taking


def rows_of(pairs, rates, located=None) -> np.ndarray:
    contacts = np.zeros(len(pairs), contact_dtype(SPEC))
    contacts["a"], contacts["b"] = np.array(pairs).T
    contacts["rate"] = rates
    contacts["located"] = MEETS if located is None else located
    return contacts


def test_the_fastest_pair_collides_alone_and_equally_fast_ones_together(rng) -> None:
    """Against a search by pairs: the least rate of what meets, a share of 1e-9 more included."""
    for _ in range(100):
        pairs = [tuple(sorted(rng.permutation(5)[:2].tolist())) for _ in range(8)]
        rates = rng.choice([-2.0, -2.0 * (1 - 1e-11), -1.9, -0.5, 0.0, 1.0], 8)
        contacts = rows_of(pairs, rates, rng.choice([MEETS, FAR], 8))
        contacts["phi"] = rng.choice([0.0, 0.5 * SLOP, 2.0 * SLOP], 8)
        meeting = contacts["located"] == MEETS
        least = min([*rates[meeting], 0.0])
        fast = {pairs[k] for k in range(8) if meeting[k] and rates[k] < least * (1 - 1e-10)}
        if least == 0.0:
            fast = {pairs[k] for k in range(8) if meeting[k] and rates[k] <= 0.0}
        expected = {
            k for k in range(8)
            if pairs[k] in fast and contacts["phi"][k] <= SLOP and rates[k] <= 0.0
        }  # fmt: skip
        assert marked(contacts) == expected


def test_a_blow_is_handed_to_the_first_ball_of_a_row_alone() -> None:
    """Newton's cradle: what touches without approaching does not meet."""
    assert marked(rows_of([(0, 1), (1, 2), (2, 3)], [-1.0, 0.0, 0.0], [MEETS, FAR, FAR])) == {0}


def test_springs_are_no_impacts_where_steps_resolve_them() -> None:
    """Two balls of 1 kg: dt^2/(m c) = 2 dt^2/c, of 4 at the limit."""
    limit = 0.5 * PARAMS.timestep**2
    for share, taking in ((1.001, {0}), (0.999, {0, 1})):
        contacts = rows_of([(0, 1), (0, 1)], [-1.0, -1.0])
        contacts["pair"] = [0, 1]
        assert marked(contacts, [0.0, share * limit, *[0.0] * 6]) == taking


def test_it_is_on_where_it_is_asked_for_and_two_pairs_may_meet_at_once() -> None:
    bodies = [body_facts(name, "sphere") for name in "abc"]
    pairs = (pair_facts("a", "b"), pair_facts("b", "c"))
    asked = {"simultaneous_impacts": "pairwise", "impacts": "in_order", "pair_count": 2}
    assert EFFECT.decide(facts(*bodies, pairs=pairs, **asked)).on
    for name, other in (("simultaneous_impacts", "together"), ("impacts", "at_surface")):
        assert not EFFECT.decide(facts(*bodies, pairs=pairs, **(asked | {name: other}))).on
    assert not EFFECT.decide(facts(*bodies, pairs=pairs, **(asked | {"pair_count": 1}))).on
