"""Resolving events: surfaces by name in place, vectors and turns in the frames of the bodies."""

from __future__ import annotations

from functools import partial
from typing import Any

from lavendersim.cell.events import AnyEvent, CellEvent, CellGravity, CellTimestep
from lavendersim.cell.shared_parts import shared
from lavendersim.engine.effects import EVENT_KEYS
from lavendersim.experiment.models.events import Event
from lavendersim.experiment.models.scene import Scene
from lavendersim.experiment.resolve.frames import Frames
from lavendersim.experiment.resolve.gravity import gravity_vector
from lavendersim.experiment.resolve.shape import quaternion_of
from lavendersim.experiment.resolve.surface_pairs import surface_of


def resolve_event(event: Event, scene: Scene, frames: Frames) -> AnyEvent:
    """Return an event with nothing left open; it has passed the rules of `Event`."""
    if event.gravity is not None:
        return CellGravity(at=event.at, gravity=gravity_vector(event.gravity))
    if event.timestep is not None:
        return CellTimestep(at=event.at, timestep=event.timestep)
    assert event.body is not None
    moves = event.teleport is not None or event.orientation is not None
    settled: dict[str, Any] = {
        "at": event.at,
        "body": event.body,
        "scale_mass": event.scale_mass,
        "teleport": event.teleport,
        "velocity": event.velocity,
        "angular_velocity": event.angular_velocity,
        "contact_cache": event.contact_cache or ("clear" if moves else "keep"),
        "remove": bool(event.remove),
        "orientation": None,
        "surface": None,
    }
    if event.orientation is not None:
        turned = quaternion_of(event.orientation)
        settled["orientation"] = frames.orientation(event.body, turned)
    if event.surface is not None:
        settled["surface"] = shared(surface_of(event.surface, scene))
    turn = partial(frames.vector, event.body)
    for key in EVENT_KEYS:
        value = getattr(event, key.name)
        settled[key.name] = None if value is None else key.resolve(value, turn)
    resolved: CellEvent = CellEvent.of(**settled)
    return resolved
