"""Checks over a log: the first state that breaks a bound is reported, with the way to see it."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lavendersim.errors import TraceError
from lavendersim.measures.always import WorstStates, is_whole, outcomes_of, replay_command
from lavendersim.measures.specs.always import Always
from lavendersim.measures.step_checks import CheckedSteps

NAN = float("nan")
STEPS = np.zeros(6, [("step", "i8"), ("time_ns", "i8")])
STEPS["step"] = np.arange(6)
STEPS["time_ns"] = np.arange(6) * 10_000_000
CELL: Any = SimpleNamespace(index=3, label="e=0.5", path=Path("runs/one/cells/e.mcap"))


def found(numbers: list[float], bound: float = 2.0, ended: str = "complete", cuts=(0, 6)) -> Any:
    """Return the outcome of one check; the log comes in sections."""
    worst = WorstStates(Always())
    for first, end in itertools.pairwise(cuts):
        checked = CheckedSteps("speed", " m/s", bound, np.array(numbers), lambda row: f"body {row}")
        worst.take(checked, SimpleNamespace(step=STEPS), first, end)
    return worst.outcomes(ended, CELL)["speed"]


@pytest.mark.parametrize("cuts", [(0, 6), (0, 3, 6), (0, 1, 2, 3, 4, 5, 6)])
def test_the_first_state_beyond_the_bound_is_named_and_the_worst_counted(cuts: Any) -> None:
    one = found([0.0, 1.0, 2.0, 2.5, 9.0, 3.0], cuts=cuts)
    assert not one.passed
    assert one.measured == 9.0
    assert one.margin == pytest.approx(1.0 - 9.0 / 2.0)
    first, cell, replay = (line.strip() for line in one.reason.split("\n"))
    assert first == "first in step 3, t = 0.03 s: 2.5 m/s, body 3"
    assert cell.split() == ["cell", "e=0.5"]
    assert replay.split(None, 1)[1] == "lavender replay runs/one --cell 3 --at 0.03"


def test_a_bound_that_is_reached_is_kept() -> None:
    one = found([0.0, 2.0, 1.0, 0.0, 0.0, 0.0])
    assert (one.passed, one.measured, one.margin) == (True, 2.0, 0.0)
    assert one.expected == "at most 2 m/s in every step"


def test_no_number_breaks_a_bound_and_stays_the_worst() -> None:
    one = found([0.0, 1.0, NAN, 0.0, 0.0, 5.0], cuts=(0, 4, 6))
    assert not one.passed
    assert math.isnan(one.measured)
    assert one.reason.startswith("first in step 2")


def test_what_breaks_where_a_cell_diverged_follows_from_that() -> None:
    broken = [0.0, 0.0, 0.0, 0.0, 0.0, 9.0]
    assert found(broken, ended="diverged: ball").follows
    assert not found(broken, ended="beyond bounds: speed 9").follows
    assert found(broken, ended="diverged: ball").reason.endswith("diverged: ball")


def test_which_last_states_count() -> None:
    assert is_whole("complete")
    assert is_whole("beyond bounds: speed 3")
    assert not is_whole("diverged: ball")


def test_a_log_without_states_has_no_complete_run() -> None:
    empty = WorstStates(Always()).outcomes("diverged: ball", CELL)
    assert set(empty) == {"finite", "energy", "penetration", "impulses", "momentum", "residual"}
    assert all(not one.passed and one.follows for one in empty.values())


def test_a_damaged_log_fails_every_check_with_its_reason() -> None:
    def damaged() -> Any:
        raise TraceError("cut short")

    cell: Any = SimpleNamespace(trace=damaged)
    outcomes = outcomes_of(Always(), cell)
    assert {one.reason for one in outcomes.values()} == {"cut short"}
    assert "speed" not in outcomes  # none by default


def test_the_command_names_the_run_the_cell_and_the_moment() -> None:
    assert replay_command(CELL, 1 / 3) == "lavender replay runs/one --cell 3 --at 0.333333333"
