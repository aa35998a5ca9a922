"""What each step of any run must balance, by the states before and after it and its contacts.

momentum     m (v_1 - v_0) = (m g + F) dt + sum of impulses, of each body that no drag, no spring
             and no varying force pulls: friction, restitution, cohesion and every solver included
penetration  grows in a step by no more than two bodies can move in it, as depth is 1-Lipschitz in
             where bodies stand: |d(x) - d(y)| <= |x - y|
energy       does not grow but by what a step's residual and its first order in time leave, where
             nothing but weight gives any (`is_calm`)

A body that a step leaves asleep is out of the first: it loses what speed it has left. An event that
moves a body or takes one away, and a body that wakes in others, begin the second anew.
"""

from __future__ import annotations

import itertools
from typing import Any, NamedTuple

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.engine.engine import Engine, Rows
from lavendersim.engine.records import PLANE
from lavendersim.scene.build import Scene

# Impulses add up from thousands of updates, each rounded by 1e-16 of what it is; on their way they
# may be a thousand times what they end with.
ROUND_OFF = 1e-9
# Of separations: faces and rims are found to some 1e-6 of the sizes (`separation.ascend`).
NEAR = 1e-5
MOVED = ("teleport", "orientation", "remove")


class State(NamedTuple):
    """All bodies between two steps."""

    mass: np.ndarray  # [kg], 0 where nothing moves it
    asleep: np.ndarray
    velocity: np.ndarray  # (n, 3) [m/s]
    spin: np.ndarray  # (n, 3) [rad/s]
    force: np.ndarray  # (n, 3) [N], constant in this step
    gravity: np.ndarray  # (3,) [m/s^2]
    bound: np.ndarray  # [m]
    dt: float  # [s]


