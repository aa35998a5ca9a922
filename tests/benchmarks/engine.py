"""What a step of the engine costs: a table and a JSON file with every sample.

    python -m tests.benchmarks.engine [--repeats 9] [--output FILE.json] [--check]

Every repeat visits all cases in turn, so that a slow minute of the machine falls on all of them;
the median over repeats is what counts. Compiling and building are outside of the timed calls.
With --check the exit code is 1 when a median is above its bar.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter_ns
from typing import Any, NamedTuple

import numpy as np

from lavendersim.engine.records import RUNNING, TOUCHING
from lavendersim.engine.step import is_compiled
from lavendersim.runner.cell import CellJob, simulate
from lavendersim.runner.environment import environment

from .minimal_drop import Drop, minimal_drop, start
from .scenes import DROP, REST, STACK, Case, case

MICROSECOND = 1000.0  # [ns]
DROP_BAR, STACK_BAR = 0.2, 15.0  # [us/step], without logging, on two cores
SETTLE = 240  # steps before the stack is timed: it has sunk to where its load holds it


class Timed(NamedTuple):
    """One thing that is timed: `sample` returns the cost of a step [us]."""

    name: str
    sample: Callable[[], float]
    bar: float | None = None  # [us/step]


def engine_step(timed: Case, settle: int, starts: int) -> float:
    """Return the cost of a step [us], mean over `starts` runs of the scene's whole duration."""
    engines = [timed.engine() for _ in range(starts)]
    steps = timed.steps - settle
    spent = 0
    for engine in engines:
        if settle:
            engine.advance(settle)
            engine.take_rows()
        begin = perf_counter_ns()
        while engine.advance(timed.steps - int(engine.counters["step"][0])) != RUNNING:
            engine.take_rows()
        spent += perf_counter_ns() - begin
    return spent / MICROSECOND / (steps * starts)


def coefficients(timed: Case) -> Drop:
    """Return the hand-written kernel's view of the drop."""
    scene = timed.scene()
    p, ball = scene.parameters[0], scene.bodies[1]
    return Drop(
        dt=float(p["dt"]),
        g=-float(p["gz"]),
        mass=1.0 / float(ball["inv_m"]),
        radius=float(ball["hx"]),
        restitution=float(scene.pairs[0]["restitution"]),
        restitution_speed=float(p["restitution_speed"]),
        gain=float(p["stabilisation_gain"]),
        slop=float(p["slop"]),
        projection=float(p["projection"]),
        touching=TOUCHING,
        sweeps=int(p["sweeps"]),
        projection_sweeps=int(p["projection_sweeps"]),
    )


def minimal_step(timed: Case, drop: Drop, starts: int) -> float:
    """Return the cost of a step of the hand-written kernel [us], timed as `engine_step` does."""
    height = float(timed.scene().bodies[1]["z"])
    states = [start(height) for _ in range(starts)]
    spent = 0
    for state in states:
        begin = perf_counter_ns()
        minimal_drop(state, drop, timed.steps)
        spent += perf_counter_ns() - begin
    return spent / MICROSECOND / (timed.steps * starts)


