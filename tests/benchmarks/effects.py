"""Repeats enter; what pruning saves, and what the full engine and a hand-written one cost, leave.

    python -m tests.benchmarks.effects [--repeats 15] [--output FILE.json] [--check]

pruned      the engine that the plan composes for the scene
full        the same with every effect whose law the numerics have, idle
by hand     `minimal_drop`, the drop in one function
The price of every single effect is `lavender run configs/effects`; here are the bars. All of a
scene are timed in turn, in alternating order; a ratio is the median of the ratios of one round.
Times are the processor's own in this thread, where the system counts it finely.
With --check the exit code is 1 when a number is above its bar.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from lavendersim.runner.environment import environment
from lavendersim.runner.price_pairs import ALL, pairs_of
from lavendersim.runner.price_samples import Timed, clock

from .engine import DROP_BAR, MICROSECOND, SETTLE, STACK_BAR, coefficients, same_drop
from .minimal_drop import Drop, minimal_drop, start
from .scenes import DROP, STACK, Case, case

HALF_BAR = 0.5  # pruned by full, of the drop
HAND_BAR = 1.3  # pruned by hand-written, of the drop
# Laws that the chapter's numerics leave out are there as well.
DEFAULT_DROP = DROP.replace("preset: chapter, ", "")


class Ratio(NamedTuple):
    """What is divided by what, and how large it may be."""

    of: str
    to: str
    bar: float | None


BARS = {"drop, full": DROP_BAR, "stack, full": STACK_BAR}  # [us/step]
RATIOS = (
    Ratio("drop, pruned", "drop, full", HALF_BAR),
    Ratio("drop, pruned", "drop, by hand", HAND_BAR),
    Ratio("drop of the default, pruned", "drop of the default, full", None),
    Ratio("stack, pruned", "stack, full", None),
)


def full(timed: Case) -> Case:
    """Return a case with all effects whose laws its numerics have."""
    (everything,) = (pair for pair in pairs_of(timed.resolved) if pair.effect == ALL)
    assert everything.on is not None
    return timed._replace(plan=timed.plan._replace(spec=everything.on))


def cases() -> dict[str, Case]:
    """Return what is timed, pruned and full."""
    pruned = {
        "drop": case(DROP, record=False),
        "drop of the default": case(DEFAULT_DROP, record=False),
        "stack": case(STACK, record=False),
    }
    found = {}
    for name, timed in pruned.items():
        found[f"{name}, pruned"], found[f"{name}, full"] = timed, full(timed)
    return found


def by_hand(timed: Case, drop: Drop, starts: int) -> float:
    """Return the cost of a step of the hand-written kernel [ns], sampled as `Timed` does."""
    now, height = clock()[1], float(timed.scene().bodies[1]["z"])
    spent = []
    for _ in range(starts):
        state = start(height)
        begin = now()
        minimal_drop(state, drop, timed.steps)
        spent.append(now() - begin)
    return median(spent) / timed.steps


def engine_of(name: str, timed: Case) -> Timed:
    """Return the engine of a case, ready to be sampled."""
    settle = SETTLE if name.startswith("stack") else 0
    return Timed(timed.resolved, timed.plan.spec, settle, timed.steps - settle)


def measure(repeats: int) -> dict[str, Any]:
    """Time everything `repeats` times, interleaved."""
    timed = cases()
    drop = timed["drop, pruned"]
    coefficient = coefficients(drop)
    minimal_drop(start(1.0), coefficient, 0)  # compiles
    engines = {name: engine_of(name, each) for name, each in timed.items()}
    starts = engines["drop, pruned"].starts
    sample: dict[str, Callable[[], float]] = {name: each.sample for name, each in engines.items()}
    sample["drop, by hand"] = lambda: by_hand(drop, coefficient, starts)
    samples: dict[str, list[float]] = {name: [] for name in sample}
    for repeat in range(repeats):
        for name in list(sample)[:: -1 if repeat % 2 else 1]:
            samples[name].append(sample[name]() / MICROSECOND)
    ratios = [
        {**ratio._asdict(), "samples": divided, "median": median(divided)}
        for ratio in RATIOS
        for divided in [[a / b for a, b in zip(samples[ratio.of], samples[ratio.to], strict=True)]]
    ]
    return {
        "unit": "us/step",
        "repeats": repeats,
        "effects": {name: list(each.plan.spec.effects) for name, each in timed.items()},
        "drop_difference_m": same_drop(drop, coefficient),
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
