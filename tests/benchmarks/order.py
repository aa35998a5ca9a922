"""What contact at second order and impacts in their order cost a step: a table of shipped scenes.

    python -m tests.benchmarks.order [--repeats 5] [--output FILE.json] [--check]

Each scene is stepped from its start, unlogged, by the default numerics and by three older laws:
    first order      integrator: midpoint, impacts: at_surface
    without order    impacts: at_surface
    at the ends      integrator: midpoint
interleaved, in alternating order; a ratio is the median of those of one round. Where motions differ
(what falls and strikes) a ratio compares two motions, too.
With --check the exit code is 1 when the default takes more than BAR times the first order.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from statistics import median
from time import perf_counter_ns
from typing import Any

from lavendersim.engine.records import DIVERGED
from lavendersim.experiment import load_experiment
from lavendersim.runner.environment import environment
from lavendersim.scene.build import build
from lavendersim.scene.plan import Plan, plan_of

from .as_process import ROOT

BAR = 1.03
MOST_STEPS = 480
MICROSECOND = 1000.0  # [ns]
SCENES = (
    *("cost/drop", "cost/incline", "cost/stack_of_six", "cost/pyramid", "cost/pile"),
    *("scenes/rest", "scenes/oblique_impact", "hard/structure/dominoes"),
)
LAWS: dict[str, dict[str, str]] = {
    "default": {},
    "first order": {"integrator": "midpoint", "impacts": "at_surface"},
    "without order": {"impacts": "at_surface"},
    "at the ends": {"integrator": "midpoint"},
}


def config_of(scene: str, laws: dict[str, str]) -> Any:
    """Return the first cell of a shipped config under other laws."""
    config = load_experiment(ROOT / f"configs/{scene}.yaml").cells()[0].config
    return config.model_copy(update={"numerics": config.numerics.model_copy(update=laws)})


def step_time(config: Any, plan: Plan) -> float:
    """Return the time of a step [us], from the start of the scene."""
    engine = build(config, plan.spec).engine(plan.spec)
    engine.advance(0)
    steps = min(config.steps, MOST_STEPS)
    begin = perf_counter_ns()
    assert engine.advance(steps) != DIVERGED
    return (perf_counter_ns() - begin) / MICROSECOND / steps


def measure(repeats: int, scenes: tuple[str, ...] = SCENES) -> dict[str, Any]:
    """Time all scenes under all laws, in turn."""
    configs = {(scene, name): config_of(scene, LAWS[name]) for scene in scenes for name in LAWS}
    plans = {key: plan_of(config, record=False) for key, config in configs.items()}
    for key, config in configs.items():
        step_time(config, plans[key])  # compiles
    samples: dict[tuple[str, str], list[float]] = {key: [] for key in configs}
    for repeat in range(repeats):
        for key in list(configs)[:: -1 if repeat % 2 else 1]:
            samples[key].append(step_time(configs[key], plans[key]))
    rows = []
    for scene in scenes:
        first = samples[scene, "first order"]
        found = {name: samples[scene, name] for name in LAWS}
        ratios = {
            name: median(one / other for one, other in zip(each, first, strict=True))
            for name, each in found.items()
        }
        rows.append({"scene": scene, "samples": found, "ratios": ratios})
    specs = [plan.spec for plan in plans.values()]
    return {"unit": "us/step", "rows": rows, "environment": environment(*specs)}


def table(found: dict[str, Any]) -> str:
    """Return the medians of the two, and the ratios to the first order."""
    heads = f"{'':26} {'default':>10} {'first order':>12} {'ratio':>7}"
    lines = [f"{heads} {'without order':>14} {'at the ends':>12}"]
    for row in found["rows"]:
        times = {name: median(each) for name, each in row["samples"].items()}
        ratios = row["ratios"]
        line = f"{row['scene']:26} {times['default']:10.3f} {times['first order']:12.3f}"
        line += f" {ratios['default']:7.2f} {ratios['without order']:14.2f}"
        lines.append(f"{line} {ratios['at the ends']:12.2f}")
    return "\n".join(lines)


def main() -> int:
    """Read the command line, measure, print, write."""
    parser = argparse.ArgumentParser(description="What second order costs a step.")
    parser.add_argument("--repeats", type=int, default=5, help="interleaved rounds")
    parser.add_argument("--output", type=Path, help="JSON file for all samples")
    parser.add_argument("--check", action="store_true", help="exit 1 above the bar")
    arguments = parser.parse_args()
    found = measure(arguments.repeats)
    print(table(found))
    if arguments.output:
        arguments.output.write_text(json.dumps(found, indent=1) + "\n")
    over = [row["scene"] for row in found["rows"] if row["ratios"]["default"] > BAR]
    return 1 if arguments.check and over else 0


if __name__ == "__main__":
    sys.exit(main())
