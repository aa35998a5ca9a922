"""Verdicts on the claims of an experiment, from the logs of its cells.

A claim is an expectation in one cell or across cells, a check of `always` in one cell, or a
negative control. `judge_nodes` gives the same claims from the config alone, so a test runner can
list them before anything has run. An expectation that selects no cell is one claim that fails.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, Final, NamedTuple, Protocol

from lavendersim.errors import LavenderError, NotReportedError
from lavendersim.measures import controls
from lavendersim.measures.always import COMPLETE, PREFIX
from lavendersim.measures.cell_judgements import judge_cell
from lavendersim.measures.interfaces import Cell
from lavendersim.measures.selection import coordinates_text, distinguishing_axes, select
from lavendersim.measures.specs.always import Always
from lavendersim.measures.specs.catalogue import MeasureSpec
from lavendersim.measures.specs.expectation import ExpectSpec
from lavendersim.measures.step_checks import checks_of
from lavendersim.measures.sweep_judgements import judge_sweep
from lavendersim.measures.values import Values
from lavendersim.measures.verdict import Outcome, Verdict, failure, unjudged

Measures = Mapping[str, MeasureSpec]
TIMES: Final = ("time", "since", "begin", "end", "after")  # [s] that measures are taken at
ROUNDED: Final = 2e-9  # [s] logged times are rounded down to nanoseconds
# By the cell's index: the outcome of each of its checks.
AlwaysOutcomes = Mapping[int, Mapping[str, Outcome]]


class _Planned(Protocol):
    """What `judge_nodes` needs of an experiment."""

    @property
    def measures(self) -> Measures: ...
    @property
    def expectations(self) -> Sequence[ExpectSpec]: ...
    @property
    def controls(self) -> Sequence[ExpectSpec]: ...
    @property
    def always(self) -> Always | None: ...
    def cells(self) -> Sequence[Any]: ...


class Claim(NamedTuple):
    """Something to be judged once."""

    name: str  # of the expectation or the check, as a negative control names it
    node: str  # `rebound at e=0.8`, unique in the experiment
    cells: tuple[Any, ...]
    expectation: ExpectSpec | None = None  # None: a check of `always`


def judge_nodes(experiment: _Planned) -> list[str]:
    """Return the names of all verdicts of an experiment, in the order of `judge`."""
    return [one.node for one in _to_judge(experiment)]


def cells_of_claims(experiment: _Planned) -> dict[str, int]:
    """Return the cell of each claim that is on one cell alone, by its node."""
    judged = _to_judge(experiment)
    return {one.node: one.cells[0].index for one in judged if len(one.cells) == 1}


def _to_judge(experiment: _Planned) -> list[Claim | controls.ControlTrial]:
    """Return what will be judged: claims that no control is on, then the negative controls."""
    cells, always = experiment.cells(), experiment.always
    claims = list(_claims(experiment.measures, experiment.expectations, cells, always))
    stops = always is not None and always.stop
    left = controls.uncontrolled(claims, experiment.controls, cells, stops)
    return [*left, *controls.trials(claims, experiment.controls, cells)]


def judge(
    measures: Measures,
    expectations: Sequence[ExpectSpec],
    cells: Sequence[Cell],
    values: Values | None = None,
    *,
    always: Always | None = None,
    outcomes: AlwaysOutcomes | None = None,
    meant_to_fail: Sequence[ExpectSpec] = (),
) -> list[Verdict]:
    """Return one verdict per claim: expectations, checks of every step, negative controls.

    values: measures of these cells that were taken already; outcomes: of the checks of `always`.
    """
    values = values or Values(measures)
    found = _claims(measures, expectations, cells, always)
    if not meant_to_fail:  # of many cells their claims take more memory than the verdicts
        return [_judged(claim, values, outcomes or {}) for claim in found]
    claims = list(found)
    raw = {claim.node: _judged(claim, values, outcomes or {}) for claim in claims}
    stops = always is not None and always.stop
    left = controls.uncontrolled(claims, meant_to_fail, cells, stops)
    judged = controls.trials(claims, meant_to_fail, cells)
    return [raw[claim.node] for claim in left] + [
        controls.verdict_of(trial, claims, raw) for trial in judged
    ]


def _claims(
    measures: Measures,
    expectations: Sequence[ExpectSpec],
    cells: Sequence[Any],
    always: Always | None,
) -> Iterator[Claim]:
    """Yield the claims of the expectations, in their order and that of the cells.

    Behind them the checks of every step: cell by cell, in the order of CHECKS.
    """
    for expectation in expectations:
        name = expectation.name
        chosen = select(cells, measures[expectation.measure].at, expectation.at)
        if not expectation.per_cell or not chosen:
            yield Claim(name, name, tuple(chosen), expectation)
            continue
        for place, cell in zip(_places_of(chosen, expectation.at), chosen, strict=True):
            yield Claim(name, _node(name, place), (cell,), expectation)
    names = checks_of(always)
    for cell, place in zip(cells, _places_of(cells, {}), strict=True):
        for name in names:
            yield Claim(name, _node(f"{PREFIX}{name}", place), (cell,))


def nodes_of(name: str, cells: Sequence[Any], selection: Mapping[str, Any]) -> list[str]:
    """Return the node of a claim in each of some cells: what tells them apart behind its name."""
    return [_node(name, place) for place in _places_of(cells, selection)]


def _places_of(cells: Sequence[Any], selection: Mapping[str, Any]) -> Iterator[str]:
    """Yield what tells each of some cells from the others; empty where nothing does."""
    axes = distinguishing_axes(cells, selection)
    for cell in cells:
        coordinates = cell.coordinates
        yield coordinates_text(coordinates, [axis for axis in coordinates if axis in axes])


def _node(name: str, place: str) -> str:
    return f"{name} at {place}" if place else name


def _judged(claim: Claim, values: Values, outcomes: AlwaysOutcomes) -> Verdict:
    if claim.expectation is None:
        outcome = outcomes[claim.cells[0].index][claim.name]
        return _verdict(f"{PREFIX}{claim.name}", claim, outcome, "")
    outcome = _outcome(claim.expectation, claim.cells, values)
    return _verdict(claim.name, claim, outcome, claim.expectation.measure)


def _outcome(expectation: ExpectSpec, cells: Sequence[Cell], values: Values) -> Outcome:
    if not cells:
        return failure(expectation.judgement, "the expectation selects no cell of the sweep")
    try:
        for cell in cells:
            if cell.status != COMPLETE:
                ended = f"{cell.label or 'the cell'}: {cell.status}"
                return failure("a complete run", ended, follows=True)
        if expectation.per_cell:
            row = values.row(expectation.measure, cells[0])
            outcome = judge_cell(expectation, row, cells[0])
            if outcome.measured != outcome.measured and not outcome.reason:  # NaN
                spec = values.measures[expectation.measure]
                return outcome._replace(reason=beyond_the_end(spec, cells[0]) or spec.NO_NUMBER)
            return outcome
        return judge_sweep(expectation, cells, values.of(expectation.measure))
    except NotReportedError as error:
        return unjudged(str(error))
    except LavenderError as error:  # a log that is damaged, or has no such topic, fails alone
        return failure("a log that can answer", str(error))


def beyond_the_end(spec: MeasureSpec, cell: Cell) -> str:
    """Return which time of a measure lies behind the run's end; empty where none does."""
    times = {name: getattr(spec, name, None) for name in TIMES}
    given = {name: time for name, time in times.items() if isinstance(time, int | float)}
    end = float(cell.trace().step["time"][-1]) if given else 0.0
    late = [time for time in given.values() if time > end + ROUNDED]
    return f"it is taken at {late[0]:.9g} s, and the run ends at {end:.9g} s" if late else ""


def _path(cells: Sequence[Cell]) -> str:
    if not cells:
        return ""
    return _text(cells[0].path if len(cells) == 1 else cells[0].path.parent)


@lru_cache(maxsize=1)  # the checks of a cell follow each other, and have one text of its log
def _text(path: Path) -> str:
    return str(path)


def _verdict(name: str, claim: Claim, outcome: Outcome, measure: str) -> Verdict:
    return Verdict(
        name=name,
        node=claim.node,
        passed=outcome.passed,
        measured=outcome.measured,
        expected=outcome.expected,
        tolerance=outcome.tolerance,
        own_message="",
        path=_path(claim.cells),
        follows=outcome.follows,
        margin=outcome.margin,
        measure=measure,
        reason=outcome.reason,
        judged=outcome.judged,
    )
