"""Judgements of a measure in one cell: between, at_most, at_least, exactly, equals, row.

A row of numbers is judged number by number. NaN fails every judgement: all comparisons are written
so that only a true `<=` passes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any, Final

import numpy as np

from lavendersim.measures.closed_forms import evaluate_form
from lavendersim.measures.interfaces import Cell, Floats, Value
from lavendersim.measures.specs.expectation import Equals, ExpectSpec
from lavendersim.measures.verdict import NO_TOLERANCE, Outcome, failure
from lavendersim.quantities.formula import FormulaError, read_formula
from lavendersim.quantities.scalars import exact


def judge_cell(expectation: ExpectSpec, value: Value, cell: Cell) -> Outcome:
    """Return the outcome of a per-cell expectation on the measure's value."""
    numbers = np.atleast_1d(np.asarray(value, dtype=float))
    return JUDGES[expectation.judgement](expectation, numbers, cell)


def _worst(
    numbers: Floats, excess: Floats, expected: str, tolerance: str, room: float = 0.0
) -> Outcome:
    """Pass when no excess is above 0; show the number with the largest excess, NaN first.

    room: what the bound leaves at most, of which the margin is a share; 0 where there is no such.
    """
    ranked = np.where(np.isnan(excess), np.inf, excess)
    index = int(np.argmax(ranked))
    passed = bool(np.all(excess <= 0.0))
    where = f"number {index} of the row" if len(numbers) > 1 and not passed else ""
    margin = -float(np.max(excess)) / room if room > 0.0 else float("nan")
    return Outcome(passed, float(numbers[index]), expected, tolerance, where, margin=margin)


def _between(expectation: ExpectSpec, numbers: Floats, cell: Cell) -> Outcome:
    assert expectation.between is not None
    low, high = expectation.between
    excess = np.maximum(low - numbers, numbers - high)
    expected = f"between {low!r} and {high!r}"
    return _worst(numbers, excess, expected, NO_TOLERANCE, 0.5 * (high - low))


def _at_most(expectation: ExpectSpec, numbers: Floats, cell: Cell) -> Outcome:
    assert expectation.at_most is not None
    return _worst(
        numbers,
        numbers - expectation.at_most,
        f"at most {expectation.at_most!r}",
        NO_TOLERANCE,
        abs(expectation.at_most),
    )


def _at_least(expectation: ExpectSpec, numbers: Floats, cell: Cell) -> Outcome:
    assert expectation.at_least is not None
    return _worst(
        numbers,
        expectation.at_least - numbers,
        f"at least {expectation.at_least!r}",
        NO_TOLERANCE,
        abs(expectation.at_least),
    )


def _exactly(expectation: ExpectSpec, numbers: Floats, cell: Cell) -> Outcome:
    assert expectation.exactly is not None
    return _worst(
        numbers,
        np.abs(numbers - expectation.exactly),
        f"exactly {expectation.exactly!r}",
        "0",
    )


def _equals(expectation: ExpectSpec, numbers: Floats, cell: Cell) -> Outcome:
    spec = expectation.agreement
    assert spec is not None
    try:
        target, allowed = _allowed(spec, cell)
    except FormulaError as error:
        return failure(str(spec.value), str(error))
    formula = spec.closed_form.form if spec.closed_form else spec.value
    expected = f"{target!r} ({formula})" if isinstance(formula, str) else repr(target)
    excess = np.abs(numbers - target) - allowed
    return _worst(numbers, excess, expected, _tolerance_text(spec), allowed)


def _allowed(spec: Equals, cell: Cell) -> tuple[float, float]:
    """Return the number that a measure is to equal, and its tolerance."""
    if spec.closed_form is not None:
        target = evaluate_form(spec.closed_form, cell.config)
    else:
        assert spec.value is not None
        target = evaluated(spec.value, cell.coordinates)
    return target, max(spec.absolute, spec.relative * abs(target))


def evaluated(value: float | str, coordinates: Mapping[str, Any]) -> float:
    """Return an expected number; of a formula that with a cell's values of its axes.

    FormulaError where the cell lacks an axis, or the formula has no value.
    """
    if not isinstance(value, str):
        return value
    formula = read_formula(value)
    values: dict[str, Any] = {name: coordinates.get(name) for name in formula.names}
    if missing := sorted(name for name, number in values.items() if not _is_number(number)):
        raise FormulaError(f"the cell has no number for axis ${missing[0]}")
    return float(
        formula.value(
            {
                name: number if isinstance(number, Fraction) else exact(number)
                for name, number in values.items()
            }
        )
    )


def _is_number(value: object) -> bool:
    return isinstance(value, int | float | Fraction) and not isinstance(value, bool)


def _tolerance_text(spec: Equals) -> str:
    parts = []
    if spec.relative:
        parts.append(f"{spec.relative:g} relative")
    if spec.absolute:
        parts.append(f"{spec.absolute:g} absolute")
    return " or ".join(parts)


def _row(expectation: ExpectSpec, numbers: Floats, cell: Cell) -> Outcome:
    direction = expectation.row
    assert direction is not None
    expected = f"a strictly {direction} row"
    if len(numbers) < 2:
        only = float(numbers[0]) if len(numbers) else float("nan")
        return Outcome(False, only, expected, NO_TOLERANCE, "the row has fewer than 2 numbers")
    rises = np.diff(numbers) * (1.0 if direction == "increasing" else -1.0)
    wrong = np.flatnonzero(~(rises > 0.0))
    if len(wrong) == 0:
        return Outcome(True, float(numbers[-1]), expected, NO_TOLERANCE)
    index = int(wrong[0]) + 1
    reason = f"number {index} is {numbers[index]!r} after {numbers[index - 1]!r}"
    return Outcome(False, float(numbers[index]), expected, NO_TOLERANCE, reason)


JUDGES: Final[dict[str, Callable[[ExpectSpec, Floats, Cell], Outcome]]] = {
    "between": _between,
    "at_most": _at_most,
    "at_least": _at_least,
    "exactly": _exactly,
    "equals": _equals,
    "row": _row,
}


def room(expectation: ExpectSpec, value: Value, cell: Cell) -> float | None:
    """Return what a claim on one cell leaves to a measure's value; None where it has no number.

    Of `equals` that is its tolerance, of a bound how far the value is from it: of a row, the least.
    A value that changes by more may change the verdict.
    """
    numbers = np.atleast_1d(np.asarray(value, dtype=float))
    if expectation.agreement is not None:
        try:
            return _allowed(expectation.agreement, cell)[1]
        except FormulaError:
            return None
    if expectation.exactly is not None:
        return 0.0
    bounds = [expectation.at_most, expectation.at_least, *(expectation.between or ())]
    left = [float(np.min(np.abs(numbers - bound))) for bound in bounds if bound is not None]
    return min(left) if left else None
