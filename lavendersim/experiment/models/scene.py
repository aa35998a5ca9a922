"""The `scene` of a config as written: surfaces, bodies, arrangements and forces."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.cell.surface import Surface
from lavendersim.engine.effects import SCENE_KEYS, TimeFunction
from lavendersim.experiment.models.arrangements import Arrangement
from lavendersim.experiment.models.bodies import Body
from lavendersim.experiment.models.gravity import GRAVITY, Gravity
from lavendersim.experiment.models.shapes import Shape
from lavendersim.experiment.models.surface_pairs import SurfacePair
from lavendersim.experiment.models.tree import (
    MOST_BODIES,
    after_the_end,
    bodies_of,
    described,
    immovable,
    member_name,
    members,
    not_after,
    removals,
)
from lavendersim.experiment.text.node import ABSENT, key_mark
from lavendersim.experiment.text.place import Place
from lavendersim.quantities.found import quoted
from lavendersim.quantities.model import ConfigModel, declared
from lavendersim.quantities.names import BodyName, NewName
from lavendersim.quantities.quantity import Position, Quantity, Vector, Vector3

_ZERO = (0.0, 0.0, 0.0)


class Force(ConfigModel):
    """A force and a torque on one body for a while, constant or not; those of one body add."""

    body: BodyName = Field(description="name of a movable body")
    begin: Annotated[float, Quantity("s", minimum=0)] = Field(
        default=0.0, alias="from", description="[s] acts from the first step that starts then"
    )
    end: Annotated[float, Quantity("s", minimum=0)] | None = Field(
        default=None,
        alias="to",
        description="[s] until the first step that starts then; none: to the end of the run",
    )
    force: Annotated[Vector3, Vector(3, Quantity("N"))] = Field(
        default=_ZERO, description="[N] in the axes of `frame`, on `point`"
    )
    torque: Annotated[Vector3, Vector(3, Quantity("N m"))] = Field(
        default=_ZERO, description="[N m] in the axes of `frame`, right-handed"
    )
    factor: TimeFunction | None = Field(
        default=None, description="a function of time that multiplies both; none: 1"
    )
    point: Position = Field(
        default=_ZERO,
        description="[m] where the force acts, in the body's frame, whatever `frame` is; 0 is the "
        "centre of mass",
    )
    frame: Literal["world", "body"] = Field(
        default="world", description="`world`, or `body`: force and torque turn with the body"
    )

    @classmethod
    def rules(cls, at: Place) -> None:
        """It acts on a body that can move, for a while of the run, before the body is removed."""
        body, begin, end = at.get("body"), at.get("from"), at.get("to")
        name = body.text
        if what := immovable(bodies_of(at.root).get(name or "", ABSENT), prescribed=True):
            at.refuse(body.mark, f'body: "{name}" is {what}; expected a movable body')
        if not at.get("force") and not at.get("torque"):
            at.refuse(at.node.mark, f"{at} does nothing; expected force or torque")
        start, stop = begin.number if begin else 0.0, end.number
        late = after_the_end(at, "from")
        if not late and start is not None and stop is not None and stop <= start:
            not_after(at, start)
        removal = removals(at.root).get(name or "")
        if removal is not None and not end:
            sentence = removal.sentence("body", name)
            at.refuse(body.mark, f"{sentence}; expected to: {removal.at:g}")
        elif removal is not None and stop is not None and stop > removal.at:
            at.refuse(end.mark, removal.sentence("to", name))


class Perturbation(ConfigModel):
    """Small differences of where bodies start, drawn by a seed: no symmetry is luck."""

    seed: Annotated[int, Quantity(whole=True, minimum=0, maximum=2**53)] = Field(
        default=0,
        description="equal seeds give equal scenes (Python's Mersenne twister); 0: as written",
    )
    distance: Annotated[float, Quantity("m", above=0)] = Field(
        default=1e-5,
        description="[m] every movable body is moved by up to so much along each axis, evenly "
        "drawn, but not along gravity nor the normals of planes and of fixed boxes that bodies "
        "touch",
    )


class Scene(declared("Scene", ConfigModel, SCENE_KEYS)):  # type: ignore[misc]
    """What is there; bodies in the order in which they are written, then those arranged."""

    gravity: Gravity = Field(
        default=GRAVITY,
        description="[m/s^2] magnitude along -z, a vector `[gx, gy, gz]`, or its tilt",
    )
    surfaces: dict[NewName, Surface] = Field(
        default={}, description="name: properties, for several bodies"
    )
    surface_pairs: dict[NewName, SurfacePair] = Field(
        default={},
        description="name: two surfaces, and properties of their contacts that are not mixed",
    )
    shapes: dict[NewName, Shape] = Field(
        default={}, description="name: a shape, for `shape: name` of several bodies, or to sweep"
    )
    bodies: dict[NewName, Body] = Field(description="name of the body: its properties")
    arrangements: dict[NewName, Arrangement] = Field(
        default={},
        description="name: one body in many places (name_1, name_2, ...), behind `bodies`",
    )
    forces: tuple[Force, ...] = Field(default=(), description="forces and torques over time")
    perturbation: Perturbation | None = Field(
        default=None, description="differences of where bodies start; none: as written"
    )

    @classmethod
    def rules(cls, at: Place) -> None:
        """Something can move; the bodies of arrangements are not too many, with own names."""
        bodies = at.get("bodies")
        if not isinstance(bodies.content, dict):
            return
        _arrangement_rules(at)
        every = [body for _, body in described(at.root)]
        if not every:
            at.refuse(bodies.mark, "bodies: expected at least one movable body, found none")
        elif all(immovable(body, prescribed=False) for body in every):
            sentence = "nothing can move here; expected at least one body that is not fixed"
            at.refuse(at.key("bodies"), f"bodies: {sentence}")


def _arrangement_rules(at: Place) -> None:
    single, total = at.get("bodies").entries, 0
    arrangements = at.get("arrangements")
    for name, arrangement in arrangements.entries.items():
        count = members(arrangement)
        total += count
        mark = key_mark(arrangements, name)
        if total > MOST_BODIES:
            sentence = f"{name}: {total} bodies in arrangements, expected at most {MOST_BODIES}"
            at.refuse(mark, sentence)
            return
        names = (member_name(name, number) for number in range(1, count + 1))
        if clash := next((one for one in names if one in single), None):
            at.refuse(mark, f"{name}: its body {quoted(clash)} has a namesake in bodies")
