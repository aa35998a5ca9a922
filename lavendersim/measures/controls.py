"""Negative controls (`fails`): verdicts on claims that must fail, from those on everything else.

A control passes when exactly what it names fails, in each of its cells, and nothing else does
there. What it names is then judged by the control alone and stands in no list of its own: a failure
that is asked for is no failure. A cell that must not complete has nothing else to judge; one that a
check of `always` must end has only the other checks, up to there. What fails only because its cell
did not complete is that one failure, not another.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from lavendersim.measures.always import COMPLETE
from lavendersim.measures.selection import coordinates_text, distinguishing_axes, select
from lavendersim.measures.specs.always import BEYOND_BOUNDS, COMPLETES, DIVERGES, STOPPING
from lavendersim.measures.specs.expectation import ExpectSpec
from lavendersim.measures.verdict import NO_TOLERANCE, Verdict


class ControlTrial(NamedTuple):
    """A control in one cell, or once where what it names is judged across cells."""

    control: ExpectSpec
    node: str
    cells: tuple[Any, ...]


def of_completion(control: ExpectSpec) -> bool:
    """Tell whether the control requires a cell that does not complete."""
    return control.fails in (COMPLETES, DIVERGES)


def meant_to_end_early(controls: Sequence[ExpectSpec], cells: Sequence[Any]) -> frozenset[int]:
    """Return the indices of the cells that must not complete, or were to break a bound and did."""
    return frozenset(
        cell.index
        for control in controls
        for cell in select(cells, control.at)
        if of_completion(control) or cell.status.startswith(f"{BEYOND_BOUNDS}{control.fails} ")
    )


def uncontrolled(
    claims: Sequence[Any], controls: Sequence[ExpectSpec], cells: Sequence[Any], stops: bool
) -> list[Any]:
    """Return the claims that no control has taken over; stops: a broken bound ends a cell."""
    taken = [(control, _indices(select(cells, control.at))) for control in controls]
    return [
        claim
        for claim in claims
        if not any(_takes(control, indices, claim, stops) for control, indices in taken)
    ]


def _takes(control: ExpectSpec, indices: frozenset[int], claim: Any, stops: bool) -> bool:
    if not claim.cells or not _indices(claim.cells) <= indices:
        return False
    if stops and control.fails in STOPPING and claim.expectation is not None:
        return True  # the bound is to end the cell before there is anything to measure
    return of_completion(control) or bool(claim.name == control.fails)


def trials(
    claims: Sequence[Any], controls: Sequence[ExpectSpec], cells: Sequence[Any]
) -> list[ControlTrial]:
    """Return what is judged of each control; one that selects no cell is one that fails."""
    made: list[ControlTrial] = []
    for control in controls:
        named = [claim for claim in claims if claim.name == control.fails]
        across = any(len(claim.cells) > 1 for claim in named)
        chosen = select(cells, control.at)
        if across or not chosen:
            made.append(ControlTrial(control, control.name, tuple(chosen)))
            continue
        axes = distinguishing_axes(chosen, control.at)
        for cell in chosen:
            shown = [axis for axis in cell.coordinates if axis in axes]
            where = coordinates_text(cell.coordinates, shown)
            node = f"{control.name} at {where}" if where else control.name
            made.append(ControlTrial(control, node, (cell,)))
    return made


def verdict_of(trial: ControlTrial, claims: Sequence[Any], raw: Mapping[str, Verdict]) -> Verdict:
    """Return the verdict on a control in its cells."""
    failed = trial.control.fails or ""
    here = _indices(trial.cells)
    mine = [claim for claim in claims if claim.cells and _indices(claim.cells) <= here]
    named = [raw[claim.node] for claim in mine if claim.name == failed]
    others = [raw[claim.node] for claim in mine if claim.name != failed]
    ended = [cell.status for cell in trial.cells]
    # a cell that a bound stopped is judged as far as it went
    early = [
        status for status in ended if status != COMPLETE and not status.startswith(BEYOND_BOUNDS)
    ]
    also = [verdict.node for verdict in others if verdict.fails and not verdict.follows]
    if of_completion(trial.control):
        bites, shown = bool(ended) and len(early) == len(ended), ended[0] if ended else ""
    else:
        failing = [one for one in named if one.fails and not one.follows]
        bites = bool(named) and not early and len(failing) == len(named)
        shown = named[0].message.replace("\n", "\n    ") if named else ""
    if not trial.cells:
        reason = "the control selects no cell of the sweep"
    elif early and not of_completion(trial.control):
        reason = f"a cell did not complete: {early[0]}"
    elif not bites:
        reason = f"{failed} did not fail"
    else:
        reason = f"it failed, and so did {', '.join(also)}" if also else ""
    passed = bites and not also and bool(trial.cells)
    path = str(trial.cells[0].path) if len(trial.cells) == 1 else ""
    expected = f"{failed} fails, and nothing else"
    lines = [f"{trial.node}: {'passed' if passed else 'FAILED'}", f"  expected   {expected}"]
    lines += [f"  because    {reason}"] if reason else []
    lines += [f"  which is   {shown}"] if shown else []
    lines += [f"  log        {path}"] if path else []
    measured = named[0].measured if named else float("nan")
    if of_completion(trial.control) and trial.cells:
        measured = float(trial.cells[0].trace().step["step"][-1])  # the last there is
        expected += f" (after step {measured:.0f})" if passed else ""
    return Verdict(
        trial.control.name,
        trial.node,
        passed,
        measured,
        expected,
        NO_TOLERANCE,
        "\n".join(lines),
        path,
    )


def _indices(cells: Sequence[Any]) -> frozenset[int]:
    return frozenset(cell.index for cell in cells)
