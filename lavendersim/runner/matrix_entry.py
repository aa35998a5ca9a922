"""One entry of the solver matrix: what became of a case by one solver.

passes         every claim is met, declared failures too: what fails elsewhere is met here
known failure  nothing fails but what the case declares; it is no pass
fails          something else does; the first is named, in the order of the file
beyond bounds  a cell was stopped at the first step that broke a bound of `always`
diverged       a cell ended where its numbers did
refused        the case cannot be put to this solver
died           the run itself broke off, which is a defect of lavender
not judged     the engine reports too little for any claim; of some alone, they stand beside it
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, NamedTuple

from lavendersim.experiment.sweeps.perturbed_starts import spread_of, start_of
from lavendersim.measures import Verdict
from lavendersim.measures.always import PREFIX
from lavendersim.measures.controls import of_completion
from lavendersim.measures.specs.always import BEYOND_BOUNDS

from .step_counts import StepCounts

if TYPE_CHECKING:
    from .experiment_run import Finished

PASSES: Final = "passes"
KNOWN: Final = "known failure"
FAILS: Final = "fails"
BEYOND: Final = "beyond bounds"
DIVERGED: Final = "diverged"
REFUSED: Final = "refused"
DIED: Final = "died"
NOT_JUDGED: Final = "not judged"
Word = Literal[
    "passes",
    "known failure",
    "fails",
    "beyond bounds",
    "diverged",
    "refused",
    "died",
    "not judged",
]
FINE: Final = frozenset({PASSES, KNOWN})


class Entry(NamedTuple):
    """What became of one case by one solver."""

    case: str  # `tall/jenga`
    solver: str
    verdict: Word
    why: str = ""  # one line: what failed, its number against its bound, or how it ended
    detail: str = ""  # the whole message
    margin: float = math.nan  # the least share of a bound that is left over all claims [-]
    number: float = math.nan  # behind the verdict: of the claim that failed, or nearest its bound
    least: float = math.nan  # of that number over perturbed starts; NaN: it started once
    most: float = math.nan
    claim: str = ""  # which, with its bound; "" where no number decided
    cost: float = math.nan  # physics per simulated second, one processor [s/s]
    contacts: float = math.nan  # a step, on average; NaN: not reported, or a matrix of solvers
    iterations: float = math.nan  # a step, likewise
    run: Path | None = None  # its directory
    log: Path | None = None  # of the first cell that failed, or of the first

    @property
    def fine(self) -> bool:
        """Whether nothing failed that the case does not declare."""
        return self.verdict in FINE


def entry_of(case: str, solver: str, finished: Finished) -> Entry:
    """Return the entry of a `Finished` run."""
    failed = [verdict for verdict in finished.raw if verdict.fails]
    declared = _declared(finished)
    undeclared = [one for one in failed if one.node not in declared and not one.follows]
    ended = finished.ended_early
    word: Word = PASSES
    why = detail = ""
    if undeclared:
        word, why, detail = FAILS, _line(undeclared[0]), undeclared[0].message
    if ended:
        stopped = ended[0].status.startswith(BEYOND_BOUNDS)
        word = BEYOND if stopped else DIVERGED
        why = ended[0].status.removeprefix(f"{word}: ")  # the verdict says it already
        why = f"{ended[0].label}: {why}" if ended[0].label else why
        detail = "\n".join(filter(None, (why, detail)))
    elif not undeclared and failed:
        word, why = KNOWN, _line(failed[0])
        detail = "\n".join(verdict.message for verdict in failed)
    elif not ended and not undeclared and any(not verdict.judged for verdict in finished.raw):
        word, why = _of_unjudged(finished.raw)
    shown = {verdict.path for verdict in undeclared or failed} | {str(one.path) for one in ended}
    cells = finished.run.cells
    first = next((cell for cell in cells if str(cell.path) in shown), cells[0])
    known = [one.margin for one in finished.raw if not math.isnan(one.margin)]
    margin = min(known, default=math.nan)
    behind = next(iter(undeclared or failed or _nearest(finished.raw)), None)
    least, most = _spread(finished, behind)
    return Entry(
        case,
        solver,
        word,
        why,
        detail,
        margin,
        number=math.nan if behind is None else behind.measured,
        least=least,
        most=most,
        claim="" if behind is None else _line(behind),
        cost=_cost(finished),
        run=finished.run.path,
        log=first.path,
    )


def _nearest(verdicts: Sequence[Verdict]) -> list[Verdict]:
    """Return the verdict with the least of its bound left; none where no claim has a bound."""
    bounded = [one for one in verdicts if one.judged and not math.isnan(one.margin)]
    return [min(bounded, key=lambda one: one.margin)] if bounded else []


def _spread(finished: Finished, behind: Verdict | None) -> tuple[float, float]:
    """Return the least and the greatest number of a claim over perturbed starts; NaN: one."""
    starts = {str(cell.path): start_of(cell.coordinates) for cell in finished.run.cells}
    shown: dict[int, Verdict] = {}  # by seed, the verdict with the least of its bound left
    for one in finished.raw if behind is not None else ():
        seed = starts.get(one.path)
        same = behind is not None and one.name == behind.name and math.isfinite(one.measured)
        if seed is not None and same and (seed not in shown or one.margin < shown[seed].margin):
            shown[seed] = one
    spread = spread_of({seed: one.measured for seed, one in shown.items()})
    return spread or (math.nan, math.nan)


def _of_unjudged(verdicts: Sequence[Verdict]) -> tuple[Word, str]:
    """Return the word where the engine did not tell enough to judge some claims, none failed."""
    left = [verdict.node for verdict in verdicts if not verdict.judged]
    word: Word = NOT_JUDGED if len(left) == len(verdicts) else PASSES
    return word, f"not judged, the engine does not report it: {', '.join(left)}"


def with_counts(entry: Entry, counts: StepCounts) -> Entry:
    """Return an entry with what its steps had: contacts, iterations."""
    contacts, iterations = (math.nan if one is None else one for one in counts)
    return entry._replace(contacts=contacts, iterations=iterations)


def without_run(case: str, solver: str, word: Word, why: str) -> Entry:
    """Return the entry of a case that left no run."""
    return Entry(case, solver, word, why, why)


def passed(entries: Iterable[Entry], solver: str) -> int:
    """Return how many cases a solver passes; declared failures are none."""
    return sum(one.solver == solver and one.verdict == PASSES for one in entries)


def _declared(finished: Finished) -> set[str]:
    """Return the nodes of the claims that the case says will fail."""
    controls = finished.run.experiment.controls
    named = {text for one in controls for text in (one.fails, f"{PREFIX}{one.fails}")}
    # what a control names in its cells is judged by it alone, and stands in no list of its own
    judged = {verdict.node for verdict in finished.verdicts}
    taken = [verdict for verdict in finished.raw if verdict.node not in judged]
    whole = any(of_completion(one) for one in controls)
    return {verdict.node for verdict in taken if whole or verdict.name in named}


def _line(verdict: Verdict) -> str:
    return f"{verdict.node}: {verdict.measured:.6g}, expected {verdict.expected}"


def _cost(finished: Finished) -> float:
    """Return the physics of all cells over the time they simulated [s/s]."""
    # cells that are the same simulation share one outcome
    spent = {
        cell.path: (outcome.physics_ns / 1e9, float(whole.config.clock.time(outcome.steps)))
        for cell, whole, outcome in zip(
            finished.run.cells, finished.run.experiment.cells(), finished.outcomes, strict=True
        )
    }
    simulated = sum(time for _, time in spent.values())
    return sum(physics for physics, _ in spent.values()) / simulated if simulated else math.nan
