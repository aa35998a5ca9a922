"""What the line around the physics costs: a table, and a JSON file with every sample.

    python -m tests.benchmarks.line [--repeats 3] [--json FILE] [--check] [--cases NAME...]

chapter    configs/chapter, whole            pyramid  210 boxes, as shipped
drops      a sweep of 1,000 drops of 1 s     pile     1000 spheres, as shipped (4 s)
brief cells  as many of 250 steps, with one measure
ball of N  one ball, long and short: their difference is what a step costs

Every repeat visits all cases and commands in turn, after runs that leave every kernel on disk; the
median counts. One process runs all cells of a case. A ratio is to the physics of the same run. The
log of 5 s of the pile is extrapolated from how it grew in the last quarter of its run.
With --check the exit code is 1 when a number is above its bar.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any

import lavender_cli.main  # noqa: F401  (before numpy: it says how that asks for memory)
from lavendersim.runner.environment import environment

from .folders import new_folder
from .line_bars import compared, ratio
from .line_cases import PILE_DURATION, STEPS, LineCase, cases
from .line_commands import COMMANDS, RUN, Cost, cost
from .line_stages import STAGES, TOTALS, Sample, sample


def case_data(samples: list[Sample], compile_s: float) -> dict[str, Any]:
    """Return what became of a case: medians, ratios to the physics, and all samples [s]."""
    by_stage = {stage: [each.seconds[stage] for each in samples] for stage in (*STAGES, *TOTALS)}
    last = samples[-1]
    return {
        "cells": last.cells,
        "steps": last.steps,
        "log_bytes": last.log_bytes,
        "last_bytes": last.last_bytes if last.last_bytes == last.last_bytes else None,
        "compile_s": compile_s,
        "medians": {stage: median(taken) for stage, taken in by_stage.items()},
        "ratios": {stage: ratio(taken, by_stage["physics"]) for stage, taken in by_stage.items()},
        "samples": by_stage,
    }


def command_data(samples: list[Cost]) -> dict[str, Any]:
    """Return what became of a command [s]."""
    return {
        "median": median(each.wall for each in samples),
        "processor": median(each.processor for each in samples),
        "samples": [each._asdict() for each in samples],
    }


def case_sample(case: LineCase, warm: bool = False) -> Sample:
    """Run a case in a new folder."""
    return sample(case.warm if warm else case.load, new_folder())


def command_sample(command: str, listed: Path) -> Cost:
    """Run a command in a new folder."""
    return cost(command, new_folder(), listed)


def measure(
    timed: list[LineCase], commands: tuple[str, ...], repeats: int
) -> Iterator[dict[str, Any]]:
    """Take every case and every command `repeats` times, interleaved; yields after each round.

    A round takes minutes: what is found so far is kept if the next one is interrupted.
    """
    compiling = {case.name: case_sample(case, warm=True).seconds["kernels"] for case in timed}
    taken: dict[str, list[Sample]] = {case.name: [] for case in timed}
    started: dict[str, list[Cost]] = {command: [] for command in commands}
    with tempfile.TemporaryDirectory() as folder:
        listed = Path(folder)
        if commands:
            cost(RUN, listed, listed)  # runs to be listed
            for command in commands:
                command_sample(command, listed)  # the first warms what the system reads
        for done in range(1, repeats + 1):
            for case in timed:
                taken[case.name].append(case_sample(case))
            for command in commands:
                started[command].append(command_sample(command, listed))
            yield {
                "unit": "s",
                "repeats": done,
                "environment": environment(),
                "cases": {name: case_data(each, compiling[name]) for name, each in taken.items()},
                "commands": {name: command_data(each) for name, each in started.items()},
            }


def stage_lines(name: str, case: dict[str, Any]) -> list[str]:
    """Return a case as lines: its stages in seconds and as ratios to its physics."""
    cell = case["medians"]["wall"] / case["cells"]
    lines = [
        f"{name}: {case['cells']} cells, {case['steps']} steps; {cell * 1e3:.3g} ms a cell; "
        f"log {case['log_bytes'] / 1e6:.4g} MB; kernels compiled or loaded, apart: "
        f"{case['compile_s']:.2f} s"
    ]
    for stage in (*STAGES, *TOTALS):
        every = case["samples"][stage]
        lines.append(
            f"  {stage:12}{case['medians'][stage]:9.3f}{min(every):9.3f}{max(every):9.3f}"
            f"{case['ratios'][stage]:10.3f}"
        )
    return lines


def table(found: dict[str, Any]) -> str:
    """Return everything that was found as text."""
    lines = [f"{'':14}{'median':>9}{'least':>9}{'most':>9}{'/ physics':>10}   s"]
    for name, case in found["cases"].items():
        lines += stage_lines(name, case)
    for command, row in found["commands"].items():
        walls = [each["wall"] for each in row["samples"]]
        lines.append(
            f"{command}: {row['median']:.3f} s ({min(walls):.3f} to {max(walls):.3f}), "
            f"processor {row['processor']:.3f} s"
        )
    machine = found["environment"]
    lines.append(
        f"{machine['date']}, {machine['processor']}, {machine['cores']} cores; "
        f"{found['repeats']} interleaved repeats"
    )
    return "\n".join([*lines, *(str(bar) for bar in compared(found))])


def parsed() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description="What the line around the physics costs.")
    parser.add_argument("--repeats", type=int, default=3, help="interleaved rounds, at least 1")
    parser.add_argument("--cells", type=int, default=1000, help="of the sweeps of drops")
    parser.add_argument("--steps", type=int, default=STEPS, help="of the long ball")
    parser.add_argument("--pile-duration", type=float, default=PILE_DURATION, help="[s]")
    parser.add_argument("--cases", nargs="*", help="only those whose names begin so")
    parser.add_argument("--no-commands", action="store_true", help="start no processes")
    parser.add_argument("--json", type=Path, metavar="FILE", help="for all samples, round by round")
    parser.add_argument("--check", action="store_true", help="exit 1 above a bar")
    return parser.parse_args()


def main() -> int:
    """Read the command line, measure, print, write."""
    arguments = parsed()
    chosen = cases(arguments.cells, arguments.pile_duration, arguments.steps)
    if arguments.cases is not None:
        chosen = [case for case in chosen if case.name.startswith(tuple(arguments.cases))]
    found: dict[str, Any] = {}
    for found in measure(chosen, () if arguments.no_commands else COMMANDS, arguments.repeats):
        if arguments.json:
            arguments.json.write_text(json.dumps(found, indent=1) + "\n")
    print(table(found))
    return 1 if arguments.check and any(bar.missed for bar in compared(found)) else 0


if __name__ == "__main__":
    sys.exit(main())
