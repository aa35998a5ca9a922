"""Counts of a step begin at zero: those that the effects and shapes of an engine have, alone."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.engine.effects import EFFECTS
from lavendersim.engine.records import COUNTERS, dtype
from lavendersim.engine.reset_counts import counts_of, make_reset_counts
from lavendersim.engine.spec import Spec

NAMES = [name for name, _ in COUNTERS if name.endswith("_not_converged")]


def test_every_count_of_a_step_is_somebodys():
    """But that of the step's parts, which `parts` sums up and begins anew."""
    every = {name for effect in EFFECTS for name in effect.counts}
    shapes = {"gjk_not_converged", "epa_not_converged", "ascent_not_converged"}
    assert every | shapes == set(NAMES) - {"part_not_converged"}


@pytest.mark.parametrize("effects", [(), ("spring",), ("spring", "least_norm")])
def test_what_an_engine_has_is_reset_and_nothing_else(effects):
    spec = Spec(effects=tuple(sorted(effects)))
    counters = np.zeros(1, dtype(COUNTERS))
    for name in NAMES:
        counters[name] = 7
    reset = make_reset_counts(spec)
    reset(counters.view(np.recarray)[0])
    own = [f"{effect}_not_converged" for effect in effects]
    assert counts_of(spec) == own
    assert {name for name in NAMES if counters[name][0] == 0} == set(own)
