"""The queue of changes that the config makes to the arrays of a running engine between two steps.

Whatever has a time, an event or the begin and end of a force, acts before the first step that
starts at that time or later.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from math import fsum
from typing import NamedTuple

from lavendersim.cell import CellEvent, CellForce, CellTimestep
from lavendersim.engine.engine import Engine
from lavendersim.quantities.scalars import exact

from .build import Scene, set_timestep


class Change(NamedTuple):
    """Something that happens between two steps."""

    after: int  # steps
    order: int  # among those before one step: forces first, then events by time and as written
    apply: Callable[[], None]


class EventQueue:
    """The changes of one run, in the order of their time."""

    def __init__(
        self, engine: Engine, scene: Scene, events: Sequence[CellEvent | CellTimestep]
    ) -> None:
        self._engine, self._scene = engine, scene
        self._acting: list[CellForce] = []
        changes = [*self._force_changes(scene.forces), *self._event_changes(events)]
        self._pending = sorted(changes, key=lambda change: change[:2])

    def apply_due(self, done: int) -> None:
        """Apply every change that is due after `done` steps."""
        while self._pending and self._pending[0].after <= done:
            self._pending.pop(0).apply()

    def next_stop(self, limit: int) -> int:
        """Return the step after which the next change is due, `limit` without one before it."""
        return min(self._pending[0].after, limit) if self._pending else limit

    def _after(self, time: float) -> int:
        """Return how many steps are done when a time [s], as written, is reached."""
        return self._scene.clock.steps_until(exact(time))

    def _event_changes(self, events: Sequence[CellEvent | CellTimestep]) -> Iterator[Change]:
        for done, timestep in self._scene.clock.changes:
            yield Change(
                done,
                0,
                lambda timestep=timestep, done=done: self._set_timestep(timestep, done),  # type: ignore[misc]
            )
        timed = sorted(events, key=lambda event: event.at)
        for order, event in enumerate(timed, start=1):
            if isinstance(event, CellTimestep):
                continue
            yield Change(
                self._after(event.at),
                order,
                lambda event=event: apply_event(self._engine, self._scene, event),  # type: ignore[misc]
            )

    def _force_changes(self, forces: Sequence[CellForce]) -> Iterator[Change]:
        if not self._engine.spec.has("external_force"):
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

    def _begin(self, force: CellForce) -> None:
        self._acting.append(force)
        self._set_force(force.body)

    def _end(self, force: CellForce) -> None:
        self._acting = [other for other in self._acting if other is not force]
        self._set_force(force.body)

    def _set_force(self, name: str) -> None:
        """Write the sum of what acts on a body now: no remainder is left when forces end."""
        body = self._engine.bodies[self._scene.names.index(name)]
        acting = [force for force in self._acting if force.body == name]
        for k, axis in enumerate("xyz"):
            body[f"f{axis}"] = fsum(force.force[k] for force in acting)
            if f"t{axis}" in (body.dtype.names or ()):
                body[f"t{axis}"] = fsum(force.torque[k] for force in acting)


def apply_event(engine: Engine, scene: Scene, event: CellEvent) -> None:
    """Apply one event. A body that jumps loses the impulses cached for its contacts.

    `contact_cache: clear` drops every cached impulse: the next solve starts from zero everywhere.
    """
    index = scene.names.index(event.body)
    if event.remove:
        engine.remove(index)
        return
    engine.wake(index)
    body, velocity = engine.bodies[index], engine.velocities[index]
    if event.scale_mass is not None:
        body["inv_m"] /= event.scale_mass
        if engine.spec.has("rotation"):
            for axis in "xyz":
                body[f"inv_i{axis}"] /= event.scale_mass
    if event.velocity is not None:
        velocity["vx"], velocity["vy"], velocity["vz"] = event.velocity
    if event.angular_velocity is not None and engine.spec.has("rotation"):
        velocity["wx"], velocity["wy"], velocity["wz"] = event.angular_velocity
    if event.teleport is not None:
        body["x"], body["y"], body["z"] = event.teleport
        engine.forget_contacts(index)
    elif event.contact_cache == "clear":
        engine.forget_contacts()