def _columns(table: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    return np.column_stack([
        table[name] if name in (table.dtype.names or ()) else np.zeros(len(table))
        for name in names
    ])  # fmt: skip


def state_of(engine: Engine, scene: Scene) -> State:
    """Copy what the laws need of a state."""
    bodies = engine.bodies[: len(scene.names)]
    velocities = engine.velocities[: len(scene.names)]
    own = bodies["own_inv_m"] if "own_inv_m" in (bodies.dtype.names or ()) else bodies["inv_m"]
    inverse = np.where(bodies["inv_m"] > 0.0, bodies["inv_m"], own)
    with np.errstate(divide="ignore"):
        mass = np.where(inverse > 0.0, 1.0 / inverse, 0.0)
    asleep = _columns(bodies, ("asleep",))[:, 0]
    return State(
        mass,
        asleep,
        _columns(velocities, ("vx", "vy", "vz")),
        _columns(velocities, ("wx", "wy", "wz")),
        _columns(bodies, ("fx", "fy", "fz")),
        _columns(engine.parameters, ("gx", "gy", "gz"))[0],
        np.where(bodies["shape"] == PLANE, 0.0, bodies["bound"]),  # of a plane none
        float(engine.parameters["dt"][0]),
    )


def unbalanced(
    config: CellConfig, rows: Rows, states: list[tuple[State, State]], whole: int
) -> list[str]:
    """Return every balance that a run breaks; whole: how many of its steps are finite."""
    contacts = _by_step(rows.contact, len(states))
    found = _momentum(config, contacts, states[:whole])
    if is_calm(config):
        found += _energy(config, rows, contacts, states[:whole])
    return found + _penetration(config, rows, states[:whole])


def _by_step(contact: np.ndarray, steps: int) -> list[np.ndarray]:
    """Return the contacts of each step, from the first on."""
    edges = np.searchsorted(contact["step"], np.arange(1, steps + 2))
    return [contact[a:b] for a, b in itertools.pairwise(edges)]


def _impulses(contact: np.ndarray) -> np.ndarray:
    """Return the impulse on B of each contact, cohesion included, (n, 3) [N s]."""
    n = _columns(contact, ("nx", "ny", "nz"))
    one = _columns(contact, ("t1x", "t1y", "t1z"))
    push = contact["impulse_n"] - _columns(contact, ("adhesive_impulse",))[:, 0]
    slide = _columns(contact, ("impulse_t1", "impulse_t2"))
    return n * push[:, None] + one * slide[:, :1] + np.cross(n, one) * slide[:, 1:]


def _pulled(config: CellConfig) -> list[bool]:
    """Return of each body whether anything pulls it that the balance does not know."""
    drawn = {one.body for one in config.scene.forces if not one.constant_at_centre}
    drawn |= {name for one in config.scene.springs for name in (one.a, one.b)}
    return [name in drawn or any(_drag(body)) for name, body in config.scene.bodies.items()]


def _drag(body: Any) -> tuple[float, ...]:
    drag = body.drag
    return (drag.linear, drag.quadratic, drag.angular) if drag is not None else ()


def _momentum(config: CellConfig, contacts: list[np.ndarray], states: Any) -> list[str]:
    names = [*config.scene.bodies]
    pulled = np.array(_pulled(config))
    for number, ((before, after), rows) in enumerate(zip(states, contacts, strict=False), start=1):
        push = _impulses(rows)
        gained, size = np.zeros((len(names), 3)), np.zeros(len(names))
        for sign, column in ((-1.0, "body_a"), (1.0, "body_b")):
            np.add.at(gained, rows[column], sign * push)
            np.add.at(size, rows[column], np.abs(push).sum(axis=1) + np.abs(rows["impulse_n"]))
        weight = (before.mass[:, None] * before.gravity + before.force) * before.dt
        change = before.mass[:, None] * (after.velocity - before.velocity)
        size += np.abs(weight).sum(axis=1)
        size += before.mass * (np.abs(after.velocity) + np.abs(before.velocity)).sum(axis=1)
        free = (before.mass > 0.0) & (before.asleep == 0) & (after.asleep == 0) & ~pulled
        miss = np.linalg.norm(change - weight - gained, axis=1)
        wrong = free & ~(miss <= ROUND_OFF * size)
        if wrong.any():
            k = int(np.argmax(np.where(wrong, miss / size, 0.0)))
            said = f"{miss[k]:.3g} of {size[k]:.3g} N s in step {number}"
            return [f"momentum: {names[k]} is off by {said}"]
    return []


def is_calm(config: CellConfig) -> bool:
    """Whether nothing but weight can give energy to the bodies of a scene."""
    scene, numerics = config.scene, config.numerics
    if scene.forces or scene.springs or config.events or config.triggered:
        return False
    if numerics.stabilisation_gain > 0.0 or numerics.projection > 0.0:
        return False
    if any(rope.restitution > 0.0 for rope in scene.connections.values()):
        return False
    return not any(
        body.kinematic
        or any(body.surface_velocity)
        or body.surface.cohesion > 0.0
        or body.surface.compliance > 0.0
        or body.surface.restitution > 0.0
        for body in scene.bodies.values()
    )


def _energy(config: CellConfig, rows: Rows, contacts: list[np.ndarray], states: Any) -> list[str]:
    """A row that misses its law by r [m/s] gives at most r times its impulse, or its momentum.

    What contacts carry falls another way than by the mean of its velocities, by up to
    |dv| dt + g dt^2/2; see `tests/property/test_zoo_energy.py`.
    """
    pull = float(np.linalg.norm(config.scene.gravity))
    kinetic, potential = rows.step["kinetic_energy"], rows.step["potential_energy"]
    total = kinetic + potential
    for number, ((before, after), found) in enumerate(zip(states, contacts, strict=False), start=1):
        flown = np.linalg.norm(before.velocity, axis=1) + np.linalg.norm(after.velocity, axis=1)
        turned = np.linalg.norm(before.spin, axis=1) + np.linalg.norm(after.spin, axis=1)
        momenta = float((before.mass * (flown + before.bound * turned)).sum())
        pushes = float(np.abs(_impulses(found)).sum())
        jumps = np.linalg.norm(after.velocity - before.velocity, axis=1)
        way = before.dt * (jumps + pull * before.dt)
        allowed = float(rows.step["residual"][number]) * (pushes + momenta)
        allowed += pull * float((before.mass * way).sum())
        at_play = kinetic[number - 1] + abs(potential[number]) + abs(potential[number - 1])
        gained = total[number] - total[number - 1]
        if gained > allowed + ROUND_OFF * at_play:
            said = f"{gained:.3g} J in step {number}, of at most {allowed:.3g} J"
            return [f"energy: gained {said}; {kinetic[number - 1]:.3g} J before"]
    return []


def _penetration(config: CellConfig, rows: Rows, states: Any) -> list[str]:
    deepest, poses = rows.step["max_penetration"], rows.pose
    events = (*config.events, *(one.event for one in config.triggered))
    anew = any(getattr(event, key, None) for event in events for key in MOVED)
    if anew or any(before.asleep.any() for before, _ in states):
        return []
    most, reach_before = np.inf, 0.0
    for number, (before, after) in enumerate(states, start=1):
        flown = [
            np.linalg.norm(s.velocity, axis=1) + s.bound * np.linalg.norm(s.spin, axis=1)
            for s in (before, after)
        ]
        way = np.linalg.norm(poses[number, :, :3] - poses[number - 1, :, :3], axis=1)
        cosine = np.abs((poses[number, :, 3:7] * poses[number - 1, :, 3:7]).sum(axis=1))
        turn = 2.0 * np.arccos(np.minimum(cosine, 1.0))
        moved = before.dt * (flown[0] + flown[1]) + way + before.bound * turn
        reach = float(np.sort(moved)[-2:].sum())
        allowed = most + reach + reach_before + NEAR * float(before.bound.max())
        if deepest[number] > allowed:
            said = f"{deepest[number]:.4g} m in step {number}, of at most {allowed:.4g} m"
            return [f"penetration: {said}"]
        most = max(float(deepest[number]), 0.0 if most == np.inf else most)
        reach_before = reach
    return []
