"""What the default makes of large scenes: time of a step, and whether it solved it.

    python -m tests.benchmarks.large_scenes [SCENE ...] [--steps 60] [--json] [--output FILE.json]

Pyramids, a wall in running bond and a tower from their first step on, the pile of a thousand
spheres once it has settled, and spheres in a box, ten layers deep, while they settle; of these also
a thousand that land, by default, solved to 1e-6 m/s by many sweeps, and to 1e-9 by Newton's method.
Nothing sleeps. Steps are made one
by one: a row has the mean time of a step, the largest residual of any, how many were
solved to the tolerance, and what sweeps and Newton's method did. Time is the processor's own in
this thread where the system counts it finely; compiling is apart. Beside it stands what a visit of
a packed contact moves, and how fast memory gives as much.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from lavendersim.quantities.found import nearest
from lavendersim.runner.environment import environment
from lavendersim.runner.timed_engine import clock

from .memory_traffic import memory_bandwidth, traffic_of
from .prepared_contacts import pile
from .scenes import case

STEPS = 60
TOLERANCE = 1e-9  # [m/s] what the default asks for
FRICTIONAL = "surface: {friction: 0.5}"
BOX = f"{{shape: {{kind: box, size: [0.2, 0.2, 0.2]}}, mass: 1.0, {FRICTIONAL}}}"
BRICK = f"{{shape: {{kind: box, size: [0.2, 0.1, 0.1]}}, mass: 1.0, {FRICTIONAL}}}"
SPHERE = f"{{shape: {{kind: sphere, radius: 0.05}}, mass: 1.0, {FRICTIONAL}}}"
# Bricks of a row stand a joint of 2 mm apart; their centres are this far from each other [m].
PITCH, HEIGHT = 0.202, 0.1
# Spheres of a box are a little off their places and fall by less than their radius.
APART, OFF, DEEP = 0.104, 0.001, 10


def _standing(arrangements: str) -> str:
    return f"""\
