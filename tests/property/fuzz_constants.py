"""A drawn scene in other units of length and time, to the bit, where constants are in them, too.

Some constants of the engine have a unit: surfaces nearer than TOUCHING [m] touch, whatever their
size. They are all in `CONSTANTS`; brought into the other units, which are powers of four, nothing
is rounded otherwise, and each number of a run is its own times a power of four. What differs has a
unit that no one knows of. An engine with other constants is another process's.

    python tests/property/fuzz_constants.py PLAN SEED FIRST COUNT [cavity]

PLAN: a number, `joined`, `accurate` or `full`; `cavity`: only scenes with a bowl or a drum.
"""

from __future__ import annotations

import importlib
import multiprocessing
import pkgutil
import re
import sys
from concurrent.futures import ProcessPoolExecutor
from types import ModuleType
from typing import NamedTuple

import numpy as np
from fuzz import compiled, drawn, drawn_plans
from fuzz_laws import loaded, run
from fuzz_scenes import ACCURATE, FULL, JOINED, Drawn
from fuzz_units import rounds
from fuzz_views import View, nudged

import lavendersim.engine

UNITS = View("other units", length=16.0, time=0.25)
APART = 1e-3  # by which all is moved first, as `test_fuzz_views` says
TIME = re.compile(r" \(t = [^ ]+ s\)")  # of a sentence that has the step, too
IMPULSES = ("impulse_n", "impulse_t1", "impulse_t2")
# Powers of length and time that a constant has, by its module in the engine.
CONSTANTS = {
    "records.TOUCHING": (1, 0),
    "records.INSTANT": (0, 1),
    "approach.CREEP": (1, -1),
    "approach.OVERLAP": (1, 0),
    "collide.manifold.point.NO_AREA": (2, 0),
    "collide.manifold.point.SAME_DEPTH": (1, 0),
    "collide.pairs.cylinder_plane.DEEP": (1, 0),
    "collide.pairs.sphere_sphere.NO_DIRECTION": (1, 0),
    "collide.shapes.polyhedron.SAME_HEIGHT": (1, 0),
    "drives.MOMENT": (0, 1),
    "effects.projection.TOGETHER": (1, 0),
    "error_estimate.PLACE_NOISE": (1, 0),
    "foreseen_impacts.FALL": (1, 0),
    "free_flight.ROUNDED": (1, -1),
    "impact_location.MET": (1, 0),
    "impact_location.SOONEST": (0, 1),
    "midpoint_rows.CALM": (1, -1),
    "midpoint_rows.SAME": (1, -1),
    "midpoint_rows.STILL": (1, -1),
    "overlooked_points.DEEP": (1, 0),
    "solvers.iteration.NOTHING": (1, -1),
    "solvers.newton.least_norm.SHARP": (1, -1),
    "tangential_springs.SHALLOW": (1, 0),
}


class Motion(NamedTuple):
    """What is compared of a run, in the units of the plain one."""

    pose: np.ndarray  # (steps, bodies, 13)
    impulse: np.ndarray  # (contacts, 3), without friction (contacts, 1) [N s]
    sweeps: np.ndarray  # (steps,)
    said: str
    rounds: bool  # numbers so near to 0, or to the greatest, that units round them


def modules() -> list[ModuleType]:
    """Return all modules of the engine."""
    package = lavendersim.engine
    names = (one.name for one in pkgutil.walk_packages(package.__path__, f"{package.__name__}."))
    return [importlib.import_module(name) for name in names]


def bring_constants_into(view: View) -> None:
    """Give the engine of this process constants in other units, before any kernel is composed."""
    loaded_ones = modules()
    for name, (length, time) in CONSTANTS.items():
        home, _, constant = name.rpartition(".")
        found = importlib.import_module(f"{lavendersim.engine.__name__}.{home}")
        old = getattr(found, constant)
        for module in loaded_ones:
            if getattr(module, constant, None) is old:  # those that import it, too
                setattr(module, constant, old * view.length**length * view.time**time)


def plan_called(name: str, seed: int) -> Drawn:
    """Return a plan of the fuzz, by its number or its name."""
    chosen = {"joined": JOINED, "accurate": ACCURATE, "full": FULL}
    return chosen[name] if name in chosen else drawn_plans(int(name) + 1, seed)[int(name)]


def has_cavity(plan: Drawn, seed: int, number: int) -> bool:
    """Whether a drawn scene has a bowl or a drum."""
    return "cavity" in drawn(plan, "view", seed, number)["scene"]["bodies"]


def motions(name: str, seed: int, numbers: list[int], view: View | None) -> list[Motion]:
    """Return the runs of drawn scenes; in a view they are run in its units."""
    plan = plan_called(name, seed)
    spec, made = compiled(plan), []
    for number in numbers:
        cell = nudged(loaded(drawn(plan, "view", seed, number))[0].cells()[0].config, APART, 0)
        with np.errstate(over="ignore", invalid="ignore"):
            ended = run(cell if view is None else view.config(cell), spec, cell.steps)
        rows = ended.rows
        names = [name for name in IMPULSES if name in rows.contact.dtype.names]
        impulse = np.stack([rows.contact[name] for name in names], axis=1)
        pose, sweeps = rows.pose.copy(), rows.step["sweeps"].copy()
        if view is not None:
            planes = [body.shape.kind == "plane" for body in cell.scene.bodies.values()]
            pose = view.plain_poses(pose, planes)
            impulse = impulse / (view.length / view.time)
        made.append(Motion(pose, impulse, sweeps, ended.said, rounds(rows)))
    return made


def _in_units(name: str, seed: int, numbers: list[int], view: View) -> list[Motion]:
    bring_constants_into(view)
    return motions(name, seed, numbers, view)


def in_units(name: str, seed: int, numbers: list[int], view: View = UNITS) -> list[Motion]:
    """Return the runs of drawn scenes in other units, by an engine whose constants are in them."""
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, context) as pool:
        return pool.submit(_in_units, name, seed, numbers, view).result()


def difference(one: Motion, other: Motion) -> str:
    """Return what differs of two runs, or nothing."""
    if TIME.sub("", one.said) != TIME.sub("", other.said):
        return f"`{one.said}` and `{other.said}`"
    for what in ("pose", "impulse", "sweeps"):
        here, there = getattr(one, what), getattr(other, what)
        if here.shape != there.shape:
            return f"{what}: {here.shape} and {there.shape} numbers"
        unlike = (here != there) & ~((here != here) & (there != there))
        if unlike.any():
            step = int(np.argwhere(unlike)[0][0])
            return f"{what} in row {step} is off by {abs(here - there)[step].max():.3g}"
    return ""


def main(arguments: list[str]) -> int:
    """Compare as asked for; exit 1 where anything differs."""
    name, seed, first, count = arguments[0], *map(int, arguments[1:4])
    numbers = list(range(first, first + count))
    if "cavity" in arguments[4:]:
        plan = plan_called(name, seed)
        numbers = [number for number in numbers if has_cavity(plan, seed, number)]
    pairs = zip(motions(name, seed, numbers, None), in_units(name, seed, numbers), strict=True)
    compared, differ = 0, 0
    for number, (plain, seen) in zip(numbers, pairs, strict=True):
        if plain.rounds or seen.rounds:
            continue
        compared += 1
        said = difference(plain, seen)
        differ += bool(said)
        if said:
            print(f"{number}: {said}")
    print(f"{compared} of {len(numbers)} runs compared, {differ} differ")
    return int(differ > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
