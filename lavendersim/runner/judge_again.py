"""A run measured and judged again from its logs alone; what its tables say counts for nothing."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any, NamedTuple

from lavendersim.measures import Values, Verdict, judge, meant_to_end_early, outcomes_of
from lavendersim.measures.own_file import check_sources
from lavendersim.measures.verdict import Outcome

from .json_table import finite
from .measured import Measured, measure_cell
from .run_directory import Run, RunCell


class JudgedAgain(NamedTuple):
    """What the logs of a run say."""

    cells: list[RunCell]  # with the statuses that their logs have
    measured: list[Measured]  # in the order of the cells
    verdicts: list[Verdict]
    ended_early: list[RunCell]  # that should not have
    damaged: list[str]  # a sentence of each log that is not all that was written

    @property
    def good(self) -> bool:
        """Whether every cell completed that should, and every claim was met."""
        return not self.ended_early and not any(verdict.fails for verdict in self.verdicts)

    def table(self) -> dict[str, Any]:
        """Return it as results are kept: a number that JSON does not have is a text."""
        rows = zip(self.cells, self.measured, strict=True)
        table = {
            "cells": [
                {"label": cell.label, "status": cell.status, "measures": one.values}
                for cell, one in rows
            ],
            "checks": [verdict.row for verdict in self.verdicts],
            "passed": self.good,
        }
        plain: dict[str, Any] = json.loads(json.dumps(finite(table, str)))
        return plain


def judge_again(run: Run) -> JudgedAgain:
    """Return the measures and verdicts of a run, finished or not, from its logs.

    Every byte of them is read. Of a damaged log nothing is measured: its claims fail for that.
    """
    experiment = run.experiment
    check_sources(experiment.measures.values())
    cells: list[RunCell] = []
    measured: list[Measured] = []
    damaged: dict[str, None] = {}
    for cell in run.cells:
        if sentence := cell.damage():
            damaged[sentence] = None
            cells.append(cell)
        else:
            cells.append(replace(cell, status=cell.trace().status))
        always: dict[str, Outcome] = {}
        if experiment.always is not None:
            always = outcomes_of(experiment.always, cells[-1])
        measured.append(measure_cell(cells[-1], experiment.measures, None)._replace(always=always))
        cell.release()
        cells[-1].release()
    taken = {cell.index: one.values for cell, one in zip(cells, measured, strict=True)}
    verdicts = judge(
        experiment.measures,
        experiment.expectations,
        cells,
        Values(experiment.measures, taken),
        always=experiment.always,
        outcomes={cell.index: one.always for cell, one in zip(cells, measured, strict=True)},
        meant_to_fail=experiment.controls,
    )
    expected = meant_to_end_early(experiment.controls, cells)
    ended = [cell for cell in cells if cell.status != "complete" and cell.index not in expected]
    return JudgedAgain(cells, measured, verdicts, ended, [*damaged])
