"""Events of a cell: changes before the first step from a time on; and what follows from them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final, Literal

from pydantic import SerializerFunctionWrapHandler, model_serializer

from lavendersim.cell.body import CellBody
from lavendersim.cell.numerics import Timestep
from lavendersim.cell.surface import PairedSurface, Surface
from lavendersim.engine.effects import EVENT_KEYS
from lavendersim.quantities.model import ResolvedModel, declared
from lavendersim.quantities.quantity import Quaternion, Vector3

# What of a body an event changes that its contacts obey.
_OF_BODY: Final = ("surface", *(key.name for key in EVENT_KEYS))
# Absent from a cell's JSON where they change nothing: older logs have cells without them.
_NEWER: Final = ("orientation", *_OF_BODY)


class BodyChange(ResolvedModel):
    """What every event of a body has, whatever effects there are."""

    at: float  # [s]
    body: str
    scale_mass: float | None
    teleport: Vector3 | None  # [m]
    velocity: Vector3 | None  # [m/s]
    angular_velocity: Vector3 | None  # [rad/s]
    contact_cache: Literal["keep", "clear"]
    remove: bool  # and nothing else happens to it
    orientation: Quaternion | None = None  # unit quaternion w x y z, its frame to world
    surface: PairedSurface | Surface | None = None


class CellEvent(declared("CellEvent", BodyChange, EVENT_KEYS), BodyChange):  # type: ignore[misc]
    """One change to a body, applied before the first step that starts at `at` or later."""

    @model_serializer(mode="wrap")
    def _written(self, serialize: SerializerFunctionWrapHandler) -> dict[str, Any]:
        written: dict[str, Any] = serialize(self)
        return {
            name: value
            for name, value in written.items()
            if name not in _NEWER or value is not None
        }

    @property
    def changes_contacts(self) -> bool:
        """Whether it changes what contacts of the body obey."""
        return any(getattr(self, name) is not None for name in _OF_BODY)

    def after(self, body: CellBody) -> CellBody:
        """Return the body as it is from then on, but for mass, place and velocity."""
        values = {name: getattr(self, name) for name in _OF_BODY}
        given = {name: value for name, value in values.items() if value is not None}
        return body.model_copy(update=given) if given else body


class CellGravity(ResolvedModel):
    """Gravity from the first step that starts at `at` or later."""

    at: float  # [s]
    gravity: Vector3  # [m/s^2]


class CellTimestep(ResolvedModel):
    """A timestep that applies from the first step that starts at `at` or later."""

    at: float  # [s]
    timestep: Timestep  # [s]


AnyEvent = CellEvent | CellGravity | CellTimestep


def changes_of_bodies(events: Iterable[AnyEvent]) -> list[CellEvent]:
    """Return the events of bodies by their time; those of one time in the order of the config."""
    found = [one for one in events if isinstance(one, CellEvent)]
    return sorted(found, key=lambda one: one.at) if found else found


def changes_of_gravity(events: Iterable[AnyEvent]) -> list[CellGravity]:
    """Return the changes of gravity by their time; those of one time in the order of the config."""
    found = [one for one in events if isinstance(one, CellGravity)]
    return sorted(found, key=lambda one: one.at) if found else found
