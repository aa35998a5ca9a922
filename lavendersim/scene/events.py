"""The queue of changes that the config makes to the arrays of a running engine between two steps.

Whatever has a time, an event or the begin and end of a force, acts before the first step that
starts at that time or later.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import partial
from math import fsum
from typing import NamedTuple

import numpy as np

from lavendersim.cell import (
    AnyEvent,
    CellEvent,
    CellForce,
    CellGravity,
    CellTimestep,
    CellTriggeredEvent,
)
from lavendersim.engine.effects import has_hook
from lavendersim.engine.engine import Engine
from lavendersim.engine.step_terms import step_terms
from lavendersim.quantities.quantity import Vector3
from lavendersim.quantities.scalars import exact

from .body_rows import fill_effects, orient
from .build import Scene, set_gravity, set_timestep
from .colliders import colliders
from .pair_tables import list_materials, mix_again


class Change(NamedTuple):
    """Something that happens between two steps."""

    after: int  # steps
    order: int  # among those before one step: forces first, then events by time and as written
    apply: Callable[[], None]


class EventQueue:
    """The changes of one run, in the order of their time."""

    def __init__(
        self,
        engine: Engine,
        scene: Scene,
        events: Sequence[AnyEvent],
        triggered: Sequence[CellTriggeredEvent] = (),
    ) -> None:
        self._engine, self._scene = engine, scene
        self._acting: list[CellForce] = []
        self._pushed: dict[str, tuple[Vector3, Vector3]] = {}
        self._of_bodies = BodyEvents(engine, scene)
        changes = [*self._force_changes(scene.forces), *self._timed(events)]
        self._pending = sorted(changes, key=lambda change: change[:2])
        self._triggered = {k: self._action(one.event) for k, one in enumerate(triggered)}

    def apply_due(self, done: int) -> None:
        """Apply every change that is due after `done` steps; those of triggers come last."""
        while self._pending and self._pending[0].after <= done:
            self._pending.pop(0).apply()
        if self._triggered and has_hook(self._engine.spec, "meet_triggers"):
            for k in np.flatnonzero(self._engine.state.triggers["met"]):
                if (apply := self._triggered.pop(int(k), None)) is not None:
                    apply()

    def push(self, body: str, force: Vector3, torque: Vector3) -> None:
        """Let these [N, N m] act on a body beside those of the config, until the next are given."""
        if self._pushed.get(body) != (force, torque):
            self._pushed[body] = force, torque
            self._engine.wake(self._scene.names.index(body))
            self._set_force(body)

    def set_velocity(
        self, body: str, velocity: Vector3 | None, angular_velocity: Vector3 | None
    ) -> None:
        """Give a body a velocity, a spin or both, as an event does."""
        index = self._scene.names.index(body)
        self._engine.wake(index)
        write_velocity(self._engine, index, velocity, angular_velocity)

    def next_stop(self, limit: int) -> int:
        """Return the step after which the next change is due, `limit` without one before it."""
        return min(self._pending[0].after, limit) if self._pending else limit

    def _after(self, time: float) -> int:
        """Return how many steps are done when a time [s], as written, is reached."""
        return self._scene.clock.steps_until(exact(time))

    def _timed(self, events: Sequence[AnyEvent]) -> Iterator[Change]:
        for done, timestep in self._scene.clock.changes:
            yield Change(
                done,
                0,
                lambda timestep=timestep, done=done: self._set_timestep(timestep, done),  # type: ignore[misc]
            )
        timed = sorted(events, key=lambda event: event.at)
        for order, event in enumerate(timed, start=1):
            if not isinstance(event, CellTimestep):  # the clock has the timesteps
                yield Change(self._after(event.at), order, self._action(event))

    def _action(self, event: CellEvent | CellGravity) -> Callable[[], None]:
        if isinstance(event, CellGravity):
            return partial(self._set_gravity, event.gravity)
        return partial(self._of_bodies.apply, event)

    def _force_changes(self, forces: Sequence[CellForce]) -> Iterator[Change]:
        if "fx" not in (self._engine.bodies.dtype.names or ()):
            return
        for force in forces:
            if not force.constant_at_centre:
                continue  # the step itself lets it act
            begin, end = self._after(force.begin), self._after(force.end)
            if begin < end:
                yield Change(begin, 0, lambda force=force: self._begin(force))  # type: ignore[misc]
                yield Change(end, 0, lambda force=force: self._end(force))  # type: ignore[misc]

    def _set_timestep(self, timestep: Fraction, done: int) -> None:
        parameters, scene = self._engine.parameters, self._scene
        set_timestep(parameters, scene.numerics, timestep)
        parameters["stretch_step"], parameters["stretch_begin"] = (
            done,
            float(scene.clock.time(done)),
        )

    def _set_gravity(self, gravity: Vector3) -> None:
        set_gravity(self._engine.parameters, self._scene.numerics, gravity)
        self._engine.wake_all()

    def _begin(self, force: CellForce) -> None:
        self._acting.append(force)
        self._set_force(force.body)

    def _end(self, force: CellForce) -> None:
        self._acting = [other for other in self._acting if other is not force]
        self._set_force(force.body)

    def _set_force(self, name: str) -> None:
        """Write the sum of what acts on a body now: no remainder is left when forces end."""
        body = self._engine.bodies[self._scene.names.index(name)]
        acting = [(force.force, force.torque) for force in self._acting if force.body == name]
        acting += [self._pushed[name]] if name in self._pushed else []
        for k, axis in enumerate("xyz"):
            body[f"f{axis}"] = fsum(force[k] for force, _ in acting)
            if f"t{axis}" in (body.dtype.names or ()):
                body[f"t{axis}"] = fsum(torque[k] for _, torque in acting)


def write_velocity(
    engine: Engine, index: int, velocity: Vector3 | None, angular_velocity: Vector3 | None
) -> None:
    """Write what is given of a body's velocity [m/s] and spin [rad/s]."""
    row = engine.velocities[index]
    if index < len(engine.state.motion):  # none where a step does not ask for it
        engine.state.motion["unparted"][index] = 0  # its joints may be torn
    if velocity is not None:
        row["vx"], row["vy"], row["vz"] = velocity
    if angular_velocity is not None and step_terms(engine.spec).turns:
        row["wx"], row["wy"], row["wz"] = angular_velocity


