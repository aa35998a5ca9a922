"""What constant forces and events of a config put into each step of its log: work, energy, mass.

Arrays have one entry per logged step; entry k belongs to the step that ends in state k, entry 0 to
none. Forces and events act before the first step that starts at their time or later.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from lavendersim.cell import CellForce, changes_of_bodies, changes_of_gravity
from lavendersim.errors import UsageError
from lavendersim.geometry.bodies import is_movable, mass_of, principal_inertia, vector
from lavendersim.geometry.rotations import turns_between
from lavendersim.measures import shares
from lavendersim.measures.interfaces import Floats, Trace
from lavendersim.quantities.scalars import exact


def first_starting_at(trace: Trace, time: float) -> int:
    """Return the row of the first step that starts at a time [s] as written, or later."""
    done = trace.clock.steps_until(exact(time))
    return int(np.searchsorted(trace.step["step"], done + 1))


def removals(trace: Trace) -> dict[str, int]:
    """Return the row of the first step without it, for each body that is removed."""
    gone = [event for event in changes_of_bodies(trace.events) if event.remove]
    return {event.body: first_starting_at(trace, event.at) for event in gone}


def masses(trace: Trace) -> Floats:
    """Return the mass of everything movable [kg] in each state."""
    movable = _movable_masses(trace.config.scene)
    total = np.full(len(trace.step), sum(movable.values()))
    for event in changes_of_bodies(trace.events):
        scale = 0.0 if event.remove else event.scale_mass
        if scale is not None and event.body in movable:
            before = movable[event.body]
            movable[event.body] = before * scale
            total[first_starting_at(trace, event.at) :] += movable[event.body] - before
    return total


_last_masses: tuple[Any, dict[str, float]] = (None, {})


def _movable_masses(scene: Any) -> dict[str, float]:
    """Return the mass of each movable body as configured [kg].

    Of the scene that was asked for last it is kept: a run asks twice for every block of its steps,
    and to look at two hundred bodies takes as long as all its checks.
    """
    global _last_masses
    of, known = _last_masses
    if of is not scene:
        bodies = scene.bodies.items()
        known = {name: mass_of(body) for name, body in bodies if is_movable(body)}
        _last_masses = scene, known
    return dict(known)


def gravity(trace: Trace) -> Floats:
    """Return gravity [m/s^2] in each step (n, 3)."""
    pull = np.tile(vector(trace.config.scene.gravity), (len(trace.step), 1))
    for event in changes_of_gravity(trace.events):
        pull[first_starting_at(trace, event.at) :] = event.gravity
    return pull


def strength_of_gravity(trace: Trace) -> Floats | float:
    """Return |g| [m/s^2], in each step (n,) where events change it."""
    if changes_of_gravity(trace.events):
        strength: Floats = np.sqrt((gravity(trace) ** 2).sum(axis=1))
        return strength
    return math.hypot(*trace.config.scene.gravity)


def constant_gravity(trace: Trace, measure: str, first: int = 0) -> Floats:
    """Return gravity [m/s^2] (3,) in the steps from a row on; UsageError where it changes.

    measure: what needs it, in words.
    """
    different = {one.tobytes(): one for one in gravity(trace)[first:]}
    if len(different) > 1:
        begin, end = (float(trace.step["time"][row]) for row in (first, -1))
        raise UsageError(
            f"{measure} takes one gravity, and an event changes it from {begin:.9g} to {end:.9g} s"
        )
    return next(iter(different.values()))


def forces(trace: Trace) -> Floats:
    """Return the sum of the constant forces of the config [N] in each step (n, 3).

    Where events change gravity, the change of the weight of everything movable is one of them.
    """
    total = np.zeros((len(trace.step), 3))
    for force in _constant_forces(trace):
        total[_acting(trace, force)] += vector(force.force)
    if changes_of_gravity(trace.events):
        change = gravity(trace) - vector(trace.config.scene.gravity)
        total += masses(trace)[:, None] * change
    return total


def work_of_forces(trace: Trace) -> Floats:
    """Return the work of the constant forces and torques of the config [J] in each step."""
    work = np.zeros(len(trace.step))
    for force in _constant_forces(trace):
        body = list(trace.bodies).index(force.body)
        acts = np.zeros(len(work), dtype=bool)
        acts[_acting(trace, force)] = True
        displacement = np.diff(trace.pose[:, body, :3], axis=0, prepend=trace.pose[:1, body, :3])
        for event in changes_of_bodies(trace.events):
            row = first_starting_at(trace, event.at)
            if event.teleport is None or event.body != force.body:
                continue
            if 0 < row < len(displacement):
                displacement[row] -= vector(event.teleport) - trace.pose[row - 1, body, :3]
        done = displacement @ vector(force.force)
        if any(force.torque):
            pieces = _substeps(trace)
            turns = _turns(trace.pose[:, body, 3:], pieces)
            for event in changes_of_bodies(trace.events):
                row = first_starting_at(trace, event.at)
                if event.orientation is None or event.body != force.body:
                    continue
                if 0 < row < len(turns):  # it turns from where the event has put it
                    ends = np.array([event.orientation, trace.pose[row, body, 3:]])
                    turns[row] = _turns(ends, pieces[[row - 1, row]])[1]
            done = done + turns @ vector(force.torque)
        work += np.where(acts, done, 0.0)
    return work


def given_by_events(trace: Trace) -> Floats:
    """Return the most energy [J] that events can have put in before each step.

    A teleport gives -m g . (new - old), exactly. A new velocity gives what it carries, less what
    the body had, which is in no log: at most all of it. A mass that becomes s times as large gives
    (s - 1) times the body's energy: its potential part exactly, its kinetic part no more than the
    scene's. A body that is removed is one whose mass becomes 0 times as large. A new orientation
    leaves the angular velocity: it gives at most the ratio of the largest to the least principal
    inertia, less 1, times the scene's kinetic energy. A new surface gives what its springs store
    in the penetration that they find. New gravity gives -(new - old) . sum m x, exactly.
    """
    if not trace.events:
        return np.zeros(len(trace.step))
    given = _given_by_gravity(trace) + _given_by_surfaces(trace)
    pull = gravity(trace)
    bodies = trace.config.scene.bodies
    scaled = dict.fromkeys(bodies, 1.0)
    moved: dict[tuple[str, int], Floats] = {}  # where an event of the same time put it
    for event in changes_of_bodies(trace.events):
        name, row = event.body, first_starting_at(trace, event.at)
        body = bodies[name]
        scale = 0.0 if event.remove else event.scale_mass
        if row == 0 and scale is not None:  # in a part of the log before this one
            scaled[name] *= scale
        if not is_movable(body) or not 0 < row < len(given):
            continue
        place = moved.get((name, row), trace.pose[row - 1, list(trace.bodies).index(name), :3])
        mass = mass_of(body) * scaled[name]
        if scale is not None:
            kinetic = float(trace.step["kinetic_energy"][row - 1]) if scale > 1.0 else 0.0
            given[row] += (scale - 1.0) * (kinetic - mass * float(pull[row] @ place))
            scaled[name] *= scale
            mass *= scale
        if event.teleport is not None:
            target = vector(event.teleport)
            given[row] -= mass * float(pull[row] @ (target - place))
            moved[name, row] = target
        if event.orientation is not None:
            moments = principal_inertia(body)
            ratio = float(np.max(moments)) / float(np.min(moments))
            given[row] += (ratio - 1.0) * float(trace.step["kinetic_energy"][row - 1])
        if event.velocity is not None:
            given[row] += 0.5 * mass * float(np.square(event.velocity).sum())
        if event.angular_velocity is not None:
            largest = scaled[name] * float(np.max(principal_inertia(body)))
            given[row] += 0.5 * largest * float(np.square(event.angular_velocity).sum())
    return given


def _given_by_gravity(trace: Trace) -> Floats:
    """Return what changes of gravity give before each step [J], exactly.

    One before the first step has acted in the first state of the log.
    """
    given = np.zeros(len(trace.step))
    pull = gravity(trace)
    for event in changes_of_gravity(trace.events):
        row = first_starting_at(trace, event.at)
        if trace.clock.steps_until(exact(event.at)) > 0 and 0 < row < len(given):
            loads = np.array(list(_masses_before(trace, row).values()))
            moment = loads @ trace.pose[row - 1, :, :3]
            given[row] = -float((pull[row] - pull[row - 1]) @ moment)
    return given


def _masses_before(trace: Trace, row: int) -> dict[str, float]:
    """Return the mass of each body [kg] in the step before that of a row; 0 of what is not movable.

    In the order of the bodies of the log.
    """
    bodies = trace.config.scene.bodies
    movable = {name for name in trace.bodies if is_movable(bodies[name])}
    loads = {name: mass_of(bodies[name]) if name in movable else 0.0 for name in trace.bodies}
    for event in changes_of_bodies(trace.events):
        if first_starting_at(trace, event.at) < row:
            loads[event.body] *= 0.0 if event.remove else (event.scale_mass or 1.0)
    return loads


def _given_by_surfaces(trace: Trace) -> Floats:
    """Return what springs of new surfaces store in the penetration they find, by step [J].

    They find it as the step's contacts begin; what its bodies meet on their way has none.
    """
    given = np.zeros(len(trace.step))
    found: set[int] = set()
    for event in changes_of_bodies(trace.events):
        row = first_starting_at(trace, event.at)
        if event.surface is not None and 0 < row < len(given) and row not in found:
            found.add(row)
            given[row] = shares.stored_as_found(trace, int(trace.step["step"][row]))
    return given


def unknown_momentum(trace: Trace) -> np.ndarray:
    """Return in which steps an event changed a momentum that no log has."""
    unknown = np.zeros(len(trace.step), dtype=bool)
    for event in changes_of_bodies(trace.events):
        row = first_starting_at(trace, event.at)
        changes = event.velocity is not None or event.scale_mass is not None
        if (changes or event.remove) and row < len(unknown):
            unknown[row] = True
    return unknown


def _constant_forces(trace: Trace) -> list[CellForce]:
    """Return the forces on centres of mass in world axes; the impulse of others is in the log."""
    return [force for force in trace.config.scene.forces if force.constant_at_centre]


def _acting(trace: Trace, force: CellForce) -> slice:
    return slice(first_starting_at(trace, force.begin), first_starting_at(trace, force.end))


def _substeps(trace: Trace) -> Floats:
    """Return of how many substeps each step is, at least 1: those of error control."""
    if "substeps" not in (trace.step.dtype.names or ()):
        return np.ones(len(trace.step))
    made: Floats = np.maximum(trace.step["substeps"], 1).astype(float)
    return made


def _turns(quaternions: Floats, pieces: Floats) -> Floats:
    """Return angular velocity times dt of each step as a vector in world axes (n, 3); w x y z in.

    A step, or each of its substeps, turns by Cayley's map: the tangent of half the angle is half of
    what is returned. pieces: how many substeps it has, which are taken as equally long.
    """
    real, imaginary = turns_between(quaternions[:-1], quaternions[1:])
    turns = np.zeros((len(quaternions), 3))
    with np.errstate(invalid="ignore", divide="ignore"):
        turns[1:] = 2.0 * imaginary / real[:, None]
        several = np.flatnonzero(pieces[1:] > 1.0)
        if len(several):
            sine, made = np.linalg.norm(imaginary[several], axis=1), pieces[1:][several]
            half = np.arctan2(sine, real[several])
            share = np.where(sine > 0.0, made * np.tan(half / made) / sine, 1.0)
            turns[1 + several] = 2.0 * imaginary[several] * share[:, None]
    return turns