scene:
  bodies:
    floor: {{shape: {{kind: plane}}, {FRICTIONAL}}}
  arrangements:
{arrangements}numerics: {{timestep: 1/240}}
duration: 4.0
"""


def pyramid(base: int) -> str:
    """Return a pyramid with so many boxes in its lowest row, 20 mm apart."""
    return _standing(f"    box: {{kind: pyramid, base_count: {base}, gap: 0.02, body: {BOX}}}\n")


def tower(count: int) -> str:
    """Return so many boxes, one on the other."""
    return _standing(f"    box: {{kind: tower, count: {count}, body: {BOX}}}\n")


def wall(length: int, rows: int) -> str:
    """Return a wall in running bond, so many bricks long and high."""
    courses = [
        f"    course_{k}: {{kind: grid, counts: [{length}, 1, {(rows + 1 - k) // 2}], "
        f"spacing: [{PITCH}, 1.0, {2 * HEIGHT}], "
        f"origin: [{0.5 * k * PITCH}, 0, {(0.5 + k) * HEIGHT}], body: {BRICK}}}\n"
        for k in range(2)
    ]
    return _standing("".join(courses))


def spheres(along: int, across: int) -> str:
    """Return a box of spheres, so many along and across, ten deep."""
    half = [0.5 * APART * n + OFF for n in (along, across)]
    sides = [
        f"    {name}: {{shape: {{kind: plane, normal: {normal}, offset: {-offset:.6g}}}, "
        f"{FRICTIONAL}}}\n"
        for name, normal, offset in (
            ("west", [1, 0, 0], half[0]),
            ("east", [-1, 0, 0], half[0]),
            ("south", [0, 1, 0], half[1]),
            ("north", [0, -1, 0], half[1]),
        )
    ]
    origin = [-0.5 * APART * (n - 1) for n in (along, across)]
    text = _standing(
        f"    ball: {{kind: grid, counts: [{along}, {across}, {DEEP}], "
        f"spacing: [{APART}, {APART}, {APART}], jitter: {OFF}, seed: 1, "
        f"origin: [{origin[0]:.6g}, {origin[1]:.6g}, {0.5 * APART}], body: {SPHERE}}}\n"
    )
    return text.replace("  arrangements:\n", "".join(sides) + "  arrangements:\n")


def solved(text: str) -> str:
    """Return a scene that asks for every step to be solved, as a heap of spheres by itself is not.

    Newton's method then has its factor by supernodes.
    """
    return text + "effects: {supernodes: on}\n"


def swept(text: str) -> str:
    """Return a scene that asks for 1e-6 m/s, and gives a solve as many sweeps as that may take."""
    numerics = "numerics: {timestep: 1/240, tolerance: 1e-6, sweeps: 20000}"
    assert "numerics: {timestep: 1/240}" in text
    return text.replace("numerics: {timestep: 1/240}", numerics)


class Large(NamedTuple):
    """A scene, the step from which on it is measured, and what it asks for [m/s]."""

    text: str
    begins: int = 0
    tolerance: float = TOLERANCE


SCENES = {
    "pyramid_1275": Large(pyramid(50)),
    "pyramid_5050": Large(pyramid(100)),
    "wall_1000": Large(wall(40, 25)),
    "tower_300": Large(tower(300)),
    "pile_1000": Large(pile(25), 720),
    "spheres_1000": Large(spheres(10, 10), 180),
    "spheres_1000_landing": Large(spheres(10, 10), 10),
    "spheres_1000_landing_swept": Large(swept(spheres(10, 10)), 10, 1e-6),
    "spheres_1000_landing_solved": Large(solved(spheres(10, 10)), 10),
    "spheres_10240": Large(spheres(32, 32), 180),
    "spheres_30000": Large(spheres(60, 50), 180),
}


def measure(name: str, large: Large, steps: int) -> dict[str, Any]:
    """Return what steps of a scene took, from where it is measured on, and what they left."""
    engine = case(large.text, record=False).engine()
    engine.advance(large.begins)
    now, counters = clock()[1], engine.counters
    spent, rows = np.zeros(steps), []
    for k in range(steps):
        made = int(counters["newton_steps"][0])
        begin = now()
        engine.advance(1)
        spent[k] = now() - begin
        row = counters[0]
        rows.append((row["residual"], row["contacts"], row["sweeps"], row["newton_steps"] - made))
    residuals, contacts, sweeps, newton = np.array(rows, dtype=float).T
    visits = contacts @ sweeps
    return {
        "scene": name,
        "bodies": int((engine.bodies["inv_m"] > 0.0).sum()),
        "contacts": float(contacts.mean()),
        "us_per_step": float(spent.mean() / 1000.0),
        "slowest_us": float(spent.max() / 1000.0),
        "sweeps": float(sweeps.mean()),
        "newton_steps": float(newton.mean()),
        "ns_per_visit": float(spent.sum() / visits) if visits else None,
        "bytes_per_visit": traffic_of(engine.spec).as_data(),
        "solved": int((residuals <= large.tolerance).sum()),
        "worst_residual": float(residuals.max()),
    }


def table(found: dict[str, Any]) -> str:
    """Return all scenes as a small table."""
    lines = [
        f"{'scene':27} {'bodies':>6} {'contacts':>8} {'ms/step':>9} {'slowest':>9} {'sweeps':>7} "
        f"{'newton':>7} {'ns/visit':>9} {'solved':>9} {'worst':>8}   residual [m/s]"
    ]
    for row in found["scenes"]:
        visit = row["ns_per_visit"]
        lines.append(
            f"{row['scene']:27} {row['bodies']:6} {row['contacts']:8.0f} "
            f"{row['us_per_step'] / 1000.0:9.2f} {row['slowest_us'] / 1000.0:9.2f} "
            f"{row['sweeps']:7.1f} {row['newton_steps']:7.1f} "
            f"{'-' if visit is None else format(visit, '.1f'):>9} "
            f"{row['solved']:4}/{found['steps']:<4} {row['worst_residual']:8.1e}"
        )
    for rows, bodies in sorted({tuple(row["bytes_per_visit"].values()) for row in found["scenes"]}):
        lines.append(
            f"a visit of a packed contact reads {rows} bytes of its own and {bodies} of its "
            f"bodies, which are written again; memory gives {found['memory_bandwidth']:.1f} GB/s: "
            f"{rows / found['memory_bandwidth']:.1f} ns for its own"
        )
    machine = found["environment"]
    lines.append(f"{machine['processor']}, {machine['cores']} cores; {found['steps']} steps each")
    return "\n".join(lines)


def main() -> int:
    """Read the command line, measure, print, write."""
    parser = argparse.ArgumentParser(description="What the default makes of large scenes.")
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=f"of {', '.join(SCENES)}")
    parser.add_argument("--steps", type=int, default=STEPS)
    parser.add_argument("--json", action="store_true", help="print everything as JSON")
    parser.add_argument("--output", type=Path, help="JSON file")
    given = parser.parse_args()
    for name in given.scenes:
        if name not in SCENES:
            parser.error(f"no scene is called {name}{nearest(name, SCENES)}")
    found = {
        "steps": given.steps,
        "clock": clock()[0],
        "environment": environment(),
        "memory_bandwidth": memory_bandwidth(),
        "scenes": [measure(n, SCENES[n], given.steps) for n in given.scenes or SCENES],
    }
    print(json.dumps(found) if given.json else table(found))
    if given.output:
        given.output.write_text(json.dumps(found, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
