"""The measures, verdicts and timings of a run enter; `results.json` and `results.csv` leave."""

from __future__ import annotations

import csv
import json
import math
from typing import Any

import numpy as np

from lavendersim.errors import LavenderError
from lavendersim.experiment import Experiment
from lavendersim.measures import Verdict, applies, evaluate

from .run_directory import RESULTS, TABLE, Run, RunCell


def measures_of(experiment: Experiment, cell: RunCell) -> dict[str, Any]:
    """Return every measure that applies to a cell: a number, a list, or a text saying why not."""
    values: dict[str, Any] = {}
    for name, spec in experiment.measures.items():
        if not applies(spec, cell.coordinates):
            continue
        try:
            value = np.asarray(evaluate(spec, cell.trace()), dtype=float)
        except LavenderError as error:
            values[name] = str(error)
            continue
        values[name] = value.tolist()
    return values


def _finite(value: Any) -> Any:
    """Return `value` with what JSON has no number for as text."""
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, list):
        return [_finite(item) for item in value]
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    return value


def write_results(
    run: Run, experiment: Experiment, outcomes: list[Any], verdicts: list[Verdict]
) -> None:
    """Write the tables of a run; numbers keep all their digits."""
    rows = []
    for cell, outcome in zip(run.cells, outcomes, strict=True):
        steps = max(outcome.steps, 1)
        rows.append(
            {
                "index": cell.index,
                "label": cell.label,
                "status": outcome.status,
                "steps": outcome.steps,
                "measures": measures_of(experiment, cell),
                "physics_us_per_step": outcome.physics_ns / steps / 1000,
                "logging_us_per_step": outcome.logging_ns / steps / 1000,
                "compile_s": outcome.compile_ns / 1e9,
            }
        )
    table = {
        "experiment": experiment.name,
        "cells": rows,
        "checks": [verdict._asdict() for verdict in verdicts],
        "passed": all(verdict.passed for verdict in verdicts),
    }
    (run.path / RESULTS).write_text(json.dumps(_finite(table), indent=1, allow_nan=False) + "\n")
    names = list(experiment.measures)
    with (run.path / TABLE).open("w", newline="") as file:
        writer = csv.writer(file)
        axes = list(experiment.axes)
        costs = ["physics_us_per_step", "logging_us_per_step", "compile_s"]
        writer.writerow(["cell", *axes, "status", "steps", *names, *costs])
        for cell, row in zip(run.cells, rows, strict=True):
            coordinates = [str(cell.coordinates.get(axis, "")) for axis in axes]
            values = [row["measures"].get(name, "") for name in names]
            writer.writerow(
                [cell.label, *coordinates, row["status"], row["steps"], *values]
                + [row[cost] for cost in costs]
            )
