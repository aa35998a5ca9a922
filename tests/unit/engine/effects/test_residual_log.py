"""A sweep has a row where its step is asked for, first and last step included."""

from __future__ import annotations

import numpy as np
from interpreted import interpreted, records
from plain_facts import facts, one_row, pair_facts

from lavendersim.engine.effects.residual_log import EFFECT, make_sweep_row
from lavendersim.engine.record_layout import residual_row_dtype
from lavendersim.engine.spec import Spec

PAIRS = (pair_facts("floor", "box"),)


def test_the_sweeps_of_the_steps_asked_for_have_rows_in_their_order() -> None:
    rows, counters = np.zeros(8, residual_row_dtype()), one_row(step=0, residual_rows=1)
    write = interpreted(make_sweep_row(Spec()))
    for done in range(5):  # the sweeps of step done + 1
        counters.step = done
        for sweep in range(3):
            write(
                one_row(residuals_from=2, residuals_to=3), counters, records(rows), sweep,
                10.0 * done + sweep,
            )  # fmt: skip
    assert counters.residual_rows == 7
    assert rows["step"].tolist() == [0, 2, 2, 2, 3, 3, 3, 0]
    assert rows["sweep"].tolist() == [0, 0, 1, 2, 0, 1, 2, 0]
    assert rows["residual"].tolist() == [0, 10, 11, 12, 20, 21, 22, 0]


def test_it_is_on_where_sweeps_are_asked_for_and_there_are_any() -> None:
    assert EFFECT.decide(facts(pairs=PAIRS, residuals=True)).on
    assert not EFFECT.decide(facts(pairs=PAIRS)).on
    assert not EFFECT.decide(facts(residuals=True)).on
    assert not EFFECT.decide(facts(pairs=PAIRS, residuals=True, record=False)).on
