"""What curved edges, least-norm forces and compliances that are springs cost a step: a table.

    python -m tests.benchmarks.statics [--before DIR] [--starts 15] [--steps 240]

Each scene is stepped from its start, unlogged, by the default numerics and by them without what the
row is about, in turns; processor time, the least of all starts. No key makes curved edges polygons:
they are compared with a checkout DIR of a commit before them (2a4b550), by the laws of that time
(FORMER), each checkout in a process of its own. Without DIR these rows are left out.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from .as_process import ROOT

FORMER = (
    "integrator: midpoint, impacts: at_surface, undetermined_forces: as_solved, "
    "compliance_law: regularised"
)
FLOOR = "floor: {shape: {kind: plane}, surface: one}"
TABLE = (
    "table: {shape: {kind: box, size: [2, 2, 0.2]}, fixed: true, surface: one, "
    "position: [0, 0, -0.1]}"
)
CYLINDER = "{kind: cylinder, radius: 0.1, length: 0.2}"
BOX = "{kind: box, size: [0.2, 0.2, 0.2]}"
ACROSS = "orientation: {axis: [1, 0, 0], degrees: 90}"


def body(name: str, shape: str, place: str, more: str = "") -> str:
    return f"{name}: {{shape: {shape}, mass: 1, surface: one, position: {place}{more}}}"


class Row(NamedTuple):
    """A scene; without: the law that it is compared with, "" the commit before."""

    name: str
    bodies: tuple[str, ...]
    without: str = ""
    surface: str = "friction: 0.5"


FORCES, SPRING = "undetermined_forces: as_solved", "compliance_law: regularised"
ROWS = (
    Row("cylinder that stands on a plane", (FLOOR, body("one", CYLINDER, "[0, 0, 0.1]"))),
    Row("cylinder that stands on a box", (TABLE, body("one", CYLINDER, "[0, 0, 0.1]"))),
    Row(
        "cylinder that lies on a box",
        (TABLE, body("one", CYLINDER, "[0, 0, 0.1]", f", {ACROSS}")),
    ),
    Row(
        "two cylinders that lie side by side",
        (
            FLOOR,
            body("one", CYLINDER, "[0, 0, 0.1]", f", {ACROSS}"),
            body("two", CYLINDER, "[0.2, 0, 0.1]", f", {ACROSS}"),
        ),
    ),
    Row(
        "cylinder that rolls",
        (
            FLOOR,
            body(
                "one",
                CYLINDER,
                "[0, 0, 0.1]",
                f", {ACROSS}, velocity: [1, 0, 0], angular_velocity: [0, 10, 0]",
            ),
        ),
    ),
    Row("box at rest", (FLOOR, body("one", BOX, "[0, 0, 0.1]")), FORCES),
    Row(
        "six boxes at rest",
        (FLOOR, *(body(f"b{k}", BOX, f"[0, 0, {0.1 + 0.2 * k:.1f}]") for k in range(6))),
        FORCES,
    ),
    Row(
        "box that slides",
        (FLOOR, body("one", BOX, "[0, 0, 0.1]", ", velocity: [2, 0, 0]")),
        FORCES,
        "friction: 0.1",
    ),
    Row(
        "ball at rest on a compliance",
        (FLOOR, body("one", "{kind: sphere, radius: 0.1}", "[0, 0, 0.099]")),
        SPRING,
        "compliance: 1e-4, damping_ratio: 0.5",
    ),
    Row(
        "box at rest on a compliance",
        (FLOOR, body("one", BOX, "[0, 0, 0.0998]")),
        SPRING,
        "friction: 0.5, compliance: 1e-5, damping_ratio: 0.5",
    ),
)
# Runs in either checkout: what the engine is called by has the same names in both.
WORKER = """
import sys
from time import process_time_ns
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of
cases = []
for line in sys.stdin:
    if line.startswith("{"):
        (cell,) = load_experiment_text(eval(line)["text"], "scene.yaml").cells()
        config = getattr(cell, "resolved", cell.config)
        plan = plan_of(config, False)
        build(config, plan.spec).engine(plan.spec).advance(1)
        cases.append((config, plan.spec, cell.config.steps))
        print(len(cases), flush=True)
        continue
    config, spec, steps = cases[int(line)]
    engine = build(config, spec).engine(spec)
    begin = process_time_ns()
    while engine.counters["step"][0] < steps:
        engine.advance(steps - int(engine.counters["step"][0]))
    print((process_time_ns() - begin) / 1000.0 / steps, flush=True)
"""


def text_of(row: Row, law: str, steps: int) -> str:
    """Return the config of a row under a law."""
    bodies = "\n".join(f"    {each}" for each in row.bodies)
    more = f", {law}" if law else ""
    return (
        f"scene:\n  surfaces: {{one: {{{row.surface}}}}}\n  bodies:\n{bodies}\n"
        f"numerics: {{timestep: 1/240{more}}}\nduration: {steps}/240\n"
    )


@contextmanager
def worker(checkout: Path) -> Iterator[Any]:
    """Yield a kernel of a checkout: `ask(line) -> number`."""
    path = os.environ | {"PYTHONPATH": str(checkout)}
    with subprocess.Popen(
        [sys.executable, "-c", WORKER],
        cwd=checkout,
        env=path,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        wants, gives = process.stdin, process.stdout

        def ask(line: str) -> float:
            wants.write(line + "\n")
            wants.flush()
            return float(gives.readline())

        yield ask
        wants.close()


def measure(before: Path | None, starts: int, steps: int, rows: tuple[Row, ...] = ROWS) -> str:
    """Return the table, as Markdown."""
    lines = ["| scene | without | with | ratio |", "|---|---:|---:|---:|"]
    with ExitStack() as stack:
        now = stack.enter_context(worker(ROOT))
        then = stack.enter_context(worker(before)) if before else None
        known = {now: 0, then: 0}
        pairs: list[tuple[str, list[tuple[Any, int]], tuple[list[float], list[float]]]] = []
        for row in rows:
            if row.without:
                sides = (now, text_of(row, row.without, steps)), (now, text_of(row, "", steps))
            elif then is not None:
                sides = (then, text_of(row, "", steps)), (now, text_of(row, FORMER, steps))
            else:
                continue
            places = []
            for ask, text in sides:
                ask(repr({"text": text}))
                places.append((ask, known[ask]))
                known[ask] += 1
            pairs.append((row.name, places, ([], [])))
        for start in range(starts):
            for _, places, found in pairs:
                for side in (0, 1) if start % 2 else (1, 0):
                    ask, place = places[side]
                    found[side].append(ask(str(place)))
    for name, _, (without, own) in pairs:
        ratio = min(own) / min(without)
        lines.append(f"| {name} | {min(without):.3g} | {min(own):.3g} | {ratio:.2f} |")
    return "\n".join(lines)


def main() -> int:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description="What statics of redundant contacts costs.")
    parser.add_argument("--before", type=Path, help="checkout of a commit without curved edges")
    parser.add_argument("--starts", type=int, default=15, help="of each scene, in turns")
    parser.add_argument("--steps", type=int, default=240, help="of each start")
    asked = parser.parse_args()
    print(measure(asked.before, asked.starts, asked.steps))
    return 0


if __name__ == "__main__":
    sys.exit(main())
