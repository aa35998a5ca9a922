"""Resolving events: surfaces by name in place, vectors and turns in the frames of the bodies."""

from __future__ import annotations

from functools import partial
from typing import Any, Final

from lavendersim.cell.events import AnyEvent, CellEvent, CellGravity, CellTimestep
from lavendersim.cell.shared_parts import shared
from lavendersim.cell.triggers import (
    OF_CONTACT,
    OF_PLACE,
    CellTrigger,
    CellTriggeredEvent,
    Condition,
)
from lavendersim.engine.effects import EVENT_KEYS
from lavendersim.experiment.models.events import Event
from lavendersim.experiment.models.scene import Scene
from lavendersim.experiment.resolve.frames import Frames
from lavendersim.experiment.resolve.gravity import gravity_vector
from lavendersim.experiment.resolve.shape import quaternion_of
from lavendersim.experiment.resolve.surface_pairs import surface_of
from lavendersim.geometry.vectors import unit

_AS_WRITTEN: Final = ("body", "scale_mass", "teleport", "velocity", "angular_velocity")


def resolve_triggered(event: Event, scene: Scene, frames: Frames) -> CellTriggeredEvent:
    """Return an event with the state that makes it happen; it has passed the rules of both."""
    when = event.when
    assert when is not None
    condition: Condition = when.condition
    given: Any = getattr(when, condition)
    of_pair = condition in OF_CONTACT
    trigger = CellTrigger(
        condition=condition,
        bodies=given if of_pair else (str(when.body),),
        along=unit(when.along) if condition in OF_PLACE else None,
        value=None if of_pair else given,
    )
    happening = resolve_event(event, scene, frames)
    assert not isinstance(happening, CellTimestep)
    return CellTriggeredEvent(when=trigger, event=happening)


def resolve_event(event: Event, scene: Scene, frames: Frames) -> AnyEvent:
    """Return an event with nothing left open; it has passed the rules of `Event`."""
    # What a trigger makes happen has its time from the run.
    at = 0.0 if event.at is None else event.at
    if event.gravity is not None:
        return CellGravity(at=at, gravity=gravity_vector(event.gravity))
    if event.timestep is not None:
        return CellTimestep(at=at, timestep=event.timestep)
    assert event.body is not None
    moves = event.teleport is not None or event.orientation is not None
    settled: dict[str, Any] = {
        **{key: getattr(event, key) for key in _AS_WRITTEN},
        "at": at,
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
