"""What finding near pairs costs, by number of bodies: a table and a file of all samples.

    python -m tests.benchmarks.broad_phase [--counts 100 1000 10000] [--repeats 9] [--output F.json]

settled   spheres packed at random, at rest: a list is made once; idle is a step that keeps it
mixed     sizes over four decades, five near pairs a body, at rest
stirred   the packed spheres swing at 1 m/s: mean cost of a step, rebuilds and the first look of the
          narrow phase at each listed pair (`LOOK`) included
Times are those of the thread: other processes of the machine do not enter.
The exponent p says that cost grows as N^p from one number of bodies to the next.
"""

from __future__ import annotations

import argparse
import json
import sys
from itertools import pairwise
from math import log
from pathlib import Path
from statistics import median
from time import thread_time_ns
from typing import Any

import numpy as np

from lavendersim.engine.collide.broad import broad_phase
from lavendersim.engine.compile import compiling
from lavendersim.engine.effects import BY_NAME
from lavendersim.engine.record_layout import template_dtype
from lavendersim.engine.records import (
    ANGULAR_VELOCITY,
    BODY,
    PAIR,
    PARAMETERS,
    SPHERE,
    VELOCITY,
    dtype,
)
from lavendersim.engine.spec import Spec

MICROSECOND = 1000.0  # [ns]
SPEC = Spec(("broad_phase", "rotation"), ("sphere_sphere",))
SURFACE = [(name, "f8") for name in ("restitution", "compliance", "friction")]
DT = 1.0 / 240.0  # [s]
RADIUS = 0.05  # [m]
FILLING = 0.6  # share of space that packed spheres fill
SWING, PERIOD = 1.0, 0.5  # greatest speed [m/s] and period [s] of the stirred ones
STIRRED_STEPS = 60
LOOK = 10.0  # what one listed pair that does not touch costs the narrow phase [ns]


class Cloud:
    """Spheres in a cube, and the kernel's arrays."""

    def __init__(self, find: Any, radii: np.ndarray, side: float, rng: np.random.Generator) -> None:
        count = len(radii)
        self.find = find
        self.bodies = np.zeros(count, dtype(BODY, BY_NAME["broad_phase"].fields.body))
        self.velocities = np.zeros(count, dtype(VELOCITY, ANGULAR_VELOCITY))
        self.bodies["shape"], self.bodies["inv_m"] = SPHERE, 1.0
        self.bodies["hx"] = self.bodies["bound"] = radii
        for axis in "xyz":
            self.bodies[axis] = rng.uniform(0.0, side, count)
        self.direction = rng.normal(size=(3, count))
        self.direction /= np.linalg.norm(self.direction, axis=0)
        self.phase = rng.uniform(0.0, 2.0 * np.pi, count)
        self.templates = np.zeros((1, 1), template_dtype(SURFACE))
        self.parameters = np.zeros(1, dtype(PARAMETERS))
        self.parameters["dt"], self.parameters["gz"] = DT, -9.81
        self.make_room(16)
        self.pair_count = self.step()

    def make_room(self, rows: int) -> None:
        self.pairs = np.zeros(rows, dtype(PAIR, SURFACE))
        self.work = broad_phase.allocate_broad_phase(len(self.bodies), rows)

    def call(self) -> int:
        return int(
            self.find(
                self.bodies, self.velocities, self.pairs, self.templates, self.parameters[0],
                self.work,
            )
        )  # fmt: skip

    def step(self) -> int:
        """Return how many pairs are listed; rows are enlarged as often as it takes."""
        while (count := self.call()) < 0:
            self.make_room(int(1.2 * self.work.state["needed"][0]))
        return count

    def timed(self, renew: bool, calls: int) -> float:
        """Return the cost of a call that makes the list anew, or keeps it [us]."""
        begin = thread_time_ns()
        for _ in range(calls):
            if renew:
                self.work.state["listed"] = 0
            self.call()
        return (thread_time_ns() - begin) / MICROSECOND / calls

    def stirred(self) -> tuple[float, float]:
        """Return mean cost of a step [us] and the share of steps that made the list anew."""
        spent, looks = 0, 0
        before = int(self.work.state["rebuilds"][0])
        for step in range(STIRRED_STEPS):
            turn = 2.0 * np.pi * step * DT / PERIOD + self.phase
            for axis, part in zip("xyz", self.direction, strict=True):
                self.velocities[f"v{axis}"] = SWING * np.cos(turn) * part
            begin = thread_time_ns()
            count = self.call()
            spent += thread_time_ns() - begin
            if count < 0:
                self.step()
                return self.stirred()
            looks += count
            for axis in "xyz":
                self.bodies[axis] += DT * self.velocities[f"v{axis}"]
        rebuilds = int(self.work.state["rebuilds"][0]) - before
        cost = (spent + LOOK * looks) / MICROSECOND / STIRRED_STEPS
        return cost, rebuilds / STIRRED_STEPS


