"""Residuals of the step that ends after a time, in the order of sweeps."""

from __future__ import annotations

import math

import numpy as np
from synthetic import RESIDUAL, trace_of

from lavendersim.measures import evaluate
from lavendersim.measures.specs.convergence import FinalResidual, ResidualBySweep


def log():
    one = trace_of([0.0] * 5)
    one.step["residual"] = [0.0, 0.1, 0.2, 0.3, 0.4]
    rows = [(2, 1, 1e-2), (2, 0, 1e-1), (3, 0, 5.0), (3, 1, 6.0), (2, 2, 1e-3)]
    one.residual = np.array(rows, RESIDUAL)
    return one


def by_sweep(after: float):
    return evaluate(ResidualBySweep(kind="residual_by_sweep", after=after), log())


def test_sweeps_stand_in_order_whatever_that_of_the_log() -> None:
    assert by_sweep(0.015).tolist() == [1e-1, 1e-2, 1e-3]  # 0.02 s is step 2


def test_a_step_that_ends_at_the_time_is_before_it() -> None:
    assert by_sweep(0.02).tolist() == [5.0, 6.0]
    last = FinalResidual(kind="final_residual", after=0.02)
    assert evaluate(last, log()) == 0.3


def test_what_is_not_logged_is_unknown() -> None:
    assert np.isnan(by_sweep(0.0)).all()  # no sweep of step 1 is there
    assert np.isnan(by_sweep(9.0)).all()  # nor a step that late
    assert math.isnan(evaluate(FinalResidual(kind="final_residual", after=0.04), log()))
