"""What pruning of effects saves, and what the full engine and a hand-written one cost.

    python -m tests.benchmarks.effects [--repeats 15] [--output FILE.json] [--check]

pruned      the engine that the plan composes for the scene
full        the same with every effect whose law the numerics have, idle
by hand     `minimal_scene`, the drop in one function, on the engine's arrays
registers   `minimal_drop`, one ball that never leaves the registers
The overhead of every single effect is `lavender run configs/effects`; here are the bars. All of a
scene are timed in turn, in alternating order; a ratio is the median of the ratios of one round.
A drop is timed from fresh arrays in one call, as its hand-written kernels are; a stack again and
again from one state, in the processor's own time where the system counts it finely.
With --check the exit code is 1 when a number is above its bar.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter_ns
from typing import Any, NamedTuple

from lavendersim.engine.records import TOUCHING
from lavendersim.runner.environment import environment
from lavendersim.runner.overhead_pairs import ALL, pairs_of
from lavendersim.runner.timed_engine import Timed

from .engine import (
    DROP_BAR,
    MICROSECOND,
    SETTLE,
    STACK_BAR,
    coefficients,
    engine_step,
    minimal_step,
    same_drop,
)
from .minimal_drop import minimal_drop, start
from .minimal_scene import arrays, minimal_scene
from .scenes import DROP, STACK, Case, case

STARTS = 20  # of the drop in a sample
HALF_BAR = 0.5  # pruned by full, of the drop
HAND_BAR = 1.3  # pruned by hand-written, of the drop
# Laws that the chapter's numerics leave out are there as well.
# Twenty seconds of it, or what the call of a kernel costs would drown what its steps cost.
LONG_DROP = DROP.replace("duration: 1.0", "duration: 20.0").replace("0.8", "1.0")
DEFAULT_DROP = DROP.replace("preset: chapter, ", "")


class Ratio(NamedTuple):
    """What is divided by what, and how large it may be."""

    of: str
    to: str
    bar: float | None


BARS = {"drop, full": DROP_BAR, "stack, full": STACK_BAR}  # [us/step]
RATIOS = (
    Ratio("drop, pruned", "drop, full", HALF_BAR),
    Ratio("drop of 20 s, pruned", "drop of 20 s, by hand", HAND_BAR),
    Ratio("drop of 20 s, pruned", "drop of 20 s, registers", None),
    Ratio("drop of the default, pruned", "drop of the default, full", None),
    Ratio("stack, pruned", "stack, full", None),
)


def full(timed: Case) -> Case:
    """Return a case with all effects whose laws its numerics have."""
    (everything,) = (pair for pair in pairs_of(timed.config) if pair.effect == ALL)
    assert everything.on is not None
    return timed._replace(plan=timed.plan._replace(spec=everything.on))


def cases() -> dict[str, Case]:
    """Return what is timed, pruned and full."""
    pruned = {
        "drop": case(DROP, record=False),
        "drop of 20 s": case(LONG_DROP, record=False),
        "drop of the default": case(DEFAULT_DROP, record=False),
        "stack": case(STACK, record=False),
    }
    found = {}
    for name, timed in pruned.items():
        found[f"{name}, pruned"], found[f"{name}, full"] = timed, full(timed)
    return found


def by_hand(timed: Case) -> float:
    """Return the cost of a step of the hand-written kernel [us], timed as `engine_step` does."""
    engines = [timed.engine() for _ in range(STARTS)]
    (compiled,) = minimal_scene.overloads.values()
    advance = compiled.entry_point  # as the engine calls its own: without looking up types
    spent = 0
    for engine in engines:
        begin = perf_counter_ns()
        advance(*arrays(engine), timed.steps, TOUCHING)
        spent += perf_counter_ns() - begin
    return spent / MICROSECOND / (timed.steps * STARTS)


def same_scene(timed: Case) -> float:
    """Return how far apart engine and hand-written kernel leave the ball [m]: one mechanics."""
    engine, other = timed.engine(), timed.engine()
    engine.advance(timed.steps)
    assert minimal_scene(*arrays(other), timed.steps, TOUCHING)
    apart = abs(float(engine.bodies["z"][1]) - float(other.bodies["z"][1]))
    assert apart < 1e-9, f"the hand-written kernel leaves the ball {apart} m elsewhere"
    return apart


def engine_of(timed: Case) -> Timed:
    """Return the engine of a stack that has settled, ready to be sampled."""
    return Timed(timed.config, timed.plan.spec, SETTLE, timed.steps - SETTLE)


def measure(repeats: int) -> dict[str, Any]:
    """Time everything `repeats` times, interleaved."""
    timed = cases()
    drop = timed["drop of 20 s, pruned"]
    coefficient = coefficients(drop)
    minimal_drop(start(1.0), coefficient, 0)  # compiles, as the comparison does
    apart = max(same_drop(drop, coefficient), same_scene(drop))
    sample: dict[str, Callable[[], float]] = {}
    for name, each in timed.items():
        if name.startswith("stack"):
            again = engine_of(each)
            sample[name] = lambda again=again: again.sample() / MICROSECOND  # type: ignore[misc]
        else:
            sample[name] = lambda each=each: engine_step(each, 0, STARTS)  # type: ignore[misc]
    sample["drop of 20 s, by hand"] = lambda: by_hand(drop)
    sample["drop of 20 s, registers"] = lambda: minimal_step(drop, coefficient, STARTS)
    samples: dict[str, list[float]] = {name: [] for name in sample}
    for repeat in range(repeats):
        for name in list(sample)[:: -1 if repeat % 2 else 1]:
            samples[name].append(sample[name]())
    ratios = [
        {**ratio._asdict(), "samples": divided, "median": median(divided)}
        for ratio in RATIOS
        for divided in [[a / b for a, b in zip(samples[ratio.of], samples[ratio.to], strict=True)]]
    ]
    return {
        "unit": "us/step",
        "repeats": repeats,
        "effects": {name: list(each.plan.spec.effects) for name, each in timed.items()},
        "drop_difference_m": apart,
        "environment": environment(*(each.plan.spec for each in timed.values())),
        "cases": [
            {"name": name, "median": median(found), "bar": BARS.get(name), "samples": found}
            for name, found in samples.items()
        ],
        "ratios": ratios,
    }


def table(found: dict[str, Any]) -> str:
    """Return medians and ratios as a small table."""
    lines = [f"{'':58} {'median':>9} {'least':>9} {'most':>9} {'bar':>6}"]
    for row in [*found["cases"], *found["ratios"]]:
        name = f"{row['name']} [us/step]" if "name" in row else f"{row['of']} / {row['to']}"
        bar = "" if row["bar"] is None else f"{row['bar']:g}"
        low, high = min(row["samples"]), max(row["samples"])
        lines.append(f"{name:58} {row['median']:9.3f} {low:9.3f} {high:9.3f} {bar:>6}")
    return "\n".join(lines)


def main() -> int:
    """Read the command line, measure, print, write."""
    parser = argparse.ArgumentParser(description="What pruning saves.")
    parser.add_argument("--repeats", type=int, default=15, help="interleaved rounds")
    parser.add_argument("--output", type=Path, help="JSON file for medians and all samples")
    parser.add_argument("--check", action="store_true", help="exit 1 above a bar")
    arguments = parser.parse_args()
    found = measure(arguments.repeats)
    print(table(found))
    if arguments.output:
        arguments.output.write_text(json.dumps(found, indent=1) + "\n")
    rows = [*found["cases"], *found["ratios"]]
    over = [row for row in rows if row["bar"] is not None and row["median"] > row["bar"]]
    return 1 if arguments.check and over else 0


if __name__ == "__main__":
    sys.exit(main())
