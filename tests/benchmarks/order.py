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
from typing import Any

from lavendersim.experiment import load_experiment
from lavendersim.runner.environment import environment
from lavendersim.scene.plan import plan_of

from .as_process import ROOT
from .engine import engine_step
from .scenes import Case

BAR = 1.03
MOST_STEPS = 480
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


def under(scene: str, laws: dict[str, str]) -> Case:
    """Return the first cell of a shipped config under other laws, unlogged."""
    path = ROOT / f"configs/{scene}.yaml"
    config = load_experiment(path).cells()[0].config
    config = config.model_copy(update={"numerics": config.numerics.model_copy(update=laws)})
    plan = plan_of(config, record=False)
    return Case(config, plan, min(config.steps, MOST_STEPS), path.read_text())


def measure(repeats: int, scenes: tuple[str, ...] = SCENES) -> dict[str, Any]:
    """Time all scenes under all laws, in turn."""
    cases = {(scene, name): under(scene, LAWS[name]) for scene in scenes for name in LAWS}
    for each in cases.values():
        each.engine()  # compiles
    samples: dict[tuple[str, str], list[float]] = {key: [] for key in cases}
    for repeat in range(repeats):
        for key in list(cases)[:: -1 if repeat % 2 else 1]:
            samples[key].append(engine_step(cases[key], 0, 1))
    rows = []
    for scene in scenes:
        first = samples[scene, "first order"]
        found = {name: samples[scene, name] for name in LAWS}
        ratios = {
            name: median(one / other for one, other in zip(each, first, strict=True))
            for name, each in found.items()
        }
        rows.append({"scene": scene, "samples": found, "ratios": ratios})
    specs = [each.plan.spec for each in cases.values()]
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
