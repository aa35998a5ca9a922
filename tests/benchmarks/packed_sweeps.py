"""What packed sweeps save of a step, by the number of bodies: the default with and without them.

    python -m tests.benchmarks.packed_sweeps [--layers 5 10 25] [--bases 13 20] [--steps 480]
        [--surfaces frictional turning frictionless] [--repeats 1] [--check] [--json]
        [--output FILE.json]

Piles of forty spheres a layer fall into a box: spheres that are frictional, that resist turning as
well, or that have no friction; pyramids stand from the start. Both engines of a scene go from its
start to its end, ten steps of each in turn, in alternating order: each makes the motion that its
own sweeps give. Time is the processor's own in this thread where the system counts it finely;
compiling is apart. Beside it stand the median residual, and how deep anything overlaps
at the end: what time is saved by must not be accuracy. With --check the exit code is 1 where a
scene of FEWEST_BODIES and more takes more than BAR of the time without.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from lavendersim.engine.effects.packed_sweeps import FEWEST_BODIES
from lavendersim.engine.engine import Engine
from lavendersim.runner.environment import environment
from lavendersim.runner.timed_engine import clock
from lavendersim.scene.build import build

from .prepared_contacts import pile, pyramid
from .scenes import Case, case

LAYERS, BASES = (1, 5, 12, 25), (6, 13, 20)
STEPS, BLOCK = 480, 10
SURFACES = {
    "frictional": "{friction: 0.5}",  # as the scene has it
    "turning": "{friction: 0.5, torsional_friction: 0.001, rolling_friction: 0.001}",
    "frictionless": "{friction: 0}",
}
# Of the time without. A pyramid at rest ends its solves before anything is packed.
BAR = {"pile": 0.9, "pyramid": 1.05}


class Course(NamedTuple):
    """One engine on its way."""

    engine: Engine
    spent: list[int]  # [ns] of each block of steps
    residuals: list[float]  # [m/s] at the end of each

    def advance(self, steps: int) -> None:
        """Make steps and note what they took."""
        now = clock()[1]
        begin = now()
        self.engine.advance(steps)
        self.spent.append(now() - begin)
        self.residuals.append(float(self.engine.counters["residual"][0]))

    def as_data(self, steps: int) -> dict[str, float]:
        """Return time of a step, residual and overlap."""
        count = int(self.engine.counters["contacts"][0])
        depths = -self.engine.contacts["phi"][:count]
        return {
            "us_per_step": sum(self.spent) / steps / 1000.0,
            "residual": median(self.residuals),
            "overlap": float(max(depths.max(initial=0.0), 0.0)),
        }


def courses(scene: Case) -> dict[bool, Course]:
    """Return the engines of a scene without and with packed sweeps, compiled."""
    bare = scene.plan.spec.without("packed_sweeps")
    specs = {False: bare, True: bare.including("packed_sweeps")}
    engines = {packs: build(scene.config, spec).engine(spec) for packs, spec in specs.items()}
    for engine in engines.values():
        engine.advance(0)
    return {packs: Course(engine, [], []) for packs, engine in engines.items()}


def text_of(kind: str, size: int, surface: str) -> str:
    """Return the config of a scene."""
    if kind == "pyramid":
        return pyramid(size)
    text = pile(size)
    assert SURFACES["frictional"] in text
    return text.replace(SURFACES["frictional"], SURFACES[surface])


def measure(
    kind: str, size: int, surface: str, steps: int = STEPS, repeats: int = 1
) -> dict[str, Any]:
    """Return one scene with and without, of `repeats` runs the one of the median ratio."""
    scene = case(text_of(kind, size, surface), record=False)
    runs = []
    for _ in range(repeats):
        both = courses(scene)
        for k in range(steps // BLOCK):
            for packs in (True, False) if k % 2 else (False, True):
                both[packs].advance(BLOCK)
        made = steps // BLOCK * BLOCK
        without, with_them = both[False].as_data(made), both[True].as_data(made)
        counters = both[True].engine.counters[0]
        runs.append(
            {
                "without": without,
                "with": with_them,
                "ratio": with_them["us_per_step"] / without["us_per_step"],
                "contacts": int(counters["contacts"]),
                "newton_steps": int(counters["newton_steps"]),
            }
        )
    chosen = sorted(runs, key=lambda run: run["ratio"])[len(runs) // 2]
    bodies = (both[True].engine.bodies["inv_m"] > 0.0).sum()
    named = kind if kind == "pyramid" else f"{surface} {kind}"
    return {"scene": named, "bodies": int(bodies), "bar": BAR[kind], **chosen}


def table(found: dict[str, Any]) -> str:
    """Return all scenes as a small table."""
    lines = [
        f"{'scene':17} {'bodies':>6} {'contacts':>8} {'without':>9} {'with':>9} {'ratio':>6} "
        f"{'residual':>17} {'overlap':>13}   us by step; residual [m/s] and overlap [um] of both"
    ]
    for row in found["scenes"]:
        a, b = row["without"], row["with"]
        lines.append(
            f"{row['scene']:17} {row['bodies']:6} {row['contacts']:8} {a['us_per_step']:9.1f} "
            f"{b['us_per_step']:9.1f} {row['ratio']:6.2f} "
            f"{a['residual']:8.1e} {b['residual']:8.1e} "
            f"{1e6 * a['overlap']:6.1f} {1e6 * b['overlap']:6.1f}"
        )
    machine = found["environment"]
    lines.append(f"{machine['processor']}, {machine['cores']} cores; {found['steps']} steps")
    return "\n".join(lines)


def measure_all(
    layers: Sequence[int], bases: Sequence[int], surfaces: Sequence[str], steps: int, repeats: int
) -> dict[str, Any]:
    """Measure piles of so many layers with such surfaces, and pyramids of such bases."""
    scenes = [("pile", n, surface) for surface in surfaces for n in layers]
    scenes += [("pyramid", n, "frictional") for n in bases]
    return {
        "steps": steps,
        "clock": clock()[0],
        "environment": environment(),
        "scenes": [measure(*scene, steps=steps, repeats=repeats) for scene in scenes],
    }


def too_slow(found: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the scenes that the plan packs and that take more than their bar."""
    packed = [row for row in found["scenes"] if row["bodies"] >= FEWEST_BODIES]
    return [row for row in packed if row["ratio"] > row["bar"]]


def main() -> int:
    """Read the command line, measure, print, write."""
    parser = argparse.ArgumentParser(description="What packed sweeps save of a step.")
    parser.add_argument("--layers", type=int, nargs="*", default=LAYERS, help="of forty spheres")
    parser.add_argument("--bases", type=int, nargs="*", default=BASES, help="boxes in a lowest row")
    parser.add_argument("--surfaces", nargs="*", default=[*SURFACES], choices=SURFACES)
    parser.add_argument("--steps", type=int, default=STEPS)
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--json", action="store_true", help="print everything as JSON")
    parser.add_argument("--output", type=Path, help="JSON file")
    parser.add_argument("--check", action="store_true", help="exit 1 above a bar")
    given = parser.parse_args()
    found = measure_all(given.layers, given.bases, given.surfaces, given.steps, given.repeats)
    print(json.dumps(found) if given.json else table(found))
    if given.output:
        given.output.write_text(json.dumps(found, indent=1) + "\n")
    return 1 if given.check and too_slow(found) else 0


if __name__ == "__main__":
    sys.exit(main())
