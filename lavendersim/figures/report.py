"""The report of finished runs as one self-contained HTML page: a row per case, its cells folded."""

from __future__ import annotations

import base64
import math
import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from lavendersim.durable_files import write_whole
from lavendersim.errors import LavenderError
from lavendersim.figures import draw
from lavendersim.figures.html_page import Picture, address, picture, render

NOTHING: Final[Mapping[str, str]] = MappingProxyType({})


def write_report(
    results: Sequence[Any], path: Path, about: Mapping[str, str] = NOTHING
) -> list[str]:
    """Write the page of finished runs (`.run`, `.outcomes`, `.verdicts`, `.good`), whole or not.

    about: when, with which versions, on what and by which command they were made. Returns a
    sentence of each log that is damaged; they stand in the page as well.
    """
    write_whole(path, report(results, path.parent, about))
    return [sentence for result in results for sentence in _damaged(result)]


def report(results: Sequence[Any], folder: Path, about: Mapping[str, str] = NOTHING) -> str:
    """Return the page; links are relative to `folder`."""
    good = sum(result.good for result in results)
    claims = [verdict for result in results for verdict in result.verdicts]
    return render(
        "report.html",
        has_player=True,
        about=about,
        title=f"{good} of {len(results)} cases pass",
        good=good == len(results),
        met=sum(verdict.passed for verdict in claims),
        claims=len(claims),
        cells=sum(len(result.outcomes) for result in results),
        cases=[_case(result, folder) for result in results],
    )


def _case(result: Any, folder: Path) -> dict[str, Any]:
    """Return what the rows of a case hold: its numbers, its cells, its claims and its failures."""
    run, verdicts = result.run, result.verdicts
    shown = _shown(result)
    margin, least_claim = _margin(verdicts)
    ended = [f"{cell.label or 'the cell'}: {cell.status}" for cell in result.ended_early]
    again = [*result.ended_early, *_failed_cells(result)]
    return {
        "name": run.name,
        "reduced": run.experiment.options.reduced,
        "question": run.experiment.config.question,
        "picture": picture(shown, moving=True),
        "shown": shown.label,
        "figures": _figures(run),
        "config": str(run.experiment.path),
        "log": address(shown.path, folder),
        "good": result.good,
        "met": sum(verdict.passed for verdict in verdicts),
        "declared": _declared(run.experiment),
        "margin": margin,
        "least_claim": least_claim,
        "residual": max(outcome.accuracy.worst_residual for outcome in result.outcomes),
        "costs": [_cost(outcome) for outcome in result.outcomes],
        "cells": _cells(result, folder),
        "claims": verdicts,
        "failures": _damaged(result)
        + ended
        + [verdict.message for verdict in verdicts if verdict.fails],
        "replays": list(dict.fromkeys(_replay(cell) for cell in again)),
    }


def _failed_cells(result: Any) -> list[Any]:
    failed = {verdict.path for verdict in result.verdicts if verdict.fails}
    return [cell for cell in result.run.cells if str(cell.path) in failed]


def _replay(cell: Any) -> str:
    """Return the command that shows a cell, whose log lies in `cells/` of its run."""
    run = str(cell.path.parent.parent)
    return shlex.join(["lavender", "replay", run, "--cell", f"{cell.index}"])


def _figures(run: Any) -> list[Picture]:
    """Return the figures that the config asks for, as pictures; none where a log is damaged."""
    if not run.experiment.is_drawn:
        return []
    try:
        drawn = draw(run, run.path / "figures")
    except LavenderError:  # it stands among the failures
        return []
    return [
        Picture(path.stem.replace("_", " "), base64.b64encode(path.read_bytes()).decode())
        for path in drawn
        if path.suffix == ".png"
    ]


def _damaged(result: Any) -> list[str]:
    """Return a sentence of each damaged log: of the one that is read all, of others their ends."""
    found = [_shown(result).damage(), *result.run.cut()]
    return [sentence for sentence in dict.fromkeys(found) if sentence]


def _cells(result: Any, folder: Path) -> list[dict[str, Any]]:
    ended = {cell.index for cell in result.ended_early}
    rows = []
    for cell, outcome in zip(result.run.cells, result.outcomes, strict=True):
        own = [verdict for verdict in result.verdicts if verdict.path == str(cell.path)]
        margin, least_claim = _margin(own)
        rows.append(
            {
                "label": cell.label or "the only cell",
                "good": cell.index not in ended and not any(verdict.fails for verdict in own),
                "margin": margin,
                "least_claim": least_claim,
                "residual": outcome.accuracy.worst_residual,
                "cost": _cost(outcome),
                "log": address(cell.path, folder),
            }
        )
    return rows


def _declared(experiment: Any) -> list[str]:
    """Return the checks that the config declares to fail: known failures and negative controls."""
    return list(dict.fromkeys(control.fails for control in experiment.controls))


def _shown(result: Any) -> Any:
    """Return the cell that stands for the case: the first that failed something, or the first."""
    failed = {cell.index for cell in [*_failed_cells(result), *result.ended_early]}
    return next((cell for cell in result.run.cells if cell.index in failed), result.run.cells[0])


def _margin(verdicts: Sequence[Any]) -> tuple[float, str]:
    """Return the least margin and the claim that has it; of a failure without one, no number."""
    failed = [verdict for verdict in verdicts if verdict.fails]
    known = [one for one in failed or verdicts if not math.isnan(one.margin)]
    if not known:
        return math.nan, failed[0].node if failed else ""
    least = min(known, key=lambda verdict: verdict.margin)
    return least.margin, least.node


def _cost(outcome: Any) -> float:
    """Return the time of a step [us]."""
    return float(outcome.physics_ns / max(outcome.steps, 1) / 1000)