def packed(find: Any, count: int) -> Cloud:
    """Return equal spheres at random places, as many per volume as in a pile."""
    side = (count * 4.0 / 3.0 * np.pi * RADIUS**3 / FILLING) ** (1.0 / 3.0)
    return Cloud(find, np.full(count, RADIUS), side, np.random.default_rng(count))


def mixed(find: Any, count: int) -> Cloud:
    """Return radii from 1 mm to 10 m, alike in number per decade, five near pairs per body."""
    rng = np.random.default_rng(count)
    radii = 10.0 ** rng.uniform(-3.0, 1.0, count)
    other = rng.permutation(radii)
    # A body has 4/3 pi (R_i + R_j)^3 n / 2 pairs on average, n bodies per volume.
    volume = float(np.mean(4.0 / 3.0 * np.pi * (radii + other) ** 3))
    return Cloud(find, radii, (count * 0.5 * volume / 5.0) ** (1.0 / 3.0), rng)


def measure(counts: list[int], repeats: int) -> list[dict[str, Any]]:
    """Time every scene and number of bodies `repeats` times, interleaved."""
    find = broad_phase.make(SPEC, SURFACE)
    with compiling():
        packed(find, 8)
    rows: list[dict[str, Any]] = []
    for count in counts:
        for name, make in (("settled", packed), ("mixed", mixed)):
            cloud = make(find, count)
            calls = max(1, 20_000 // count)
            for kind, renew in (("rebuild", True), ("idle", False)):
                rows.append(
                    {
                        "scene": f"{name}, {kind}",
                        "bodies": count,
                        "pairs": cloud.pair_count,
                        "sample": lambda c=cloud, r=renew, n=calls: c.timed(r, n),
                        "samples": [],
                    }
                )
        stirred = packed(find, count)
        _, share = stirred.stirred()
        rows.append(
            {
                "scene": "stirred, step",
                "bodies": count,
                "pairs": stirred.pair_count,
                "rebuilds_per_step": share,
                "sample": lambda c=stirred: c.stirred()[0],
                "samples": [],
            }
        )
    for _ in range(repeats):
        for row in rows:
            row["samples"].append(row["sample"]())
    for row in rows:
        del row["sample"]
        row["median_us"] = median(row["samples"])
    return rows


def exponents(rows: list[dict[str, Any]]) -> dict[str, list[float]]:
    """Return p of cost ~ N^p from each number of bodies to the next, per scene."""
    found: dict[str, list[float]] = {}
    for scene in dict.fromkeys(row["scene"] for row in rows):
        own = [(row["bodies"], row["median_us"]) for row in rows if row["scene"] == scene]
        found[scene] = [log(d / b) / log(c / a) for (a, b), (c, d) in pairwise(own)]
    return found


def table(rows: list[dict[str, Any]]) -> str:
    """Return the medians and exponents as a small table."""
    lines = [f"{'':18} {'bodies':>7} {'pairs':>7} {'median us':>10} {'ns/body':>8}"]
    for row in sorted(rows, key=lambda row: row["scene"]):
        each = row["median_us"] * MICROSECOND / row["bodies"]
        text = f"{row['scene']:18} {row['bodies']:7} {row['pairs']:7} {row['median_us']:10.1f}"
        again = (
            f"   made anew in {row['rebuilds_per_step']:.0%} of steps"
            if "rebuilds_per_step" in row
            else ""
        )
        lines.append(f"{text} {each:8.1f}{again}")
    for scene, powers in exponents(rows).items():
        lines.append(f"{scene}: cost ~ N^p, p = {', '.join(f'{p:.2f}' for p in powers)}")
    return "\n".join(lines)


def main() -> int:
    """Read the command line, measure, print, write."""
    parser = argparse.ArgumentParser(description="What finding near pairs costs.")
    parser.add_argument("--counts", type=int, nargs="+", default=[100, 1000, 10_000])
    parser.add_argument("--repeats", type=int, default=9, help="interleaved rounds")
    parser.add_argument("--output", type=Path, help="JSON file for medians and all samples")
    arguments = parser.parse_args()
    rows = measure(arguments.counts, arguments.repeats)
    print(table(rows))
    if arguments.output:
        found = {"unit": "us", "cases": rows, "exponents": exponents(rows)}
        arguments.output.write_text(json.dumps(found, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
