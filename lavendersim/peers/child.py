"""The process of one run on another engine: builds, checks what was built, steps, sends states.

    python -m lavendersim.peers.child FD

Reads a pickled `Task` from its input and writes messages to the file descriptor, because engines
print where they like. Engines with pools of threads get one thread.
"""

from __future__ import annotations

import json
import pickle
import sys
from importlib import import_module
from multiprocessing.connection import Connection
from time import perf_counter, perf_counter_ns
from typing import Any, Final

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.peers.catalogue import installed_version, peer_of
from lavendersim.peers.declaration import Peer
from lavendersim.peers.description import Scene
from lavendersim.peers.messages import Built, Ended, States, Task
from lavendersim.peers.world import CannotRun

MOST_STEPS: Final = 512  # of a message
SECONDS: Final = 0.5  # between two messages, at the most, but for a step that takes longer
# What an engine reads back of what it was given, relative: numbers of 53 and of 24 bits, each
# through an inverse and a product or two (MuJoCo's text has 17 digits, Rapier keeps 1/m).
ROUNDING: Final = {True: 1e-12, False: 1e-5}
COEFFICIENTS: Final = ("friction", "restitution")  # in the order of `World.mixed`


def run(task: Task, pipe: Connection) -> str:
    """Run a task; returns why it ended early, empty where it did not."""
    peer = peer_of(task.engine)
    scene = Scene(CellConfig.from_dict(json.loads(task.config)))
    begin = perf_counter_ns()
    world = import_module(f"lavendersim.peers.adapters.{peer.name}").World(scene, task.settings)
    if why := misbuilt(scene, world, peer):
        return why
    pipe.send(Built(installed_version(peer.name), perf_counter_ns() - begin))
    reported = len(peer.reports(task.engine))
    poses, speeds = [world.poses()], [world.velocities()]
    rows: list[tuple[float, ...]] = []
    counts = [world.iterations()] if peer.counted else []
    first, spent, pushed, sent = 0, 0, False, perf_counter()
    why = ""
    for step in range(1, scene.steps + 1):
        loads = scene.loads(step)
        if loads is not None or pushed:
            world.push(np.zeros((len(scene.movable), 6)) if loads is None else loads)
        pushed = loads is not None
        start = perf_counter_ns()
        world.step()
        spent += perf_counter_ns() - start
        if peer.bounded and world.is_full():  # it left contacts out: what it did is no step
            why = f"{peer.title} had no room for the contacts of a step ({peer.capacity})"
            break
        poses.append(world.poses())
        speeds.append(world.velocities())
        if peer.counted:
            counts.append(world.iterations())
        if reported:
            rows += [(step, *row) for row in world.contacts()]
        if len(poses) == MOST_STEPS or perf_counter() - sent > SECONDS:
            pipe.send(_states(first, (poses, speeds, rows, counts), spent, reported))
            poses, speeds, rows, counts = [], [], [], []
            first, spent, sent = step + 1, 0, perf_counter()
    if poses:
        pipe.send(_states(first, (poses, speeds, rows, counts), spent, reported))
    return why


def _states(first: int, of_steps: tuple[Any, ...], spent: int, reported: int) -> States:
    poses, speeds, rows, counts = of_steps
    contacts = np.array(rows, dtype=np.float64).reshape(-1, 3 + reported)
    iterations = np.array(counts, dtype=np.int64) if counts else None
    return States(first, np.array(poses), np.array(speeds), contacts, spent, iterations)


def misbuilt(scene: Scene, world: Any, peer: Peer) -> str:
    """Return what the engine has otherwise than it was described; empty where nothing."""
    bodies, inertias = scene.movable, world.inertias()
    required = {
        "mass": ([b.mass for b in bodies], inertias[:, :1]),
        "inertia": ([b.inertia for b in bodies], inertias[:, 1:]),
        "position": ([b.position for b in bodies], world.poses()[:, :3]),
        "orientation": ([b.orientation for b in bodies], world.poses()[:, 3:]),
        "velocity": ([b.velocity for b in bodies], world.velocities()[:, :3]),
        "angular velocity": ([b.spin for b in bodies], world.velocities()[:, 3:]),
    }
    for what, (expected, found) in required.items():
        asked, has = np.array(expected).reshape(len(bodies), -1), np.asarray(found)
        if what == "orientation":  # q and -q are one
            has = has * np.where((has * asked).sum(axis=1, keepdims=True) < 0.0, -1.0, 1.0)
        size = np.abs(asked).max(axis=1, initial=1e-300, keepdims=True)
        off = np.abs(has - asked) > ROUNDING[peer.double] * size
        if off.any():
            k = int(np.argmax(off.any(axis=1)))
            return (
                f"{peer.title} has another {what} of {bodies[k].name}: {has[k].tolist()}, "
                f"expected {asked[k].tolist()}"
            )
    return _mixed_otherwise(scene, world, peer)


def _mixed_otherwise(scene: Scene, world: Any, peer: Peer) -> str:
    """Return which contact the engine gives other coefficients than lavender; empty: none."""
    moves = np.array([body.moves for body in scene.bodies])
    meet = np.triu(moves[:, None] | moves, 1)
    for key, found in zip(COEFFICIENTS, world.mixed(), strict=True):
        if key not in peer.surface_keys:
            continue
        asked = scene.mixed(key)
        off = meet & ~(np.abs(found - asked) <= ROUNDING[peer.double] * asked)  # NaN is off, too
        if off.any():
            a, b = (int(one) for one in np.argwhere(off)[0])
            names = f"{scene.bodies[a].name} and {scene.bodies[b].name}"
            return (
                f"{peer.title} has another {key} between {names}: {found[a, b]:g}, "
                f"expected {asked[a, b]:g}"
            )
    return ""


def main() -> None:
    """Run what the input says."""
    task: Task = pickle.load(sys.stdin.buffer)
    with Connection(int(sys.argv[1])) as pipe:
        try:
            why = run(task, pipe)
        except CannotRun as reason:
            why = f"{peer_of(task.engine).title} cannot run it: {reason}"
        except Exception as error:  # whatever an engine raises is its result
            words = f"{type(error).__name__}: {' '.join(str(error).split())}"
            why = f"{peer_of(task.engine).title} raised {words}"
        pipe.send(Ended(why))


if __name__ == "__main__":
    main()