class BodyEvents:
    """Applies events of bodies; it knows the bodies as events have made them so far."""

    def __init__(self, engine: Engine, scene: Scene) -> None:
        self._engine, self._scene = engine, scene
        self._bodies = dict(scene.described)
        self._removed: set[str] = set()

    def apply(self, event: CellEvent) -> None:
        """Apply one event. A body that is put elsewhere loses the impulses of its contacts.

        `contact_cache: clear` drops every cached impulse: the next solve starts from zero
        everywhere.
        """
        engine, index = self._engine, self._scene.names.index(event.body)
        if event.body in self._removed:  # a trigger came too late for it, or removed it before
            return
        if event.remove:
            self._removed.add(event.body)
            engine.remove(index)
            return
        engine.wake(index)
        body = engine.bodies[index]
        if event.scale_mass is not None:
            body["inv_m"] /= event.scale_mass
            if step_terms(engine.spec).turns:
                for axis in "xyz":
                    body[f"inv_i{axis}"] /= event.scale_mass
        write_velocity(engine, index, event.velocity, event.angular_velocity)
        if event.teleport is not None:
            body["x"], body["y"], body["z"] = event.teleport
        if event.orientation is not None:
            turned = np.asarray(event.orientation, float)
            orient(body, turned / np.linalg.norm(turned))
        if event.teleport is not None or event.orientation is not None:
            engine.forget_contacts(index)
        elif event.contact_cache == "clear":
            engine.forget_contacts()
        if event.changes_contacts:
            self._bodies[event.body] = event.after(self._bodies[event.body])
            self._change_surface(index)

    def _change_surface(self, index: int) -> None:
        """Write what a body's surface is now, and what its contacts are to obey."""
        engine, scene = self._engine, self._scene
        described = list(self._bodies.values())
        rows = colliders(described)
        for record, row in zip(engine.bodies, rows, strict=False):  # ends of ropes have none
            if row.owner == index:
                fill_effects(record, row.body)
        if has_hook(engine.spec, "find_pairs"):
            list_materials(engine.bodies, rows, scene.classes, index)
            engine.list_pairs_anew()
        else:
            mix_again(engine.state.pairs, rows, index)
