"""The resolved config of a cell and its log in; what forces and events put into it, by step, out.

Arrays have one entry per logged step; entry k belongs to the step that ends in state k, entry 0 to
none. Forces and events act before the first step that starts at their time or later.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lavendersim.clock import written
from lavendersim.measures import cell_config
from lavendersim.measures.views import Floats, Trace


def row_after(trace: Trace, time: float) -> int:
    """Return the row of the first step that starts at a time [s] as written, or later."""
    done = trace.clock.steps_until(written(time))
    return int(np.searchsorted(trace.step["step"], done + 1))


def events_of_bodies(trace: Trace) -> list[dict[str, Any]]:
    """Return the events that change a body, as they are written."""
    events = trace.resolved.get("events") or ()
    return [event for event in events if event.get("timestep") is None]


def removals(trace: Trace) -> dict[str, int]:
    """Return the row of the first step without it, for each body that is removed."""
    gone = [event for event in events_of_bodies(trace) if event.get("remove")]
    return {event["body"]: row_after(trace, event["at"]) for event in gone}


def masses(trace: Trace) -> Floats:
    """Return the mass of everything movable [kg] in each state."""
    movable = {one.name: one.mass for one in cell_config.bodies(trace.resolved) if one.movable}
    total = np.full(len(trace.step), sum(movable.values()))
    for event in _in_order(trace):
        scale = 0.0 if event.get("remove") else event.get("scale_mass")
        if scale is not None and event["body"] in movable:
            before = movable[event["body"]]
            movable[event["body"]] = before * scale
            total[row_after(trace, event["at"]) :] += movable[event["body"]] - before
    return total


def forces(trace: Trace) -> Floats:
    """Return the sum of the forces of the config [N] in each step (n, 3)."""
    total = np.zeros((len(trace.step), 3))
    for force in trace.resolved["scene"].get("forces") or ():
        total[_acting(trace, force)] += np.asarray(force["force"], dtype=float)
    return total


def work_of_forces(trace: Trace) -> Floats:
    """Return the work of the forces and torques of the config [J] in each step."""
    work = np.zeros(len(trace.step))
    for force in trace.resolved["scene"].get("forces") or ():
        body = list(trace.bodies).index(force["body"])
        acts = np.zeros(len(work), dtype=bool)
        acts[_acting(trace, force)] = True
        way = np.diff(trace.pose[:, body, :3], axis=0, prepend=trace.pose[:1, body, :3])
        for event in _in_order(trace):
            row = row_after(trace, event["at"])
            jumps = event["body"] == force["body"] and event.get("teleport") is not None
            if jumps and 0 < row < len(way):
                way[row] -= np.asarray(event["teleport"]) - trace.pose[row - 1, body, :3]
        done = way @ np.asarray(force["force"], dtype=float)
        if any(force["torque"]):
            done = done + _turns(trace.pose[:, body, 3:]) @ np.asarray(force["torque"], dtype=float)
        work += np.where(acts, done, 0.0)
    return work


def given_by_events(trace: Trace) -> Floats:
    """Return the most energy [J] that events can have put in before each step.

    A teleport gives -m g . (new - old), exactly. A new velocity gives what it carries, less what
    the body had, which is in no log: at most all of it. A mass that becomes s times as large gives
    (s - 1) times the body's energy: its potential part exactly, its kinetic part no more than the
    scene's. A body that is removed is one whose mass becomes 0 times as large.
    """
    given = np.zeros(len(trace.step))
    gravity = cell_config.gravity(trace.resolved)
    configs = {one.name: one for one in cell_config.bodies(trace.resolved)}
    scaled = dict.fromkeys(configs, 1.0)
    moved: dict[tuple[str, int], Floats] = {}  # where an event of the same time put it
    for event in _in_order(trace):
        name, row = event["body"], row_after(trace, event["at"])
        config = configs[name]
        scale = 0.0 if event.get("remove") else event.get("scale_mass")
        if row == 0 and scale is not None:  # in a part of the log before this one
            scaled[name] *= scale
        if not config.movable or not 0 < row < len(given):
            continue
        place = moved.get((name, row), trace.pose[row - 1, list(trace.bodies).index(name), :3])
        mass = config.mass * scaled[name]
        if scale is not None:
            kinetic = float(trace.step["kinetic_energy"][row - 1]) if scale > 1.0 else 0.0
            given[row] += (scale - 1.0) * (kinetic - mass * float(gravity @ place))
            scaled[name] *= scale
            mass *= scale
        if event.get("teleport") is not None:
            target = np.asarray(event["teleport"], dtype=float)
            given[row] -= mass * float(gravity @ (target - place))
            moved[name, row] = target
        if event.get("velocity") is not None:
            given[row] += 0.5 * mass * float(np.square(event["velocity"]).sum())
        if event.get("angular_velocity") is not None:
            largest = scaled[name] * float(np.max(config.principal_inertia))
            given[row] += 0.5 * largest * float(np.square(event["angular_velocity"]).sum())
    return given


def unknown_momentum(trace: Trace) -> np.ndarray:
    """Return in which steps an event changed a momentum that no log has."""
    unknown = np.zeros(len(trace.step), dtype=bool)
    for event in _in_order(trace):
        row = row_after(trace, event["at"])
        changes = event.get("velocity") is not None or event.get("scale_mass") is not None
        if (changes or event.get("remove")) and row < len(unknown):
            unknown[row] = True
    return unknown


def _in_order(trace: Trace) -> list[dict[str, Any]]:
    """Return the events of bodies by their time; those of one time as they are written."""
    return sorted(events_of_bodies(trace), key=lambda event: event["at"])


def _acting(trace: Trace, force: dict[str, Any]) -> slice:
    return slice(row_after(trace, force["from"]), row_after(trace, force["to"]))


def _turns(quaternions: Floats) -> Floats:
    """Return angular velocity times dt of each step as a vector in world axes (n, 3); w x y z in.

    A step turns by Cayley's map: the tangent of half the angle is half of what is returned.
    """
    old, new = quaternions[:-1], quaternions[1:]
    real = (old * new).sum(axis=1)
    # the vector part of new * conj(old)
    vector = (
        old[:, :1] * new[:, 1:] - new[:, :1] * old[:, 1:] - np.cross(new[:, 1:], old[:, 1:])
    ) * np.where(real < 0.0, -1.0, 1.0)[:, None]
    turns = np.zeros((len(quaternions), 3))
    with np.errstate(invalid="ignore", divide="ignore"):
        turns[1:] = 2.0 * vector / np.abs(real)[:, None]
    return turns
