"""A change from the config enters, the arrays of a running engine are changed, between two steps."""

from __future__ import annotations

from typing import Any

from lavendersim.engine.engine import Engine

from .build import Scene


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
