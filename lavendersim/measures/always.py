"""Outcomes of the checks of every step (`always`) over the log of a cell.

A check is broken by the first state whose number is above its bound, or is not a number. What is
reported is that state: step, time, its bodies, and the command that shows it. A cell that broke a
bound was stopped there: it is the last state of its log.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lavendersim.errors import LavenderError
from lavendersim.measures.interfaces import Cell, Trace
from lavendersim.measures.sections import sections_of
from lavendersim.measures.specs.always import BEYOND_BOUNDS, Always
from lavendersim.measures.step_checks import CheckedSteps, StepChecks, checks_of
from lavendersim.measures.verdict import Outcome, failure

COMPLETE = "complete"
PREFIX = "always: "


def outcomes_of(always: Always, cell: Cell) -> dict[str, Outcome]:
    """Return the outcome of every check of a cell.

    A cell that diverged is judged up to the last state that was whole; what breaks a check there
    follows from how it ended, and says so.
    """
    try:
        trace: Trace = cell.trace()
        ended = trace.status
        whole = ended == COMPLETE or ended.startswith(BEYOND_BOUNDS)
        states = len(trace.step) - (0 if whole else 1)
        if states <= 0:
            return dict.fromkeys(checks_of(always), failure("a complete run", ended, not whole))
        found = _worst(always, trace, states)
    except LavenderError as error:  # a log that is damaged
        return {check: failure("a log that can answer", str(error)) for check in checks_of(always)}
    return {name: _outcome(one, "" if whole else ended, cell) for name, one in found.items()}


class _Worst(NamedTuple):
    """What became of one check over a log."""

    check: CheckedSteps
    number: float  # the largest; NaN where one is none
    first: str = ""  # where and how the first state is that breaks it; nothing where none does
    time: float = 0.0  # [s] of that state


def _worst(always: Always, trace: Trace, states: int) -> dict[str, _Worst]:
    found: dict[str, _Worst] = {}
    checks = StepChecks(always)
    for before, section in sections_of(trace, states):
        for one in checks.over(section):
            numbers = one.numbers[1 if before else 0 :]
            known = found.get(one.check, _Worst(one, 0.0))
            known = known._replace(number=float(np.max(numbers, initial=known.number)))
            broken = np.flatnonzero(~(numbers <= one.bound))
            if len(broken) and not known.first:
                row = int(broken[0]) + (1 if before else 0)
                known = known._replace(
                    first=_place(one, section, row), time=float(section.step["time"][row])
                )
            found[one.check] = known
    return found


def _place(one: CheckedSteps, section: Trace, row: int) -> str:
    bodies = one.bodies(row)
    step, time = int(section.step["step"][row]), float(section.step["time"][row])
    number = f"{float(one.numbers[row]):.6g}{one.unit}"
    return f"first in step {step}, t = {time:.9g} s: {number}{f', {bodies}' if bodies else ''}"


def _outcome(one: _Worst, ended: str, cell: Cell) -> Outcome:
    bound, unit = one.check.bound, one.check.unit
    expected = f"at most {bound:g}{unit} in every step"
    margin = 1.0 - one.number / bound if bound > 0.0 else float("nan")
    if not one.first:
        return Outcome(True, one.number, expected, "none", margin=margin)
    reason = (
        f"{one.first}"
        f"\n  cell       {cell.label or 'the only one'}"
        f"\n  replay     {replay_command(cell, one.time)}"
    )
    reason += f"\n  ended      {ended}" if ended else ""
    return Outcome(False, one.number, expected, "none", reason, bool(ended), margin)


def replay_command(cell: Cell, time: float) -> str:
    """Return the command that shows a moment; a log lies in `cells/` of its run."""
    run = cell.path.parent.parent
    return f"lavender replay {run} --cell {cell.index} --at {time:.9g}"
