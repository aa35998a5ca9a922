"""What a contact costs each solver in a sweep, on real contacts.

    python -m tests.benchmarks.contact_sweep [--repeats 15] [--check] [--json] [--output FILE.json]
        [--plot DIR]

The scene runs to where it rests; the contacts of its next step, with impulses of the step before,
are what every solver gets (`prepared_contacts`). A sample is one solve with `--sweeps` sweeps less
one with none right after it, by sweeps and contacts, both with warm caches. What a solve costs
without sweeps stands apart, by contacts: packing and unpacking, and one look at the residual, which
alone is what projected Gauss-Seidel does there. Every repeat visits all solvers, in alternating
order; time is the processor's own in this thread where the system counts it finely; compiling is
apart.

Residuals that accelerated_projected_gradient and jacobi look at on their way are in their sweeps,
and adaptive's are without Newton's method. With --check the exit code is 1 above a bar.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from lavendersim.figures.contact_cost import draw_contact_cost
from lavendersim.runner.environment import environment
from lavendersim.runner.timed_engine import clock

from .prepared_contacts import EVERY_SOLVER, Solve, pile, prepare, pyramid

BASE, LAYERS = 20, 25  # boxes in the pyramid's lowest row, of forty spheres in the pile
RESTS = {"pyramid": 480, "pile": 720}  # steps
GROWTH = (3, 5, 8, 12, 16, 20)  # boxes in the lowest row
BARS = {"block_gauss_seidel": 25.0, "coloured_gauss_seidel": 12.0}  # [ns]
PEERS = "PhysX 8-11, Rapier 24-34, Bullet 38-70, MuJoCo's projected Gauss-Seidel about 500"


class Timed(NamedTuple):
    """One solver on the contacts of one scene, and its samples [ns]."""

    scene: str
    solve: Solve
    sweep: list[float]  # of a contact in a sweep
    once: list[float]  # of a contact in a solve without sweeps

    def sample(self, sweeps: int) -> None:
        """Take a sample of both."""
        now = clock()[1]
        self.solve.run(0)  # or what others left in the caches would be paid for by the sweeps
        with_sweeps = self.solve.run(sweeps, now)
        made = max(self.solve.sweeps, 1)
        without = self.solve.run(0, now)
        self.sweep.append((with_sweeps - without) / (made * self.solve.count))
        self.once.append(without / self.solve.count)

    def as_data(self, bar: float | None) -> dict[str, Any]:
        """Return medians and all samples as plain data."""
        return {
            "scene": self.scene,
            "solver": self.solve.name,
            "contacts": self.solve.count,
            "median": median(self.sweep),
            "bar": bar,
            "samples": self.sweep,
            "once_median": median(self.once),
            "once_samples": self.once,
            "compile_s": self.solve.compile_s,
            "compiled": "disk" if self.solve.loaded else "source",
        }


def timed_on(scene: str, text: str, step: int, solvers: Sequence[str]) -> list[Timed]:
    """Return solvers, compiled, on the contacts of a scene."""
    prepared = prepare(text, step)
    return [Timed(scene, Solve(prepared, solver), [], []) for solver in solvers]


def measure(
    repeats: int,
    sweeps: int,
    base: int = BASE,
    layers: int = LAYERS,
    growth: Sequence[int] = GROWTH,
    solvers: Sequence[str] = EVERY_SOLVER,
) -> dict[str, Any]:
    """Time solvers, interleaved, on a pyramid, a pile, and on pyramids of several sizes."""
    pyramids = {
        rows: timed_on(
            f"pyramid of {rows * (rows + 1) // 2}", pyramid(rows), RESTS["pyramid"], solvers
        )
        for rows in sorted({base, *growth})
    }
    piles = timed_on(f"pile of {40 * layers}", pile(layers), RESTS["pile"], solvers)
    every = [*(timed for one in pyramids.values() for timed in one), *piles]
    for timed in every:
        timed.sample(sweeps)  # warms caches and clocks
        timed.sweep.clear()
        timed.once.clear()
    for repeat in range(repeats):
        for timed in every[:: -1 if repeat % 2 else 1]:
            timed.sample(sweeps)
    return {
        "unit": "ns per contact and sweep; once: ns per contact and solve, without sweeps",
        "repeats": repeats,
        "sweeps": sweeps,
        "clock": clock()[0],
        "environment": environment(),
        "cases": [timed.as_data(BARS.get(timed.solve.name)) for timed in (*pyramids[base], *piles)],
        "growth": [timed.as_data(None) for rows in growth for timed in pyramids[rows]],
    }


def _spread(samples: list[float]) -> str:
    return f"{median(samples):8.1f} {min(samples):8.1f} {max(samples):8.1f}"


def table(found: dict[str, Any]) -> str:
    """Return medians and spreads as a small table."""
    lines = [
        f"{'':46} {'contacts':>8} {'median':>8} {'least':>8} {'most':>8} {'bar':>4} {'once':>8}"
        "   ns by contact and sweep; once: by contact and solve"
    ]
    for row in found["cases"]:
        bar = "" if row["bar"] is None else f"{row['bar']:g}"
        name = f"{row['scene']}, {row['solver']}"
        lines.append(
            f"{name:46} {row['contacts']:8} {_spread(row['samples'])} {bar:>4} "
            f"{row['once_median']:8.1f}"
        )
    for solver in dict.fromkeys(row["solver"] for row in found["growth"]):
        grown = [row for row in found["growth"] if row["solver"] == solver]
        by_size = ", ".join(f"{row['contacts']}: {row['median']:.1f}" for row in grown)
        lines.append(f"{solver} by contacts of a pyramid: {by_size}")
    compiled = sum(row["compile_s"] for row in found["cases"])
    machine = found["environment"]
    lines.append(f"other engines, for comparison: {PEERS}")
    lines.append(
        f"{machine['processor']}, {machine['cores']} cores; {found['repeats']} interleaved repeats "
        f"of {found['sweeps']} sweeps by {found['clock']}; solvers compiled or loaded, apart: "
        f"{compiled:.1f} s"
    )
    return "\n".join(lines)


def main() -> int:
    """Read the command line, measure, print, write."""
    parser = argparse.ArgumentParser(description="What a contact costs in a sweep.")
    parser.add_argument("--repeats", type=int, default=15, help="interleaved rounds")
    parser.add_argument("--sweeps", type=int, default=50, help="in a sample")
    parser.add_argument("--base", type=int, default=BASE, help="boxes in the lowest row")
    parser.add_argument("--layers", type=int, default=LAYERS, help="of forty spheres in the pile")
    parser.add_argument("--growth", type=int, nargs="*", default=GROWTH, help="other lowest rows")
    parser.add_argument("--solvers", nargs="+", choices=EVERY_SOLVER, default=EVERY_SOLVER)
    parser.add_argument("--json", action="store_true", help="print everything as JSON")
    parser.add_argument("--output", type=Path, help="JSON file for medians and all samples")
    parser.add_argument("--plot", type=Path, help="folder for cost against contact count")
    parser.add_argument("--check", action="store_true", help="exit 1 above a bar")
    arguments = parser.parse_args()
    found = measure(
        arguments.repeats,
        arguments.sweeps,
        arguments.base,
        arguments.layers,
        arguments.growth,
        arguments.solvers,
    )
    print(json.dumps(found) if arguments.json else table(found))
    if arguments.output:
        arguments.output.write_text(json.dumps(found, indent=1) + "\n")
    if arguments.plot:
        for figure in draw_contact_cost(found, arguments.plot):
            print(figure, file=sys.stderr)
    over = [row for row in found["cases"] if row["bar"] is not None and row["median"] > row["bar"]]
    return 1 if arguments.check and over else 0


if __name__ == "__main__":
    sys.exit(main())
