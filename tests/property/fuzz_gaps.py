"""What pushes touches, and nothing gets deeper than it moves: the laws of `gap` and `penetration`.

See `fuzz_balances`. Distances of surfaces, by what forces and impulses let two bodies move.
"""

from __future__ import annotations

import numpy as np
from fuzz_steps import Steps, gained_by_contacts, impulses_of, pulled

from lavendersim.cell import CellConfig
from lavendersim.engine.contact_spring_law import FLATTEST
from lavendersim.engine.effects.time_functions import terms_of
from lavendersim.engine.engine import Rows
from lavendersim.engine.impact_rows import FLUSH
from lavendersim.engine.records import TOUCHING

# Of separations: faces and rims are found to some 1e-6 of the sizes (`separation.ascend`).
NEAR = 1e-5
END = 4.0  # times as fast as its centre is the end of a rod that is pushed there: 1 + m l^2/I
MOVED = ("teleport", "orientation", "remove")


def _pair_reach(rows: Rows, steps: Steps) -> np.ndarray:
    """Return by how much two bodies may come nearer in each step [m].

    In one of several parts what is pushed may be thrown back before it ends.
    """
    mass, contact, own = steps.before.mass, steps.contact, steps.reach
    if "parts" in (rows.step.dtype.names or ()):
        thrown = np.zeros(mass.shape)
        size = np.linalg.norm(impulses_of(contact), axis=1)
        for column in ("body_a", "body_b"):
            np.add.at(thrown, (steps.at, contact[column]), size)
        thrown[rows.step["parts"][1 : len(mass) + 1] < 2] = 0.0
        with np.errstate(divide="ignore", invalid="ignore"):
            way = np.where(mass > 0.0, END * thrown / mass * steps.before.dt[:, None], 0.0)
        own = own + way
    reach: np.ndarray = np.sort(own, axis=1)[:, -2:].sum(axis=1)
    return reach


def _driven(config: CellConfig, steps: Steps) -> np.ndarray:
    """Return how far forces alone carry a point of each body in each step (k, n) [m].

    What springs, drag and functions of time add is what momentum leaves beside contacts.
    """
    before, after = steps.before, steps.after
    change = before.gravity[:, None] * np.ones_like(before.velocity)
    with np.errstate(divide="ignore", invalid="ignore"):
        change += np.where(before.mass[..., None] > 0.0, before.force / before.mass[..., None], 0.0)
        change *= before.dt[:, None, None]
        gained = after.velocity - before.velocity
        gained -= np.where(
            before.mass[..., None] > 0.0, gained_by_contacts(steps) / before.mass[..., None], 0.0
        )
    change = np.where(np.array(pulled(config))[:, None], gained, change)
    speed = np.linalg.norm(change, axis=2)
    with np.errstate(divide="ignore", invalid="ignore"):
        speed += before.dt[:, None] * before.bound * _twisted(config) / before.mass
    return np.where(before.mass > 0.0, before.dt[:, None] * speed, 0.0)


def _twisted(config: CellConfig) -> np.ndarray:
    """Return the largest torque on each body, times its mass by its least moment of inertia (n,).

    [N m kg/(kg m^2)]; an event that scales a mass scales both.
    """
    names, most = [*config.scene.bodies], np.zeros(len(config.scene.bodies))
    for one in config.scene.forces:
        point = np.linalg.norm(getattr(one, "point", None) or (0.0, 0.0, 0.0))
        terms, size = terms_of(one.factor), 1.0
        if one.factor is not None:
            last, value = terms.knots[-1]
            ends = value + terms.slope * max(config.duration - last, 0.0)
            size = max(abs(ends), *(abs(knot[1]) for knot in terms.knots)) + abs(terms.amplitude)
        torque = np.linalg.norm(one.torque) + point * np.linalg.norm(one.force)
        body = config.scene.bodies[one.body]
        most[names.index(one.body)] += size * torque * body.mass / min(body.inertia)
    return most


def pushes_across_gaps(config: CellConfig, steps: Steps) -> list[str]:
    """Signorini's law: what pushes touches before, in or after the step. Ropes and joints pull.

    A row looks ahead from the velocities that forces leave, before contacts: what a stiff spring
    pulls, or a torque turns, may be held where it is. min(k lambda_n, w_n) is at most a row's
    residual r: what has a larger push comes as near as it should, but for r dt. Under the convex
    cone what slides opens with w_n = mu |w_t| (`solvers.row_update`): it is pushed so far from
    where it slides. A contact spring that is open has a tangent of FLATTEST
    (`contact_spring_law`): it pushes by that share of what its last solve was off by.
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
    if "gamma" in (rows.dtype.names or ()):
        flat = rows["gamma"] * FLATTEST > (1.0 - NEAR) * rows["inverse_effective_mass"]
        pushes &= ~flat
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


def _deepest_but(these: np.ndarray, deepest: np.ndarray, steps: Steps) -> np.ndarray:
    """Return the depth of each step (k,) [m], of others where it may be that of these rows."""
    depths = np.zeros((2, len(deepest)))
    for depth, own in zip(depths, (these, ~these), strict=True):
        np.maximum.at(depth, steps.at[own], steps.contact["penetration"][own])
    return np.where(deepest > depths[0], deepest, depths[1])


def _came_before_a_face(config: CellConfig, steps: Steps) -> np.ndarray:
    """Return which rows may be of a body whose centre was behind a mesh's face, and is no longer.

    Behind it does not touch; before it, it is as deep as it reaches at most. No way of it tells.
    """
    mesh = np.array([body.shape.kind == "mesh" for body in config.scene.bodies.values()])
    rows = steps.contact
    a, b = rows["body_a"], rows["body_b"]
    reach = steps.before.bound[steps.at, np.where(mesh[a], b, a)]
    found: np.ndarray = (mesh[a] | mesh[b]) & (rows["penetration"] <= (1.0 + NEAR) * reach)
    return found


def deeper_than_moved(config: CellConfig, rows: Rows, steps: Steps) -> list[str]:
    """What was passed over as flush, which is no contact, is as deep as that at most."""
    count, reach = len(steps.before.dt), _pair_reach(rows, steps)
    flush = FLUSH * config.numerics.slop + TOUCHING
    deepest = rows.step["max_penetration"][1 : count + 1]
    if "joint" in (steps.contact.dtype.names or ()):
        deepest = _deepest_but(steps.contact["joint"] > 0, deepest, steps)
    allowed = np.full(count, np.inf)  # of what overlaps as it begins nothing is said
    allowed[1:] = np.maximum(deepest[:-1], flush) + reach[1:] + reach[:-1]
    allowed += NEAR * steps.before.bound.max(axis=1)
    came_before = _came_before_a_face(config, steps)
    if came_before.any():
        deepest = _deepest_but(came_before, deepest, steps)
    wrong = deepest > allowed
    if not wrong.any():
        return []
    k = int(np.argmax(wrong))
    return [f"penetration: {deepest[k]:.4g} m in step {k + 1}, of at most {allowed[k]:.4g} m"]
