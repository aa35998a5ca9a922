"""The bars of the line around the physics, and what a benchmark found against each."""

from __future__ import annotations

from collections.abc import Iterator
from statistics import median
from typing import Any, NamedTuple

from .line_commands import LS, PLAN, PLOT, RUN

COMMAND_BARS = {RUN: 2.0, PLOT: 4.0, PLAN: 0.7, LS: 0.3}  # [s], warm, on two cores
# [ms] a cell, with its log, its measures and what judges it
CELL_BARS = {"drops": ("the sweep of drops", 3.0), "brief cells": ("brief cells", 1.0)}
RATIO_BAR = 0.5  # logging and judging by physics, of the pyramid and of the pile
BALL_BAR = 1.0  # [us/step] logging and judging of one ball, apart from the cell's own cost
PILE_BAR = 200.0  # [MB] log of the pile, of PILE_STEPS
PILE_STEPS = 1200  # 5 s at 240 Hz


class Compared(NamedTuple):
    """A number and the most it may be."""

    what: str
    number: float
    most: float
    unit: str

    @property
    def missed(self) -> bool:
        """Whether the number is above its bar; one that is no number is."""
        return not self.number <= self.most

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        line = f"{self.what}: {self.number:.3g}{unit}, at most {self.most:g}{unit}"
        if not self.missed:
            return line
        return f"{line}: missed by {self.number - self.most:.3g}{unit}"


def logged(samples: dict[str, list[float]]) -> list[float]:
    """Return what logging and judging took in each run [s]."""
    pairs = zip(samples["logging"], samples["judging"], strict=True)
    return [logging + judging for logging, judging in pairs]


def ratio(numbers: list[float], physics: list[float]) -> float:
    """Return the median ratio to the physics of the same run."""
    return median(number / of for number, of in zip(numbers, physics, strict=True))


def step_cost(long: dict[str, Any], short: dict[str, Any]) -> float:
    """Return what logging and judging a step costs [us], without what a cell costs by itself."""
    differences = [
        whole - few
        for whole, few in zip(logged(long["samples"]), logged(short["samples"]), strict=True)
    ]
    return median(differences) * 1e6 / (long["steps"] - short["steps"])


def log_size(case: dict[str, Any], steps: int) -> float:
    """Return the size of a log of so many steps [MB], as it grew in its last steps."""
    size: float = case["log_bytes"] + (steps - case["steps"]) * case["last_bytes"]
    return size / 1e6


def compared(found: dict[str, Any]) -> list[Compared]:
    """Return every bar of what was measured."""
    return [*_of_commands(found["commands"]), *_of_cases(found["cases"])]


def _of_commands(commands: dict[str, Any]) -> Iterator[Compared]:
    for command, bar in COMMAND_BARS.items():
        if command in commands:
            yield Compared(command, commands[command]["median"], bar, "s")


def _of_cases(cases: dict[str, Any]) -> Iterator[Compared]:
    for name, (what, bar) in CELL_BARS.items():
        if name in cases:
            cell = cases[name]["medians"]["wall"] / cases[name]["cells"] * 1e3
            yield Compared(f"a cell of {what}", cell, bar, "ms")
    for name in ("pyramid", "pile"):
        if name in cases:
            samples = cases[name]["samples"]
            share = ratio(logged(samples), samples["physics"])
            yield Compared(f"{name}, logging and judging by physics", share, RATIO_BAR, "")
    balls = sorted((case["steps"], name) for name, case in cases.items() if "ball" in name)
    if len(balls) == 2:
        short, long = (cases[name] for _, name in balls)
        what = "a step of one ball, logging and judging"
        yield Compared(what, step_cost(long, short), BALL_BAR, "us")
    if "pile" in cases:
        size = log_size(cases["pile"], PILE_STEPS)
        yield Compared(f"pile, log of {PILE_STEPS} steps, extrapolated", size, PILE_BAR, "MB")
