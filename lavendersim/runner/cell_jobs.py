"""The cells of an experiment as jobs: each with its plan, and the log that it writes.

A log is named by what it depends on: the cell's config and the engine's source. So cells of several
products that are the same simulation have one log, and whoever runs a cell, names its log the same.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from lavendersim.experiment import Experiment
from lavendersim.experiment.cell import Cell
from lavendersim.scene.plan import Plan

from .cell import CellJob, CellOfLog, plan_in_log
from .checks import check
from .planning import planned
from .plans import distinct
from .seeds import Seeds


class Prepared(NamedTuple):
    """An experiment that can be run: its cells, the plan and the log of each."""

    experiment: Experiment
    cells: tuple[Cell, ...]
    plans: list[Plan]
    logs: list[str]  # name of each cell's log

    def jobs(self, directory: Path) -> list[CellJob]:
        """Return a job for every cell, whose log is written into a directory."""
        experiment, seeds = self.experiment, Seeds(self.experiment)
        logs = directory / "cells"
        in_logs = {plan.choices: plan_in_log(plan) for plan in distinct(self.plans)}
        return [
            CellJob(
                cell.index,
                cell.config,
                experiment.text,
                logs / log,
                plan,
                seeds.of(cell),
                experiment.always,
                experiment.measures,
                (CellOfLog(cell.index, cell.label, cell.coordinates),),
                in_logs[plan.choices],
            )
            for cell, plan, log in zip(self.cells, self.plans, self.logs, strict=True)
        ]


def prepare(experiment: Experiment, workers: int = 1) -> Prepared:
    """Return the cells of an experiment with their plans; an error where one cannot be run.

    workers: processes that many cells are planned in.
    """
    from lavendersim.engine.sources import source_hash

    check(experiment)
    cells = experiment.cells()
    return Prepared(experiment, cells, *planned(cells, source_hash(), workers))


def different(jobs: Iterable[CellJob]) -> dict[Path, CellJob]:
    """Return a job for every log; cells that are the same simulation have one, and run once."""
    found: dict[Path, CellJob] = {}
    for job in jobs:
        same = found.get(job.path)
        found[job.path] = same._replace(cells=same.cells + job.cells) if same else job
    return found
