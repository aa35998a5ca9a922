"""What a caller from Python may do to bodies between two steps: forces, torques and velocities.

Every input has a limit, which is declared before anything is built: the plan is then that of a
scene in which it is reached, so that an effect that such a push requires is never absent.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final, NamedTuple

import numpy as np

from lavendersim.cell import CellConfig, CellEvent, CellForce
from lavendersim.errors import UsageError
from lavendersim.geometry.bodies import is_movable
from lavendersim.quantities.found import found, nearest, quoted
from lavendersim.quantities.quantity import Vector3

INPUTS: Final = {
    "force": "N",  # at the centre of mass, in world axes, until the next action
    "torque": "N m",
    "velocity": "m/s",  # of the centre of mass, set once
    "angular_velocity": "rad/s",
}
SPEEDS: Final = ("velocity", "angular_velocity")
EVENT: Final = {
    "at": 0.0,
    "scale_mass": None,
    "teleport": None,
    "contact_cache": "keep",
    "remove": False,
}

Limits = Mapping[str, Mapping[str, float]]
NOTHING: Final = (0.0, 0.0, 0.0)


class Push(NamedTuple):
    """One body's part of an action; what is None stays as it is."""

    body: str
    force: Vector3 | None  # [N]; with a torque, or none of both
    torque: Vector3 | None  # [N m]
    velocity: Vector3 | None  # [m/s]
    angular_velocity: Vector3 | None  # [rad/s]


def checked_limits(config: CellConfig, limits: Limits) -> dict[str, dict[str, float]]:
    """Return limits of the components of each input, by body.

    Raises UsageError for a body that does not move by forces, an input or a limit that cannot be.
    """
    bodies = config.scene.bodies
    for name, inputs in limits.items():
        if name not in bodies:
            raise UsageError(f"actions: no body is called {quoted(name)}{nearest(name, bodies)}")
        if not is_movable(bodies[name]):
            raise UsageError(f"actions: {name} does not move by forces")
        for key, limit in inputs.items():
            if key not in INPUTS:
                raise UsageError(f"actions: {name} has no {quoted(key)}{nearest(key, INPUTS)}")
            if not 0.0 < limit < math.inf:
                raise UsageError(f"actions: {name}.{key}: expected a limit above 0, got {limit}")
    return {name: {key: float(limit) for key, limit in one.items()} for name, one in limits.items()}


def with_limits(config: CellConfig, limits: Limits) -> CellConfig:
    """Return the config of a scene in which every input reaches its limit; for its plan alone."""
    forces, events = [], []
    for name, inputs in limits.items():
        full = {key: (inputs.get(key, 0.0),) * 3 for key in INPUTS}
        if any(full["force"]) or any(full["torque"]):
            acting = {"force": full["force"], "torque": full["torque"]}
            over = {"body": name, "from": 0.0, "to": config.duration}
            forces.append(CellForce.model_validate(over | acting))
        speeds = {key: full[key] if any(full[key]) else None for key in SPEEDS}
        if any(speeds.values()):
            events.append(CellEvent.model_validate({**EVENT, "body": name, **speeds}))
    scene = config.scene.model_copy(update={"forces": (*config.scene.forces, *forces)})
    return config.model_copy(update={"scene": scene, "events": (*config.events, *events)})


def pushes(action: Mapping[str, Mapping[str, Any]], limits: Limits) -> list[Push]:
    """Read an action: by body and input three components, each within its limit.

    A force or torque that a body's limits allow and the action does not name is 0. Raises
    UsageError for anything else.
    """
    if not limits:
        raise UsageError("this simulation takes no action: declare limits with `actions`")
    if not isinstance(action, Mapping):
        raise UsageError(f"action: expected a mapping by body, got {found(action)}")
    for name in action:
        if name not in limits:
            raise UsageError(f"action: {quoted(name)} takes none{nearest(name, limits)}")
    made = []
    for name, allowed in limits.items():
        given = {
            key: _vector(f"action: {name}.{key}", value, allowed.get(key))
            for key, value in action.get(name, {}).items()
        }
        if {"force", "torque"} & allowed.keys():
            given = {"force": NOTHING, "torque": NOTHING, **given}
        made.append(Push(name, *(given.get(key) for key in INPUTS)))
    return made


def _vector(what: str, value: Any, limit: float | None) -> Vector3:
    if limit is None:
        raise UsageError(f"{what}: it is not among the actions that were declared")
    vector = np.asarray(value, dtype=np.float64)
    if vector.shape != (3,) or not (np.abs(vector) <= limit).all():
        unit = INPUTS[what.rpartition(".")[2]]
        raise UsageError(f"{what}: expected three numbers of at most {limit:g} {unit}")
    x, y, z = vector.tolist()
    return x, y, z
