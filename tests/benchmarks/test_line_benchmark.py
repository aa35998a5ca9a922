"""The benchmark of the line keeps every sample, holds its bars, and says which are missed."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

from lavender_cli.main import app
from tests.benchmarks import line, line_bars, line_commands, line_stages
from tests.benchmarks.as_process import benchmark
from tests.benchmarks.line_commands import LS, PLAN, PLOT, RUN


def case_of(steps: int, **stages: list[float]) -> dict[str, Any]:
    """Return what a case would have left, of the stages that count; the others take no time."""
    repeats = len(next(iter(stages.values())))
    every = dict.fromkeys((*line_stages.STAGES, *line_stages.TOTALS), [0.0] * repeats)
    samples = [
        line_stages.Sample(
            {
                stage: taken[k]
                for stage, taken in (every | {"physics": [1.0] * repeats} | stages).items()
            },
            cells=10,
            steps=steps,
            log_bytes=3_000_000,
            last_bytes=100_000.0,
        )
        for k in range(repeats)
    ]
    return line.case_data(samples, 0.5)


def test_it_writes_every_sample_of_small_cases(tmp_path: Path) -> None:
    output = tmp_path / "line.json"
    options = ["--cases", "drops", "ball", "--cells", "20", "--steps", "2000", "--repeats", "2"]
    done = benchmark("line", *options, "--no-commands", "--json", str(output))
    assert done.returncode == 0, done.stderr
    found = json.loads(output.read_text())
    assert list(found["cases"]) == ["drops", "ball of 2000 steps", "ball of 1000 steps"]
    drops = found["cases"]["drops"]
    assert (drops["cells"], drops["steps"]) == (20, 20 * 240)
    for name, case in found["cases"].items():
        samples = case["samples"]
        assert name in done.stdout
        assert {len(taken) for taken in samples.values()} == {2}
        # every stage of a run is timed; nothing is drawn here
        for stage in {*line_stages.STAGES, *line_stages.TOTALS} - {"drawing"}:
            assert min(samples[stage]) > 0.0, stage
        assert samples["drawing"] == [0.0, 0.0]
        # stages are parts of the call of `run`: they overlap nowhere, and add up to it
        for k, wall in enumerate(samples["wall"]):
            assert sum(samples[stage][k] for stage in line_stages.WITHIN) == pytest.approx(wall)
    assert "a cell of the sweep of drops" in done.stdout
    assert "a step of one ball" in done.stdout


def test_a_log_is_extrapolated_from_its_last_steps() -> None:
    # 3 MB and another 100 steps of 0.1 MB
    assert line_bars.log_size(case_of(50, wall=[1.0]), 150) == 13.0


def test_ratios_are_medians_of_ratios_of_one_run_each() -> None:
    # The slow second run counts no more than the others: its physics was slow as well.
    case = case_of(10, physics=[1.0, 10.0, 2.0], logging=[2.0, 40.0, 12.0])
    assert case["ratios"]["logging"] == 4.0
    assert case["medians"]["logging"] == 12.0


def test_a_step_of_the_ball_costs_the_difference_of_a_long_and_a_short_run() -> None:
    # 3 ms of each cell are its own; 1 us a step to log, 0.5 us to judge
    long = case_of(101_000, logging=[0.104], judging=[0.0505])
    short = case_of(1_000, logging=[0.004], judging=[0.0005])
    assert line_bars.step_cost(long, short) == pytest.approx(1.5)


def whole(scale: float) -> dict[str, Any]:
    """Return findings that are at `scale` times their bars."""
    seconds = {"logging": [0.3 * scale], "judging": [0.2 * scale]}
    long, short = (
        case_of(steps, logging=[steps * 0.8e-6 * scale], judging=[steps * 0.2e-6 * scale])
        for steps in (101_000, 1_000)
    )
    cases = {
        "drops": case_of(10, wall=[0.03 * scale]),
        "brief cells": case_of(10, wall=[0.01 * scale]),
        "pyramid": case_of(10, **seconds),
        "pile": case_of(1200, **seconds) | {"log_bytes": 200e6 * scale},
        "ball of 101000 steps": long,
        "ball of 1000 steps": short,
    }
    walls = {RUN: 2.0, PLOT: 4.0, PLAN: 0.7, LS: 0.3}
    commands = {
        command: line.command_data([line_commands.Cost(wall * scale, wall)])
        for command, wall in walls.items()
    }
    machine = {"date": "today", "processor": "a processor", "cores": 2}
    return {"cases": cases, "commands": commands, "repeats": 1, "environment": machine}


def test_every_bar_is_held_at_its_number_and_missed_above() -> None:
    names = [bar.what for bar in line_bars.compared(whole(1.0))]
    assert len(names) == len(set(names)) == 10
    assert not any(bar.missed for bar in line_bars.compared(whole(0.99)))
    assert [bar.what for bar in line_bars.compared(whole(1.01)) if bar.missed] == names


def test_what_was_not_measured_has_no_bar_and_no_number_keeps_none() -> None:
    assert line_bars.compared({"cases": {}, "commands": {}}) == []
    assert line_bars.Compared("a ratio", math.nan, 1.0, "").missed


def test_a_missed_bar_says_by_how_much() -> None:
    assert str(line_bars.Compared("a run", 3.25, 2.0, "s")).endswith(
        "at most 2 s: missed by 1.25 s"
    )
    assert "missed" not in str(line_bars.Compared("a run", 2.0, 2.0, "s"))


@pytest.mark.parametrize(("scale", "exit_code"), [(0.99, 0), (1.01, 1)])
def test_a_missed_bar_fails_the_check_and_nothing_else(
    scale: float,
    exit_code: int,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(line, "measure", lambda *what: [whole(scale)])
    monkeypatch.setattr("sys.argv", ["line", "--check"])
    assert line.main() == exit_code
    monkeypatch.setattr("sys.argv", ["line"])
    assert line.main() == 0
    assert ("missed by" in capsys.readouterr().out) == bool(exit_code)


@pytest.mark.parametrize("command", line_commands.COMMANDS)
def test_every_command_is_one_that_the_command_line_has(command: str, tmp_path: Path) -> None:
    arguments = line_commands.arguments(command, tmp_path, tmp_path)
    assert command.split()[1] == arguments[0]
    assert ("--plot" in command) == ("--plot" in arguments)
    verb = get_command(app).commands[arguments[0]]  # type: ignore[attr-defined]
    known = {option for parameter in verb.params for option in parameter.opts}
    assert {option for option in arguments if option.startswith("--")} <= known
