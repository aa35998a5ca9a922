"""What each step of any run must balance, by the states before and after it and its contacts.

momentum     m (v_1 - v_0) = (m g + F) dt + sum of impulses, of each body that no drag, no spring
             and no varying force pulls: friction, restitution, cohesion and every solver included;
             where a step says that springs were not found, of none that contacts join to one
penetration  grows in a step by no more than two bodies can move in it, as depth is 1-Lipschitz in
             where bodies stand: |d(x) - d(y)| <= |x - y|; not of stops of joints, whose arm is as
             long as their axis is far, and which a turn by more than half a circle passes by
gap          what pushes touches, or comes to touch by what the two bodies move in the step, or
             would without contacts (Signorini); but for a push as small as the row's residual
energy       does not grow but by what a step's residual and its first order in time leave, where
             nothing but weight gives any (`is_calm`)

A body that a step leaves asleep is out of the first and the third: it loses what speed it has
left. An event that moves a body or takes one away, and a body that wakes in others, begin the
second anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.engine.effects.joint_models import Joint
from lavendersim.engine.engine import Engine, Rows
from lavendersim.engine.impact_rows import FLUSH
from lavendersim.engine.records import PLANE, TOUCHING
from lavendersim.scene.build import Scene

# Impulses add up from thousands of updates, each rounded by 1e-16 of what it is; on their way they
# may be a thousand times what they end with.
ROUND_OFF = 1e-9
# So may a row that ends with none be as large as any other of its step, in some updates; or as
# those of the step before, with which a warm start begins.
TAKEN_BACK = 64.0 * np.finfo(float).eps
# Of separations: faces and rims are found to some 1e-6 of the sizes (`separation.ascend`).
NEAR = 1e-5
END = 4.0  # times as fast as its centre is the end of a rod that is pushed there: 1 + m l^2/I
MOVED = ("teleport", "orientation", "remove")


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
    bound = np.maximum(before.bound, _levers(config))
    flown = [
        np.linalg.norm(s.velocity, axis=2) + bound * np.linalg.norm(s.spin, axis=2)
        for s in (before, after)
    ]
    reach = before.dt[:, None] * (flown[0] + flown[1]) + way + bound * turn
    return Steps(before, after, contact, contact["step"] - 1, reach)


def unbalanced(
    config: CellConfig, rows: Rows, states: list[tuple[Tables, Tables]], whole: int
) -> tuple[list[str], list[str]]:
    """Return every balance that a run breaks, and the laws that it was judged by.

    whole: how many of its steps are finite.
    """
    if whole < 1:
        return [], []
    steps = steps_of(config, rows, states, whole)
    found, judged = _momentum(config, rows, steps) + _gap(config, steps), ["momentum", "gap"]
    if is_calm(config):
        found, judged = found + _energy(config, rows, steps), [*judged, "energy"]
    if not is_anew(config, steps):
        found, judged = found + _penetration(config, rows, steps), [*judged, "penetration"]
    return found, judged


def _impulses(contact: np.ndarray) -> np.ndarray:
    """Return the impulse on B of each contact, cohesion included, (n, 3) [N s]."""
    n = _columns(contact, ("nx", "ny", "nz"))
    one = _columns(contact, ("t1x", "t1y", "t1z"))
    push = contact["impulse_n"] - _columns(contact, ("adhesive_impulse",))[:, 0]
    slide = _columns(contact, ("impulse_t1", "impulse_t2"))
    return n * push[:, None] + one * slide[:, :1] + np.cross(n, one) * slide[:, 1:]


def _gained(steps: Steps) -> np.ndarray:
    """Return the momentum that contacts give each body in each step, (k, n, 3) [N s]."""
    push, gained = _impulses(steps.contact), np.zeros(steps.before.velocity.shape)
    for sign, column in ((-1.0, "body_a"), (1.0, "body_b")):
        np.add.at(gained, (steps.at, steps.contact[column]), sign * push)
    return gained


def _pulled(config: CellConfig) -> list[bool]:
    """Return of each body whether anything pulls it that the balance does not know."""
    drawn = {one.body for one in config.scene.forces if not one.constant_at_centre}
    drawn |= {name for one in config.scene.springs for name in (one.a, one.b)}
    return [name in drawn or any(_drag(body)) for name, body in config.scene.bodies.items()]


def _placed(config: CellConfig, rows: Rows, steps: Steps) -> np.ndarray:
    """Return (k, n) which bodies a step may have placed where springs were not found.

    Such a step says so, and takes velocities from its union (`engine/spring_contacts.py`): bodies
    that contacts join to one with a spring.
    """
    names = [*config.scene.bodies]
    sprung = {names.index(name) for one in config.scene.springs for name in (one.a, one.b)}
    placed = np.zeros(steps.before.mass.shape, dtype=bool)
    # Plans without contacts at the middle have no unions: their springs act on free bodies.
    if not sprung or "spring_not_converged" not in (rows.step.dtype.names or ()):
        return placed
    missed = rows.step["spring_not_converged"][1 : len(placed) + 1] > 0
    for step in np.flatnonzero(missed):
        own = steps.contact[steps.at == step]
        union = set(sprung)
        while True:
            beside = {int(k) for a, b in zip(own["body_a"], own["body_b"], strict=True)
                      if a in union or b in union for k in (a, b)}  # fmt: skip
            if beside <= union:
                break
            union |= beside
        placed[step, [*union]] = True
    return placed


def _drag(body: Any) -> tuple[float, ...]:
    drag = body.drag
    return (drag.linear, drag.quadratic, drag.angular) if drag is not None else ()


def _momentum(config: CellConfig, rows: Rows, steps: Steps) -> list[str]:
    before, after, contact = steps.before, steps.after, steps.contact
    push, gained, size = _impulses(contact), _gained(steps), np.zeros(before.mass.shape)
    for column in ("body_a", "body_b"):
        place = (steps.at, contact[column])
        np.add.at(size, place, np.abs(push).sum(axis=1) + np.abs(contact["impulse_n"]))
    weight = before.mass[..., None] * before.gravity[:, None] + before.force
    weight *= before.dt[:, None, None]
    change = before.mass[..., None] * (after.velocity - before.velocity)
    size += np.abs(weight).sum(axis=2)
    size += before.mass * (np.abs(after.velocity) + np.abs(before.velocity)).sum(axis=2)
    free = (before.mass > 0.0) & (before.asleep == 0) & (after.asleep == 0)
    free &= ~np.array(_pulled(config)) & ~_placed(config, rows, steps)
    miss = np.linalg.norm(change - weight - gained, axis=2)
    largest = np.zeros(len(before.dt))
    np.maximum.at(largest, steps.at, np.abs(push).sum(axis=1))
    if config.numerics.warm_start:
        largest[1:] = np.maximum(largest[1:], largest[:-1])
    wrong = free & ~(miss <= ROUND_OFF * size + TAKEN_BACK * largest[:, None])
    if not wrong.any():
        return []
    step = int(np.argmax(wrong.any(axis=1)))
    k = int(np.argmax(np.where(wrong[step], miss[step] / size[step], 0.0)))
    said = f"{miss[step, k]:.3g} of {size[step, k]:.3g} N s in step {step + 1}"
    return [f"momentum: {[*config.scene.bodies][k]} is off by {said}"]


def is_calm(config: CellConfig) -> bool:
    """Whether nothing but weight can give energy to the bodies of a scene."""
    scene, numerics = config.scene, config.numerics
    if scene.forces or scene.springs or config.events or config.triggered:
        return False
    if numerics.stabilisation_gain > 0.0 or numerics.projection > 0.0:
        return False
    for one in scene.connections.values():
        # What steps that are not centred leave of joints is projected back, at whatever height.
        joined = isinstance(one, Joint) and numerics.integrator != "midpoint_contact"
        if joined or getattr(one, "motor", None) or getattr(one, "restitution", 0.0) > 0.0:
            return False
    return not any(
        body.kinematic
        or any(body.surface_velocity)
        or body.surface.cohesion > 0.0
        or body.surface.compliance > 0.0
        or body.surface.restitution > 0.0
        or body.surface.tangential_restitution > 0.0
        for body in scene.bodies.values()
    )


def _energy(config: CellConfig, rows: Rows, steps: Steps) -> list[str]:
    """A row that misses its law by r [m/s] gives at most r times its impulse, or its momentum.

    What contacts carry falls another way than by the mean of its velocities, by up to
    |dv| dt + g dt^2/2; see `tests/property/test_zoo_energy.py`.
    """
    before, after = steps.before, steps.after
    count = len(before.dt)
    pull = float(np.linalg.norm(config.scene.gravity))
    kinetic = rows.step["kinetic_energy"][: count + 1]
    potential = rows.step["potential_energy"][: count + 1]
    flown = np.linalg.norm(before.velocity, axis=2) + np.linalg.norm(after.velocity, axis=2)
    turned = np.linalg.norm(before.spin, axis=2) + np.linalg.norm(after.spin, axis=2)
    momenta = (before.mass * (flown + before.bound * turned)).sum(axis=1)
    size = np.abs(_impulses(steps.contact)).sum(axis=1)
    pushes = np.bincount(steps.at, weights=size, minlength=count)
    jumps = np.linalg.norm(after.velocity - before.velocity, axis=2)
    way = before.dt[:, None] * (jumps + pull * before.dt[:, None])
    allowed = rows.step["residual"][1 : count + 1] * (pushes + momenta)
    allowed += pull * (before.mass * way).sum(axis=1)
    at_play = kinetic[:-1] + np.abs(potential[1:]) + np.abs(potential[:-1])
    gained = np.diff(kinetic + potential)
    wrong = gained > allowed + ROUND_OFF * at_play
    if not wrong.any():
        return []
    k = int(np.argmax(wrong))
    said = f"{gained[k]:.3g} J in step {k + 1}, of at most {allowed[k]:.3g} J"
    return [f"energy: gained {said}; {kinetic[k]:.3g} J before"]


def _pair_reach(rows: Rows, steps: Steps) -> np.ndarray:
    """Return by how much two bodies may come nearer in each step [m].

    In one of several parts what is pushed may be thrown back before it ends.
    """
    mass, contact, own = steps.before.mass, steps.contact, steps.reach
    if "parts" in (rows.step.dtype.names or ()):
        thrown = np.zeros(mass.shape)
        size = np.linalg.norm(_impulses(contact), axis=1)
        for column in ("body_a", "body_b"):
            np.add.at(thrown, (steps.at, contact[column]), size)
        thrown[rows.step["parts"][1 : len(mass) + 1] < 2] = 0.0
        with np.errstate(divide="ignore", invalid="ignore"):
            way = np.where(mass > 0.0, END * thrown / mass * steps.before.dt[:, None], 0.0)
        own = own + way
    reach: np.ndarray = np.sort(own, axis=1)[:, -2:].sum(axis=1)
    return reach


def _driven(config: CellConfig, steps: Steps) -> np.ndarray:
    """Return how far forces alone carry each body in each step (k, n) [m].

    What springs, drag and functions of time add is what momentum leaves beside contacts.
    """
    before, after = steps.before, steps.after
    change = before.gravity[:, None] * np.ones_like(before.velocity)
    with np.errstate(divide="ignore", invalid="ignore"):
        change += np.where(before.mass[..., None] > 0.0, before.force / before.mass[..., None], 0.0)
        change *= before.dt[:, None, None]
        gained = after.velocity - before.velocity
        gained -= np.where(
            before.mass[..., None] > 0.0, _gained(steps) / before.mass[..., None], 0.0
        )
    change = np.where(np.array(_pulled(config))[:, None], gained, change)
    way: np.ndarray = before.dt[:, None] * np.linalg.norm(change, axis=2)
    return np.where(before.mass > 0.0, way, 0.0)


def _gap(config: CellConfig, steps: Steps) -> list[str]:
    """Signorini's law: what pushes touches before, in or after the step. Ropes and joints pull.

    A row looks ahead from the velocities that forces leave, before contacts: what a stiff spring
    pulls may be held where it is. min(k lambda_n, w_n) is at most a row's residual r: what has a
    larger push comes as near as it should, but for r dt. Under the convex cone what slides opens
    with w_n = mu |w_t| (`solvers.row_update`): it is pushed so far from where it slides.
    """
    rows = steps.contact
    pushes = rows["impulse_n"] * rows["inverse_effective_mass"] > (1.0 + NEAR) * rows["residual"]
    for body in ("body_a", "body_b"):  # of what a step leaves asleep its velocities are not known
        pushes &= steps.after.asleep[steps.at, rows[body]] == 0
    for name in ("rope", "joint"):
        if name in (rows.dtype.names or ()):
            pushes &= rows[name] == 0
    near = NEAR * steps.before.bound.max(axis=1) + TOUCHING
    reach = steps.reach + _driven(config, steps)
    allowed = reach[steps.at, rows["body_a"]] + reach[steps.at, rows["body_b"]] + near[steps.at]
    allowed += rows["residual"] * steps.before.dt[steps.at]
    if config.numerics.friction_cone == "convex" and "slip_t1" in (rows.dtype.names or ()):
        allowed += _opening(rows) * steps.before.dt[steps.at]
    wrong = pushes & (rows["separation"] > allowed)
    if not wrong.any():
        return []
    k = int(np.argmax(wrong))
    said = f"{rows['separation'][k]:.3g} m in step {rows['step'][k]}, of at most {allowed[k]:.3g} m"
    return [f"gap: a push across {said}"]


def _opening(rows: np.ndarray) -> np.ndarray:
    """Return mu |w_t| of each contact, of one with a grain |F w_t| [m/s]."""
    one, two = rows["slip_t1"], rows["slip_t2"]
    opening: np.ndarray = rows["friction"] * np.hypot(one, two)
    if "friction_11" in (rows.dtype.names or ()):
        along = rows["friction_11"] * one + rows["friction_12"] * two
        across = rows["friction_12"] * one + rows["friction_22"] * two
        opening = np.maximum(opening, np.hypot(along, across))
    return opening


def is_anew(config: CellConfig, steps: Steps) -> bool:
    """Whether what is deepest may be another than before though nothing moved there."""
    events = (*config.events, *(one.event for one in config.triggered))
    moved = any(getattr(event, key, None) for event in events for key in MOVED)
    return moved or bool(steps.before.asleep.any())


def _penetration(config: CellConfig, rows: Rows, steps: Steps) -> list[str]:
    """What was passed over as flush, which is no contact, is as deep as that at most."""
    count, reach = len(steps.before.dt), _pair_reach(rows, steps)
    flush = FLUSH * config.numerics.slop + TOUCHING
    deepest = rows.step["max_penetration"][1 : count + 1]
    if "joint" in (steps.contact.dtype.names or ()):
        stops, others = np.zeros(count), np.zeros(count)
        joint = steps.contact["joint"] > 0
        for depth, own in ((stops, joint), (others, ~joint)):
            np.maximum.at(depth, steps.at[own], steps.contact["penetration"][own])
        deepest = np.where(deepest > stops, deepest, others)
    allowed = np.full(count, np.inf)  # of what overlaps as it begins nothing is said
    allowed[1:] = np.maximum(deepest[:-1], flush) + reach[1:] + reach[:-1]
    allowed += NEAR * steps.before.bound.max(axis=1)
    wrong = deepest > allowed
    if not wrong.any():
        return []
    k = int(np.argmax(wrong))
    return [f"penetration: {deepest[k]:.4g} m in step {k + 1}, of at most {allowed[k]:.4g} m"]
