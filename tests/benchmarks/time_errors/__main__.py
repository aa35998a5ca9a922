"""Errors of the default numerics in time, scene by scene, at 1/60, 1/240 and 1/1000 s.

    python -m tests.benchmarks.time_errors [--quick] [--only TEXT] [--verbose] [--check]

Truth is closed forms, conservation laws, event-driven twins and ODEs of the rolling constraint
(tests/oracle). Each row has variants: other sizes, angles, speeds, masses, a turned world; what is
printed is the worst. With --check the exit code is 1 where a bar is missed.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import Any

from lavendersim.experiment import load_experiment_text
from lavendersim.scene.plan import plan_of_cell

from . import balls, impacts, meeting, resting, smooth
from .row import FINER, RATES, Error, Found, Row, table
from .scene import scenes_in_turn

ROWS: tuple[Row, ...] = (*smooth.ROWS, *impacts.ROWS, *balls.ROWS, *meeting.ROWS, *resting.ROWS)


def measure(rows: Sequence[Row], rates: Sequence[int], said: bool = False) -> list[Found]:
    """Run all scenes of rows, those of one plan in one engine; said: print each as it is run."""
    rates_of = {
        row.name: (*rates, FINER) if row.smooth and RATES[-1] in rates else rates for row in rows
    }
    found: dict[str, dict[int, dict[str, float]]] = {
        name: {rate: {} for rate in each} for name, each in rates_of.items()
    }
    groups: dict[tuple[Any, ...], dict[str, tuple[Row, int, str, str, Error]]] = {}
    for row in rows:
        for rate in rates_of[row.name]:
            for name, (text, error) in row.scenes(rate).items():
                (cell,) = load_experiment_text(text, f"{name}.yaml").cells()
                group = groups.setdefault((row.plan, plan_of_cell(cell).choices), {})
                group[f"{row.name} {rate} {name}"] = row, rate, name, text, error
    for group in groups.values():
        texts = {key: text for key, (*_, text, _) in group.items()}
        for key, states in scenes_in_turn(texts):
            row, rate, name, _, error = group[key]
            found[row.name][rate][name] = float(error(states))
            if said:
                print(f"{key}: {found[row.name][rate][name]:.3g}", flush=True)
    return [Found(row, found[row.name]) for row in rows]


def main() -> int:
    """Read the command line, run, print."""
    parser = argparse.ArgumentParser(description="Errors in time of the default numerics.")
    parser.add_argument("--quick", action="store_true", help="without 1/1000")
    parser.add_argument("--only", default="", help="rows whose name has this")
    parser.add_argument("--verbose", action="store_true", help="every variant, as it is run")
    parser.add_argument("--check", action="store_true", help="exit 1 where a bar is missed")
    asked = parser.parse_args()
    rows = [row for row in ROWS if asked.only in row.name]
    found = measure(rows, RATES[:2] if asked.quick else RATES, asked.verbose)
    print(table(found))
    missed = [line for one in found for line in one.missed]
    print(*missed, sep="\n")
    return 1 if asked.check and missed else 0


if __name__ == "__main__":
    sys.exit(main())
