"""Changes from the config enter; between two steps they change the arrays of a running engine."""

from __future__ import annotations

from fractions import Fraction
from math import ceil
from typing import Any

from lavendersim.engine.engine import Engine

from .build import Scene


class EventQueue:
    """The events of one run, in the order of their time."""

    def __init__(self, engine: Engine, scene: Scene, events: list[dict[str, Any]]) -> None:
        self._engine, self._scene = engine, scene
        # An event is applied before the first step that starts at its time or later.
        self._pending = sorted(
            (
                (ceil(Fraction(repr(event["at"])) / scene.timestep), order, event)
                for order, event in enumerate(events)
            ),
            key=lambda due: due[:2],
        )

    def apply_due(self, done: int) -> None:
        """Apply every event that is due after `done` steps."""
        while self._pending and self._pending[0][0] <= done:
            apply_event(self._engine, self._scene, self._pending.pop(0)[2])

    def next_stop(self, limit: int) -> int:
        """Return the step after which the next event is due, `limit` without one before it."""
        return min(self._pending[0][0], limit) if self._pending else limit


def apply_event(engine: Engine, scene: Scene, event: dict[str, Any]) -> None:
    """Apply one resolved event. A body that jumps loses the impulses cached for its contacts.

    `contact_cache: clear` drops every cached impulse: the next solve starts from zero everywhere.
    """
    index = scene.names.index(event["body"])
    body = engine.bodies[index]
    if event["scale_mass"] is not None:
        body["inv_m"] /= event["scale_mass"]
        if engine.spec.has("rotation"):
            for axis in "xyz":
                body[f"inv_i{axis}"] /= event["scale_mass"]
    if event["teleport"] is not None:
        body["x"], body["y"], body["z"] = event["teleport"]
        engine.forget_contacts(index)
    elif event["contact_cache"] == "clear":
        engine.forget_contacts()
