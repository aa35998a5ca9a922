"""A cell that was run and its experiment's `always` section in; one Outcome per check out.

A check is broken by the first state whose number is above its bound, or is not a number. What is
told is that state: step, time, whose it is, and the command that shows it. A cell that broke a
bound was stopped there: it is the last state of its log.
"""

from __future__ import annotations

import numpy as np

from lavendersim.errors import LavenderError
from lavendersim.experiment.always_specs import BEYOND_BOUNDS, Always
from lavendersim.measures.values import Part
from lavendersim.measures.verdict import Outcome, failure
from lavendersim.measures.views import Cell, Trace
from lavendersim.measures.watch import Watch, Watched, checks_of

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
        judged = trace if whole else Part(trace, len(trace.step) - 1)
        if len(judged.step) == 0:
            return dict.fromkeys(checks_of(always), failure("a complete run", ended, not whole))
        why = "" if whole else ended
        found = {one.check: _outcome(one, judged, why, cell) for one in Watch(always).over(judged)}
    except LavenderError as error:  # a log that is damaged
        return {check: failure("a log that can answer", str(error)) for check in checks_of(always)}
    return found


def _outcome(one: Watched, trace: Trace, ended: str, cell: Cell) -> Outcome:
    expected = f"at most {one.bound:g}{one.unit} in every step"
    broken = np.flatnonzero(~(one.numbers <= one.bound))
    worst = float(np.max(one.numbers)) if len(one.numbers) else 0.0
    margin = 1.0 - worst / one.bound if one.bound > 0.0 else float("nan")
    if len(broken) == 0:
        return Outcome(True, worst, expected, "none", margin=margin)
    row = int(broken[0])
    time = float(trace.step["time"][row])
    whose = one.bodies(row)
    reason = (
        f"first in step {int(trace.step['step'][row])}, t = {time:.9g} s: "
        f"{float(one.numbers[row]):.6g}{one.unit}{f', {whose}' if whose else ''}"
        f"\n  cell       {cell.label or 'the only one'}"
        f"\n  replay     {replay_command(cell, time)}"
    )
    reason += f"\n  ended      {ended}" if ended else ""
    return Outcome(False, worst, expected, "none", reason, bool(ended), margin)


def replay_command(cell: Cell, time: float) -> str:
    """Return the command that shows a moment; a log lies in `cells/` of its run."""
    run = cell.path.parent.parent
    return f"lavender replay {run} --cell {cell.index} --at {time:.9g}"
