"""Outcomes of the checks of every step (`always`) over the log of a cell.

A check is broken by the first state whose number is above its bound, or is not a number. What is
reported is that state: step, time, its bodies, and the command that shows it. A cell that broke a
bound was stopped there: it is the last state of its log.
"""

from __future__ import annotations

from functools import lru_cache
from math import isnan
from typing import NamedTuple

import numpy as np

from lavendersim.errors import LavenderError
from lavendersim.measures.interfaces import Cell, Rows, Trace
from lavendersim.measures.not_finite import without_warnings
from lavendersim.measures.sections import sections_of
from lavendersim.measures.specs.always import BEYOND_BOUNDS, Always
from lavendersim.measures.step_checks import CheckedSteps, StepChecks, checks_of
from lavendersim.measures.verdict import NO_TOLERANCE, Outcome, failure, unjudged

COMPLETE = "complete"
PREFIX = "always: "


@without_warnings
def outcomes_of(always: Always, cell: Cell) -> dict[str, Outcome]:
    """Return the outcome of every check of a cell.

    A cell that diverged is judged up to the last state that was whole; what breaks a check there
    follows from how it ended, and says so.
    """
    try:
        trace: Trace = cell.trace()
        ended = trace.status
        worst = WorstStates(always)
        checks = StepChecks(always)
        for section in sections_of(trace, is_whole(ended)):
            for one in checks.over(section):
                worst.take(one, section, 1 if section.before else 0, len(section.step))
        worst.not_reported = checks.not_reported
    except LavenderError as error:  # a log that is damaged
        return {check: failure("a log that can answer", str(error)) for check in checks_of(always)}
    return worst.outcomes(ended, cell)


def is_whole(status: str) -> bool:
    """Whether the last state of a log counts, by how its cell ended."""
    return status == COMPLETE or status.startswith(BEYOND_BOUNDS)


class _Worst(NamedTuple):
    """What became of one check so far."""

    bound: float
    unit: str
    number: float = 0.0  # the largest; NaN where one is none
    first: str = ""  # where and how the first state is that breaks it; nothing where none does
    time: float = 0.0  # [s] of that state


class WorstStates:
    """The worst state by each check, as sections of a log come in."""

    def __init__(self, always: Always) -> None:
        self._always = always
        self._found: dict[str, _Worst] = {}
        self.not_reported: dict[str, str] = {}  # checks that the engine does not report enough for

    def take(
        self,
        one: CheckedSteps,
        section: Trace,
        first: int,
        end: int,
        most: float | None = None,
    ) -> None:
        """Count the states first..end-1 of a section in; most: their largest number, if known."""
        if first >= end:
            return
        numbers = one.numbers[first:end]
        known = self._found.get(one.check) or _Worst(one.bound, one.unit)
        most = float(numbers.max()) if most is None else most
        largest = known.number if known.number >= most or isnan(known.number) else most
        known = _Worst(known.bound, known.unit, largest, known.first, known.time)
        if not known.first and not known.number <= one.bound:
            row = int(np.flatnonzero(~(numbers <= one.bound))[0]) + first
            time = time_of(section.step, row)
            known = known._replace(first=_place(one, section, row, time), time=time)
        self._found[one.check] = known

    def outcomes(self, ended: str, cell: Cell) -> dict[str, Outcome]:
        """Return the outcome of every check; ended: status of the cell."""
        if not self._found:
            missing = failure("a complete run", ended, not is_whole(ended))
            return dict.fromkeys(checks_of(self._always), missing)
        early = "" if is_whole(ended) else ended
        not_reported = {name: unjudged(why) for name, why in self.not_reported.items()}
        judged = {name: _outcome(one, early, cell) for name, one in self._found.items()}
        return judged | not_reported


def time_of(step: Rows, row: int) -> float:
    """Return the time [s] of a state as its log has it, in whole nanoseconds."""
    return float(step["time_ns"][row]) / 1e9


def _place(one: CheckedSteps, section: Trace, row: int, time: float) -> str:
    bodies = one.bodies(row)
    number = f"{float(one.numbers[row]):.6g}{one.unit}"
    step = int(section.step["step"][row])
    return f"first in step {step}, t = {time:.9g} s: {number}{f', {bodies}' if bodies else ''}"


@lru_cache(maxsize=256)  # most cells of a sweep have the same bounds, and keep one text of each
def _expected(bound: float, unit: str) -> str:
    return f"at most {bound:g}{unit} in every step"


def _outcome(one: _Worst, ended: str, cell: Cell) -> Outcome:
    bound, expected = one.bound, _expected(one.bound, one.unit)
    margin = 1.0 - one.number / bound if bound > 0.0 else float("nan")
    if not one.first:
        return Outcome(True, one.number, expected, NO_TOLERANCE, margin=margin)
    reason = (
        f"{one.first}"
        f"\n  cell       {cell.label or 'the only one'}"
        f"\n  replay     {replay_command(cell, one.time)}"
    )
    reason += f"\n  ended      {ended}" if ended else ""
    return Outcome(False, one.number, expected, NO_TOLERANCE, reason, bool(ended), margin)


def replay_command(cell: Cell, time: float) -> str:
    """Return the command that shows a moment; a log lies in `cells/` of its run."""
    run = cell.path.parent.parent
    return f"lavender replay {run} --cell {cell.index} --at {time:.9g}"
