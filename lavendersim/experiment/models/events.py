"""Events as written: changes to one body, of gravity or of the timestep, at a time of the run."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar, Final, Literal

from pydantic import Field

from lavendersim.cell.numerics import Timestep
from lavendersim.cell.triggers import MOST_TRIGGERS
from lavendersim.engine.effects import EVENT_KEYS
from lavendersim.experiment.models.bodies import OF_PRESCRIBED, SurfaceOf
from lavendersim.experiment.models.gravity import Gravity
from lavendersim.experiment.models.shapes import Orientation
from lavendersim.experiment.models.tree import (
    Removal,
    after_the_end,
    bodies_of,
    immovable,
    prescribes_motion,
    removals,
)
from lavendersim.experiment.models.triggers import Trigger, triggers
from lavendersim.experiment.text.node import ABSENT, Node
from lavendersim.experiment.text.place import Place
from lavendersim.quantities.found import near
from lavendersim.quantities.model import ConfigModel, declared
from lavendersim.quantities.names import BodyName
from lavendersim.quantities.quantity import AngularVelocity, Position, Quantity, Velocity

# What an event may change of the whole run; each is an event of its own.
_OF_RUN: Final = ("timestep", "gravity")
# What it may do to a body: only to one that moves, or to any; `remove` stands alone.
_OF_MOTION: Final = ("teleport", "orientation", "velocity", "angular_velocity")
_OF_MOVING: Final = ("scale_mass", *_OF_MOTION)
_OF_ANY: Final = ("surface", *(key.name for key in EVENT_KEYS))
_CHANGES: Final = (*_OF_MOVING, *_OF_ANY, "contact_cache")
_EVERY_CHANGE: Final = (*_CHANGES, "remove")
_MOVES: Final = {"teleport": "a teleport", "orientation": "a new orientation"}


class _Event(ConfigModel):
    MISPLACED: ClassVar[Mapping[str, str]] = {"time": 'did you mean "at"?'}

    at: Annotated[float, Quantity("s", minimum=0)] | None = Field(
        default=None, description="[s] simulated time; this, or `when`"
    )
    when: Trigger | None = Field(
        default=None,
        description="a state that makes it happen, once, after the first step that ends so",
    )
    body: BodyName | None = Field(
        default=None,
        description="a body that is not fixed; required but for gravity and a timestep; `remove`, "
        "`surface` and what moves in a surface take any",
    )
    gravity: Gravity | None = Field(
        default=None,
        description="[m/s^2] from then on, as of the scene; an event of its own, without a body",
    )
    timestep: Timestep | None = Field(
        default=None,
        description="[s] length of the steps from then on; an event of its own, without a body",
    )
    scale_mass: Annotated[float, Quantity(above=0)] | None = Field(
        default=None, description="factor on mass and inertia; not of kinematic bodies"
    )
    teleport: Position | None = Field(
        default=None, description="[m] new centre of mass; drops the body's cached impulses"
    )
    orientation: Orientation | None = Field(
        default=None,
        description="new orientation, as of a body; drops the body's cached impulses",
    )
    velocity: Velocity | None = Field(
        default=None, description="[m/s] new velocity of the centre of mass"
    )
    angular_velocity: AngularVelocity | None = Field(
        default=None, description="[rad/s] new angular velocity, world frame"
    )
    surface: SurfaceOf | None = Field(
        default=None, description="new surface: a name of one of `scene.surfaces`, or properties"
    )
    contact_cache: Literal["keep", "clear"] | None = Field(
        default=None,
        description="`keep`, or `clear`: every cached impulse is dropped, the next solve starts "
        "cold; none: keep",
    )
    remove: bool | None = Field(
        default=None,
        description="true: the body takes part in nothing more; no event or force may follow",
    )


class Event(declared("Event", _Event, EVENT_KEYS), _Event):  # type: ignore[misc]
    """A change to one body, or of the whole run, before the first step that starts at `at`.

    Or, with `when`, before the step after the first one that ends in a state.
    """

    @classmethod
    def rules(cls, at: Place) -> None:
        """It happens in the run, to a body that is there and can take it, or to the timestep."""
        body, time = at.get("body"), at.get("at").number
        _time_rules(at)
        of_run = next((key for key in _OF_RUN if at.written(key)), None)
        if of_run is not None:
            other = next((key for key in _OF_RUN if key != of_run and at.get(key)), None)
            keys = (other,) if other else ("body", *_EVERY_CHANGE)
            what = f"a change of {other}" if other else "what happens to a body"
            _alone(at, keys, f"{at} changes the {of_run}; {what} is an event of its own")
        elif body.content is None:
            _lacks_body(at)
        elif at.get("remove").is_true:
            _alone(at, _CHANGES, f"{at} removes the body; expected no change")
        else:
            _change_rules(at, body)
        removal = removals(at.root).get(body.text or "")
        if removal is not None and time is not None and Removal(time, at.index) > removal:
            at.refuse(body.mark, removal.sentence("body", body.text))


def _time_rules(at: Place) -> None:
    """It has one time, or one state that makes it happen; the length of steps has a time."""
    after_the_end(at, "at")
    when = at.written("when")
    if when is None:
        if not at.written("at") and not at.node.incomplete:
            at.lacks("at", "[s] a time, or else when: a state that makes it happen")
    elif at.written("at"):
        at.refuse(when, f"when: {at} has a time already; expected at or when")
    elif at.get("timestep"):
        at.refuse(when, "when: a timestep changes at a time; expected at")
    elif len(known := triggers(at.root)) > MOST_TRIGGERS and at.index == known[MOST_TRIGGERS]:
        at.refuse(when, f"when: expected at most {MOST_TRIGGERS} of them, found {len(known)}")


def _change_rules(at: Place, body: Node) -> None:
    target = bodies_of(at.root).get(body.text or "", ABSENT)
    of_any = any(at.get(key) for key in _OF_ANY)
    moving = next((key for key in _OF_MOVING if at.get(key)), None)
    what = immovable(target, prescribed=False)
    if what and of_any and moving:
        at.refuse(at.key(moving), f'{moving}: "{body.text}" is {what}; expected a movable body')
    elif what and not of_any:
        at.refuse(body.mark, f'body: "{body.text}" is {what}; expected a movable body')
    elif (key := prescribes_motion(target)) and at.get("scale_mass"):
        sentence = f'scale_mass: "{body.text}" is {key}; a {key} body has no mass'
        at.refuse(at.key("scale_mass"), sentence)
    motion = next((key for key in OF_PRESCRIBED if target.get(key).items), None)
    if motion is not None:
        for changed, mark in at.given(_OF_MOTION):
            sentence = f'{changed}: {motion} says at all times where "{body.text}" is'
            at.refuse(mark, f"{sentence}; an event cannot change it")
    if not any(at.get(key) for key in _CHANGES):
        changes = f"{', '.join(_CHANGES)} or remove"
        at.refuse(at.node.mark, f"{at} changes nothing; expected {changes}")
    cache = at.get("contact_cache")
    moved = next((one for key, one in _MOVES.items() if at.get(key)), None)
    if cache.text == "keep" and moved:
        at.refuse(cache.mark, f"contact_cache: {moved} always clears the body's cached contacts")


def _lacks_body(at: Place) -> None:
    """Without a body there is only the run to change; a misspelt key is refused elsewhere."""
    unknown = at.node.entries.keys() - {"at", "when", "body", *_OF_RUN, *_EVERY_CHANGE}
    if not at.node.incomplete and not any(near(key, ("body", *_OF_RUN)) for key in unknown):
        at.lacks("body", "name of a body, or else a timestep or gravity")


def _alone(at: Place, others: tuple[str, ...], reason: str) -> None:
    """Refuse the first of the keys that do not go with what the event does."""
    other = next((key for key in others if at.get(key)), None)
    if other is not None:
        at.refuse(at.key(other), f"{other}: {reason}")
