"""Whether a run with several processes is ever slower than with one: pairs of both, in turns.

    python -m tests.benchmarks.line_jobs [--pairs 5] [--jobs 2] [--cases NAME...] [--check]
                                         [--json FILE]

chapter warm   `lavender run configs/chapter --plot`, kernels on disk
chapter cold   the same, from an empty cache each time
drops          1,000 drops of 1 s, the config of `line_cases`
few cells      configs/scenes/drop.yaml, 96 brief ones
one cell       configs/chapter/impact_telemetry.yaml

Every command is a process of its own. Of a pair each comes first in turn, so that what drifts meets
both alike. A ratio is of the two of one pair; their median counts. Where other work has the cores,
two processes gain nothing by them: the load beside each pair says so, and the time of the processor
tells what the second process costs. With --check the exit code is 1 where the median of wall times
is more than ALLOWED above that of one process.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from lavendersim.runner.environment import environment

from .folders import new_folder
from .line_cases import CHAPTER, SCENES, drops
from .line_commands import Cost, cost_of

# Two runs of one command differ by so much on a quiet machine.
ALLOWED = 1.03
DROPS = 1000


class JobsCase(NamedTuple):
    """A run that is made with one process and with several."""

    arguments: Callable[[], Sequence[str]]  # of `lavender run`
    is_cold: bool = False  # each run has an empty cache


def _drops() -> Sequence[str]:
    config = new_folder() / "drops.yaml"
    config.write_text(drops(DROPS))
    return [str(config)]


CASES = {
    "chapter warm": JobsCase(lambda: [str(CHAPTER), "--plot"]),
    "chapter cold": JobsCase(lambda: [str(CHAPTER), "--plot"], is_cold=True),
    "drops": JobsCase(_drops),
    "few cells": JobsCase(lambda: [str(SCENES / "drop.yaml")]),
    "one cell": JobsCase(lambda: [str(CHAPTER / "impact_telemetry.yaml")]),
}


class Pair(NamedTuple):
    """The same run with one process and with several."""

    one: Cost
    several: Cost
    load: float  # runnable processes of the last minute, before the pair


def run(case: JobsCase, arguments: Sequence[str], jobs: int) -> Cost:
    """Run a case once."""
    whole = ["run", *arguments, "--jobs", str(jobs), "--runs", str(new_folder())]
    if not case.is_cold:
        return cost_of(whole, {})
    with tempfile.TemporaryDirectory() as cache:
        return cost_of(whole, {"LAVENDER_CACHE_DIR": cache})


def pairs_of(case: JobsCase, count: int, jobs: int) -> list[Pair]:
    """Run a case in pairs; each kind comes first in turn."""
    arguments = case.arguments()
    if not case.is_cold:
        run(case, arguments, 1)  # leaves its kernels on disk
    pairs = []
    for number in range(count):
        load = os.getloadavg()[0]
        order = (1, jobs) if number % 2 == 0 else (jobs, 1)
        taken = {each: run(case, arguments, each) for each in order}
        pairs.append(Pair(taken[1], taken[jobs], load))
    return pairs


def case_data(pairs: Sequence[Pair]) -> dict[str, Any]:
    """Return what became of a case: medians [s], ratios of several to one, and every pair."""
    found: dict[str, Any] = {}
    for kind in Cost._fields:
        ones = [getattr(pair.one, kind) for pair in pairs]
        severals = [getattr(pair.several, kind) for pair in pairs]
        ratios = [several / one for one, several in zip(ones, severals, strict=True)]
        found[kind] = {"one": median(ones), "several": median(severals), "ratio": median(ratios)}
    found["load"] = median(pair.load for pair in pairs)
    found["pairs"] = [
        {"one": pair.one._asdict(), "several": pair.several._asdict(), "load": pair.load}
        for pair in pairs
    ]
    return found


def slower(found: dict[str, Any]) -> list[str]:
    """Return the cases that several processes made slower."""
    return [name for name, case in found.items() if case["wall"]["ratio"] > ALLOWED]


def table(found: dict[str, Any], jobs: int) -> str:
    """Return the medians as text."""
    lines = [f"{'':14}{'1 job':>10}{f'{jobs} jobs':>10}{'ratio':>8}{'load':>8}   s"]
    for name, case in found.items():
        for kind in Cost._fields:
            row = case[kind]
            lines.append(
                f"{name if kind == 'wall' else '  ' + kind:14}{row['one']:10.2f}"
                f"{row['several']:10.2f}{row['ratio']:8.2f}{case['load']:8.1f}"
            )
    return "\n".join(lines)


def main() -> int:
    """Read the command line, measure, print, write."""
    parser = argparse.ArgumentParser(description="Whether several processes are slower than one.")
    parser.add_argument("--pairs", type=int, default=5, help="of each case, at least 1")
    parser.add_argument("--jobs", type=int, default=2, help="processes beside one, at least 2")
    parser.add_argument("--cases", nargs="*", choices=[*CASES], help="only these")
    parser.add_argument("--json", type=Path, metavar="FILE", help="for every pair, case by case")
    parser.add_argument("--check", action="store_true", help="exit 1 where one is slower")
    arguments = parser.parse_args()
    found: dict[str, Any] = {}
    for name in arguments.cases or CASES:
        found[name] = case_data(pairs_of(CASES[name], arguments.pairs, arguments.jobs))
        if arguments.json:
            whole = {"unit": "s", "jobs": arguments.jobs, "environment": environment()}
            arguments.json.write_text(json.dumps(whole | {"cases": found}, indent=1) + "\n")
    print(table(found, arguments.jobs))
    if late := slower(found):
        print(f"slower with {arguments.jobs} jobs: {', '.join(late)}")
    return 1 if arguments.check and late else 0


if __name__ == "__main__":
    sys.exit(main())
