"""A run step by step, as the laws of `fuzz_balances` and `fuzz_gaps` read it.

States before and after each step, contacts with their steps, how far each body's points moved, and
what contacts gave.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.engine.engine import Engine, Rows
from lavendersim.engine.records import PLANE
from lavendersim.scene.build import Scene

LAST_DIGITS = 4.0 * np.finfo(float).eps  # of a number, in some sums and differences [-]


class State(NamedTuple):
    """All bodies before, or after, each step: k steps, n bodies."""

    mass: np.ndarray  # (k, n) [kg], 0 where nothing moves it
    asleep: np.ndarray  # (k, n)
    velocity: np.ndarray  # (k, n, 3) [m/s]
    spin: np.ndarray  # (k, n, 3) [rad/s]
    force: np.ndarray  # (k, n, 3) [N], constant in this step
    gravity: np.ndarray  # (k, 3) [m/s^2]
    bound: np.ndarray  # (k, n) [m], of a plane 0
    dt: np.ndarray  # (k,) [s]


Tables = tuple[np.ndarray, np.ndarray, np.ndarray]  # bodies, velocities, parameters


def _columns(table: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    return np.stack([
        table[name] if name in (table.dtype.names or ()) else np.zeros(table.shape)
        for name in names
    ], axis=-1)  # fmt: skip


def tables_of(engine: Engine, scene: Scene) -> Tables:
    """Copy what the laws need of a state."""
    count = len(scene.names)
    bodies, velocities = engine.bodies[:count].copy(), engine.velocities[:count].copy()
    return bodies, velocities, engine.parameters.copy()


def joined(tables: Sequence[np.ndarray]) -> np.ndarray:
    """Return tables of the same columns one behind the other: numpy compares columns for each."""
    first = tables[0]
    data = bytearray().join(table.tobytes() for table in tables)
    return np.frombuffer(data, first.dtype).reshape(-1, *first.shape[1:])


def state_of(states: list[Tables]) -> State:
    """Return the states of as many steps, for the laws."""
    bodies, velocities, parameters = (
        joined([table[None] for table in tables]) for tables in zip(*states, strict=True)
    )
    own = bodies["own_inv_m"] if "own_inv_m" in (bodies.dtype.names or ()) else bodies["inv_m"]
    inverse = np.where(bodies["inv_m"] > 0.0, bodies["inv_m"], own)
    with np.errstate(divide="ignore"):
        mass = np.where(inverse > 0.0, 1.0 / inverse, 0.0)
    return State(
        mass,
        _columns(bodies, ("asleep",))[..., 0],
        _columns(velocities, ("vx", "vy", "vz")),
        _columns(velocities, ("wx", "wy", "wz")),
        _columns(bodies, ("fx", "fy", "fz")),
        _columns(parameters, ("gx", "gy", "gz"))[:, 0],
        np.where(bodies["shape"] == PLANE, 0.0, bodies["bound"]),
        parameters["dt"][:, 0],
    )


class Steps(NamedTuple):
    """A run step by step: its states, and rows of contacts with the place of each one's step."""

    before: State
    after: State
    contact: np.ndarray
    at: np.ndarray  # row of its step among the states, for each contact
    reach: np.ndarray  # (k, n) [m] no point of a body is farther from where it was a step before


def _levers(config: CellConfig) -> np.ndarray:
    """Return how far from each body's centre ropes are tied to it [m]: farther than it reaches."""
    names = [*config.scene.bodies]
    levers = np.zeros(len(names))
    for one in config.scene.connections.values():
        for name, point in zip(one.between, getattr(one, "points", None) or (), strict=False):
            k = names.index(name)
            levers[k] = max(levers[k], float(np.linalg.norm(point)))
    return levers


def steps_of(
    config: CellConfig, rows: Rows, states: list[tuple[Tables, Tables]], whole: int
) -> Steps:
    """Return the first `whole` steps of a run."""
    before, after = (state_of(list(tables)) for tables in zip(*states[:whole], strict=True))
    contact = rows.contact[(rows.contact["step"] >= 1) & (rows.contact["step"] <= whole)]
    poses = rows.pose[: whole + 1]
    way = np.linalg.norm(np.diff(poses[:, :, :3], axis=0), axis=2)
    cosine = np.abs((poses[1:, :, 3:7] * poses[:-1, :, 3:7]).sum(axis=2))
    turn = 2.0 * np.arccos(np.minimum(cosine, 1.0))
    # Arms are differences of places of the world, with the last digits of what is far away.
    far = np.abs(poses[:-1, :, :3]).max(axis=(1, 2))[:, None]
    bound = np.maximum(before.bound, _levers(config)) + LAST_DIGITS * far
    flown = [
        np.linalg.norm(s.velocity, axis=2) + bound * np.linalg.norm(s.spin, axis=2)
        for s in (before, after)
    ]
    reach = before.dt[:, None] * (flown[0] + flown[1]) + way + bound * turn
    return Steps(before, after, contact, contact["step"] - 1, reach)


def impulses_of(contact: np.ndarray) -> np.ndarray:
    """Return the impulse on B of each contact, cohesion included, (n, 3) [N s]."""
    n = _columns(contact, ("nx", "ny", "nz"))
    one = _columns(contact, ("t1x", "t1y", "t1z"))
    push = contact["impulse_n"] - _columns(contact, ("adhesive_impulse",))[:, 0]
    slide = _columns(contact, ("impulse_t1", "impulse_t2"))
    return n * push[:, None] + one * slide[:, :1] + np.cross(n, one) * slide[:, 1:]


def gained_by_contacts(steps: Steps) -> np.ndarray:
    """Return the momentum that contacts give each body in each step, (k, n, 3) [N s]."""
    push, gained = impulses_of(steps.contact), np.zeros(steps.before.velocity.shape)
    for sign, column in ((-1.0, "body_a"), (1.0, "body_b")):
        np.add.at(gained, (steps.at, steps.contact[column]), sign * push)
    return gained


def pulled(config: CellConfig) -> list[bool]:
    """Return of each body whether anything pulls it that the balance does not know."""
    drawn = {one.body for one in config.scene.forces if not one.constant_at_centre}
    drawn |= {name for one in config.scene.springs for name in (one.a, one.b)}
    return [name in drawn or any(_drag(body)) for name, body in config.scene.bodies.items()]


def _drag(body: Any) -> tuple[float, ...]:
    drag = body.drag
    return (drag.linear, drag.quadratic, drag.angular) if drag is not None else ()