def logging_step(timed: Case) -> float:
    """Return what encoding and writing the log costs a step [us] when the cell is run."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "cell.mcap"
        job = CellJob(0, timed.config, timed.text, log, timed.plan, "none")
        outcome = simulate(job).outcome
    assert outcome.status == "complete", outcome.status
    return outcome.logging_ns / MICROSECOND / outcome.steps


def same_drop(timed: Case, drop: Drop) -> float:
    """Return how far apart the two kernels leave the ball [m]: they must do the same mechanics."""
    engine = timed.engine()
    engine.advance(timed.steps)
    state = start(float(timed.scene().bodies[1]["z"]))
    minimal_drop(state, drop, timed.steps)
    apart = abs(float(engine.bodies[1]["z"]) - float(state[2]))
    assert apart < 1e-9, f"the hand-written kernel leaves the ball {apart} m elsewhere"
    return apart


def position_pass(timed: Case) -> dict[str, Any]:
    """Prove that the position pass works in the steps that are timed, and on how many contacts."""
    engine = timed.engine()
    engine.advance(SETTLE)
    corrected, pushed, contacts = [], [], []
    velocity_sweeps, position_sweeps = [], []
    for _ in range(timed.steps - SETTLE):
        engine.advance(1)
        rows = engine.contacts[: int(engine.counters["contacts"][0])]
        contacts.append(len(rows))
        corrected.append(int(np.count_nonzero(rows["correction"] > 0.0)))
        pushed.append(float(rows["push"].sum()))
        velocity_sweeps.append(int(engine.counters["sweeps"][0]))
        position_sweeps.append(int(engine.counters["projection_sweeps"][0]))
    assert min(corrected) > 0, "in some step no contact asked for a correction"
    assert min(pushed) > 0.0, "in some step no contact was pushed"
    return {
        "steps": len(corrected),
        "contacts": [min(contacts), max(contacts)],
        "corrected_contacts": [min(corrected), max(corrected)],
        "smallest_sum_of_pushes_kg_m": min(pushed),
        "velocity_sweeps": [min(velocity_sweeps), max(velocity_sweeps)],
        "position_sweeps": [min(position_sweeps), max(position_sweeps)],
    }


def prepared(cases: dict[str, Case], drop: Drop) -> dict[str, dict[str, Any]]:
    """Compile or load every kernel once; returns how long each took [s] and where from."""
    found = {}
    for name, timed in cases.items():
        held = is_compiled(timed.plan.spec)
        begin = perf_counter_ns()
        timed.engine()
        seconds = (perf_counter_ns() - begin) / 1e9
        found[name] = {"seconds": seconds, "from": "disk" if held else "source"}
    begin = perf_counter_ns()
    minimal_drop(start(1.0), drop, 0)
    found["minimal"] = {"seconds": (perf_counter_ns() - begin) / 1e9, "from": "source"}
    return found


def measure(repeats: int, starts: int) -> dict[str, Any]:
    """Time every case `repeats` times, interleaved."""
    drop, rest, stack = (case(text, record=False) for text in (DROP, REST, STACK))
    drop_logged, stack_logged = case(DROP, record=True), case(STACK, record=True)
    falling, resting = coefficients(drop), coefficients(rest)
    cases = {
        "drop": drop,
        "rest": rest,
        "stack": stack,
        "drop, recorded": drop_logged,
        "stack, recorded": stack_logged,
    }
    compiling = prepared(cases, falling)
    timed = [
        Timed("sphere drop, hand-written", lambda: minimal_step(drop, falling, starts)),
        Timed("sphere drop", lambda: engine_step(drop, 0, starts), DROP_BAR),
        Timed("sphere at rest, hand-written", lambda: minimal_step(rest, resting, starts)),
        Timed("sphere at rest", lambda: engine_step(rest, 0, starts)),
        Timed("sphere drop, recorded", lambda: engine_step(drop_logged, 0, starts)),
        Timed("sphere drop, logging", lambda: logging_step(drop_logged)),
        Timed("six-block stack", lambda: engine_step(stack, SETTLE, 1), STACK_BAR),
        Timed("six-block stack, recorded", lambda: engine_step(stack_logged, SETTLE, 1)),
        Timed("six-block stack, logging", lambda: logging_step(stack_logged)),
    ]
    samples: dict[str, list[float]] = {each.name: [] for each in timed}
    for repeat in range(repeats + 1):
        for each in timed:
            cost = each.sample()
            if repeat:  # the first round warms caches and clocks
                samples[each.name].append(cost)
    return {
        "unit": "us/step",
        "repeats": repeats,
        "compile": compiling,
        "drop_difference_m": max(same_drop(drop, falling), same_drop(rest, resting)),
        "position_pass": position_pass(stack),
        "environment": environment(stack.plan.spec),
        "cases": [
            {
                "name": each.name,
                "median": median(samples[each.name]),
                "bar": each.bar,
                "samples": samples[each.name],
            }
            for each in timed
        ],
    }


def table(found: dict[str, Any]) -> str:
    """Return the medians as a small table."""
    lines = [f"{'':30} {'median':>9} {'least':>9} {'most':>9} {'bar':>6}   us/step"]
    for row in found["cases"]:
        bar = "" if row["bar"] is None else f"{row['bar']:g}"
        low, high = min(row["samples"]), max(row["samples"])
        lines.append(f"{row['name']:30} {row['median']:9.3f} {low:9.3f} {high:9.3f} {bar:>6}")
    position = found["position_pass"]
    lines.append(
        f"position pass: every one of {position['steps']} steps of the stack, "
        f"{position['corrected_contacts'][0]} to {position['corrected_contacts'][1]} contacts "
        f"corrected of {position['contacts'][0]} to {position['contacts'][1]}; "
        f"{position['velocity_sweeps'][0]} to {position['velocity_sweeps'][1]} velocity sweeps, "
        f"{position['position_sweeps'][0]} to {position['position_sweeps'][1]} position sweeps"
    )
    compiled = (f"{name} {each['seconds']:.2f} s" for name, each in found["compile"].items())
    lines.append(f"compiled or loaded, apart: {', '.join(compiled)}")
    return "\n".join(lines)


def main() -> int:
    """Read the command line, measure, print, write."""
    parser = argparse.ArgumentParser(description="What a step of the engine costs.")
    parser.add_argument("--repeats", type=int, default=9, help="interleaved rounds")
    parser.add_argument("--starts", type=int, default=20, help="drops per sample")
    parser.add_argument("--output", type=Path, help="JSON file for medians and all samples")
    parser.add_argument("--check", action="store_true", help="exit 1 above a bar")
    arguments = parser.parse_args()
    found = measure(arguments.repeats, arguments.starts)
    print(table(found))
    if arguments.output:
        arguments.output.write_text(json.dumps(found, indent=1) + "\n")
    over = [row for row in found["cases"] if row["bar"] is not None and row["median"] > row["bar"]]
    return 1 if arguments.check and over else 0


if __name__ == "__main__":
    sys.exit(main())
