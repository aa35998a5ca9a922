"""Claims on made-up measures: a number or a row that a cell is given, and what is judged of it."""

from __future__ import annotations

from typing import Any

import numpy as np
from synthetic import RESIDUAL, SyntheticCell, trace_of

from lavendersim.measures import Verdict, judge
from lavendersim.measures.specs.convergence import FinalResidual, ResidualBySweep
from lavendersim.measures.specs.expectation import ExpectSpec
from lavendersim.measures.specs.impact import ImpactImpulse

NAN = float("nan")
MEASURES = {
    "number": ImpactImpulse(kind="impact_impulse", body="ball"),
    "row": ResidualBySweep(kind="residual_by_sweep", after=0.0),
    "limited": FinalResidual(kind="final_residual", after=0.0, at={"b": "any"}),
}


def cell(number: float | list[float], status: str = "complete", **coordinates: Any) -> Any:
    """A cell whose `number` (an impulse) or `row` (residuals) is what is given."""
    log = trace_of([0.0] * 4, status=status)
    if isinstance(number, list):
        rows = [(1, sweep, value) for sweep, value in enumerate(number)]
        log.residual = np.array(rows, RESIDUAL)
    else:
        log = trace_of([0.0] * 4, [(1, number, 0.0)], status=status)
    return SyntheticCell(coordinates, log)


def expect(measure: str = "number", **judgement: Any) -> ExpectSpec:
    return ExpectSpec.model_validate({"name": "claim", "measure": measure, **judgement})


def verdicts(expectation: ExpectSpec, *cells: Any) -> list[Verdict]:
    return judge(MEASURES, [expectation], cells)


def passed(expectation: ExpectSpec, *cells: Any) -> bool:
    found = verdicts(expectation, *cells)
    assert len(found) == 1
    return found[0].passed
