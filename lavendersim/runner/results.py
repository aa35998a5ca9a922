"""The measures, verdicts and timings of a run enter; `results.json` and `results.csv` leave."""

from __future__ import annotations

import csv
import json
import math
from typing import Any

from lavendersim.errors import LavenderError
from lavendersim.experiment import Experiment
from lavendersim.measures import Values, applies

from .run_directory import RESULTS, TABLE, Run


def measure_cells(run: Run, experiment: Experiment, values: Values) -> list[dict[str, Any]]:
    """Take every measure of every cell, once; its log is let go before the next is opened.

    Returns per cell: measure -> number, list, or a text saying why there is none.
    """
    table = []
    for cell in run.cells:
        measured: dict[str, Any] = {}
        for name, spec in experiment.measures.items():
            if not applies(spec, cell.coordinates):
                continue
            try:
                row = values.row(name, cell).tolist()
            except LavenderError as error:
                measured[name] = str(error)
                continue
            measured[name] = row[0] if len(row) == 1 else row
        cell.release()
        table.append(measured)
    return table


def _finite(value: Any) -> Any:
    """Return `value` with what JSON has no number for as text."""
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, list):
        return [_finite(item) for item in value]
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    return value


def write_results(finished: Any, measured: list[dict[str, Any]]) -> None:
    """Write the tables of a finished run; numbers keep all their digits."""
    run = finished.run
    rows = []
    for cell, outcome, values in zip(run.cells, finished.outcomes, measured, strict=True):
        steps = max(outcome.steps, 1)
        rows.append(
            {
                "index": cell.index,
                "label": cell.label,
                "status": outcome.status,
                "steps": outcome.steps,
                "measures": values,
                "physics_us_per_step": outcome.physics_ns / steps / 1000,
                "logging_us_per_step": outcome.logging_ns / steps / 1000,
                "compile_s": outcome.compile_ns / 1e9,
            }
        )
    table = {
        "experiment": run.name,
        "cells": rows,
        "checks": [verdict._asdict() for verdict in finished.verdicts],
        "passed": finished.good,
    }
    text = json.dumps(_finite(table), indent=1, allow_nan=False) + "\n"
    (run.path / RESULTS).write_text(text, encoding="utf-8")
    _write_csv(run, rows)


def _write_csv(run: Run, rows: list[dict[str, Any]]) -> None:
    names, axes = list(run.experiment.measures), list(run.experiment.axes)
    costs = ["physics_us_per_step", "logging_us_per_step", "compile_s"]
    with (run.path / TABLE).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["cell", *axes, "status", "steps", *names, *costs])
        for cell, row in zip(run.cells, rows, strict=True):
            coordinates = [str(cell.coordinates.get(axis, "")) for axis in axes]
            values = [row["measures"].get(name, "") for name in names]
            writer.writerow(
                [cell.label, *coordinates, row["status"], row["steps"], *values]
                + [row[cost] for cost in costs]
            )
