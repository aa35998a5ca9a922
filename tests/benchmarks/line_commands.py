"""What commands take from their start to their end, each in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

from .line_cases import CHAPTER

RUN, PLOT, PLAN, LS = (
    "lavender run configs/chapter",
    "lavender run configs/chapter --plot",
    "lavender plan configs/chapter/restitution.yaml",
    "lavender ls",
)
COMMANDS = (RUN, PLOT, PLAN, LS)


class Cost(NamedTuple):
    """Of one process [s]."""

    wall: float
    processor: float  # all its threads


def arguments(command: str, runs: Path, listed: Path) -> list[str]:
    """Return the arguments of a command; runs: where it makes runs, listed: those it lists."""
    chapter = str(CHAPTER)
    return {
        RUN: ["run", chapter, "--runs", str(runs)],
        PLOT: ["run", chapter, "--plot", "--runs", str(runs)],
        PLAN: ["plan", str(CHAPTER / "restitution.yaml")],
        LS: ["ls", "--runs", str(listed)],
    }[command]


def cost(command: str, runs: Path, listed: Path) -> Cost:
    """Run a command to its end."""
    return cost_of(arguments(command, runs, listed), {})


def cost_of(verb: Sequence[str], variables: Mapping[str, str]) -> Cost:
    """Run `lavender` to its end, all processes that it starts counted; verb: with its arguments.

    variables: of the environment, besides those of this process.
    """
    # As where lavender is installed: a start reads bytecode from the disk.
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    whole = [sys.executable, "-m", "lavender_cli.main", *verb]
    before, begin = os.times(), perf_counter()
    done = subprocess.run(
        whole, capture_output=True, text=True, check=False, env=kept | dict(variables)
    )
    wall, after = perf_counter() - begin, os.times()
    assert done.returncode == 0, done.stderr
    user = after.children_user - before.children_user
    return Cost(wall, user + after.children_system - before.children_system)
