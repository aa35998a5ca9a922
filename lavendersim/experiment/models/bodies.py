"""The bodies of a config as written: surface, mass, start and motion; one by one or arranged."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar

from pydantic import Field

from lavendersim.cell.body import Release
from lavendersim.cell.surface import Surface
from lavendersim.engine.effects import BODY_KEYS, MOTION_KEYS
from lavendersim.experiment.models.shapes import (
    CAVITIES,
    SIMPLE,
    SOLIDS,
    SURFACES,
    TURNED,
    Orientation,
    Shape,
    Solid,
)
from lavendersim.experiment.models.tree import PRESCRIBE_MOTION
from lavendersim.experiment.text.place import Place
from lavendersim.quantities.chosen_kind import ByKind
from lavendersim.quantities.found import near
from lavendersim.quantities.model import ConfigModel, declared
from lavendersim.quantities.names import SurfaceName
from lavendersim.quantities.quantity import (
    AngularVelocity,
    Either,
    Position,
    Quantity,
    Vector,
    Vector3,
    Velocity,
)

_CONSTRAIN = ("fixed", *PRESCRIBE_MOTION)
_OF_MOVING = ("velocity", "angular_velocity")
_OF_MOVABLE = ("mass", "density", "inertia", *(key.name for key in BODY_KEYS if key.of_movable))
OF_PRESCRIBED = tuple(key.name for key in BODY_KEYS if key.of_prescribed)
_OF_PLACES = ("position", "release", "orientation")
_PLACES = {  # what the position is of, of shapes without mass
    "bowl": "[m] of its centre",
    "drum": "[m] of a point of its axis",
    **dict.fromkeys(SURFACES, "[m] of the origin of its frame"),
}
STATIC_HINT = "a body that never moves has fixed: true"


SurfaceOf = Annotated[
    SurfaceName | Surface,
    Either("the name of a surface or {restitution: ..., friction: ...}", str, dict),
]


class _Mass(ConfigModel):
    """What mass a body has, or that it has none."""

    mass: Annotated[float, Quantity("kg", above=0, hint=STATIC_HINT)] | None = Field(
        default=None, description="[kg] of a movable body, which has this or a density"
    )
    density: Annotated[float, Quantity("kg/m^3", above=0)] | None = Field(
        default=None, description="[kg/m^3] instead of a mass"
    )
    inertia: Annotated[Vector3, Vector(3, Quantity("kg m^2", above=0))] | None = Field(
        default=None,
        description="[kg m^2] moments about the body's x, y, z; none: of a homogeneous solid, as "
        "hulls and compounds are",
    )
    fixed: bool = Field(default=False, description="true: never moves, has no mass")


class _MatterOwn(declared("MatterOwn", _Mass, MOTION_KEYS), _Mass):  # type: ignore[misc]
    """What bodies have in common whatever effects there are, with what prescribes a motion."""

    surface: SurfaceOf = Field(
        default=Surface(),
        description="name of one of `scene.surfaces`, or its properties in place",
    )
    orientation: Orientation = Field(
        default=(1.0, 0.0, 0.0, 0.0),
        description="quaternion w x y z, or `{axis: [x, y, z], degrees: 30}`; both are normalised",
    )
    velocity: Velocity = Field(default=(0.0, 0.0, 0.0), description="[m/s] of the centre of mass")
    angular_velocity: AngularVelocity = Field(
        default=(0.0, 0.0, 0.0), description="[rad/s] world frame, right-handed"
    )


class _Matter(declared("Matter", _MatterOwn, BODY_KEYS), _MatterOwn):  # type: ignore[misc]
    """What bodies have in common, whether they stand alone or are arranged."""

    MISPLACED: ClassVar[Mapping[str, str]] = {
        **{key: f"write surface: {{{key}: ...}}" for key in Surface.model_fields},
        **{
            key: f"write shape: {{kind: ..., {key}: ...}}"
            for model in SIMPLE
            for key in model.model_fields
            if key != "kind"
        },
    }

    FORM: ClassVar[str] = "shape: {kind: ...}, ..."

    @classmethod
    def rules(cls, at: Place) -> None:
        """What moves has one of mass and density; what does not has neither, and no motion."""
        kind = at.get("shape", "kind").text
        if kind == "plane":
            _plane_rules(at)
        elif kind in (*CAVITIES, *SURFACES):
            _massless_rules(at, kind)
        elif kind in SOLIDS:
            if "position" in cls.model_fields:  # a body that stands alone
                _exactly_one(at, ("position", "release"), "[m], or a release above a plane")
            constrained = [key for key in _CONSTRAIN if at.get(key).is_true]
            if len(constrained) > 1:
                at.refuse_both(constrained[:2])
            elif constrained:
                _immovable_rules(at, constrained[0])
            else:
                _unprescribed_rules(at)
                meaning = "[kg], or a density [kg/m^3], or fixed: true"
                _exactly_one(at, ("mass", "density"), meaning)
                _inertia_rules(at, kind)


class Body(_Matter):
    """One rigid body. Planes are static; a movable body has exactly one of mass and density."""

    shape: Shape = Field(
        description="plane, sphere, box, capsule, cylinder, ellipsoid, cone, hull, compound, bowl, "
        "drum, mesh or height_field"
    )
    position: Position | None = Field(
        default=None,
        description="[m] centre of mass, world frame; of a mesh or height field the origin of its "
        "frame; of planes neither this nor a release",
    )
    release: Release | None = Field(
        default=None, description="start above a plane, instead of a position; of what can move"
    )


class ArrangedBody(_Matter):
    """A body that stands in several places: all that a body has but its position."""

    shape: Annotated[Solid, ByKind()] = Field(
        description=f"{', '.join(SOLIDS[:-1])} or {SOLIDS[-1]}"
    )


def _unprescribed_rules(at: Place) -> None:
    """Refuse what only a body has whose motion is prescribed."""
    words = " or ".join(f"{word}: true" for word in PRESCRIBE_MOTION)
    for key, mark in at.given(OF_PRESCRIBED):
        at.refuse(mark, f"{key}: forces and contacts move {at}; expected {words} beside it")


def _prescribed_rules(at: Place) -> None:
    """Refuse velocities of a body whose motion is a function of time, and a second turn."""
    for key in OF_PRESCRIBED:
        if not at.get(key).items:
            continue
        for other, mark in at.given(_OF_MOVING):
            at.refuse(mark, f"{other}: {key} says how {at} moves; leave one of them out")
        turns = [turn for one in at.get(key).items if (turn := one.get("turn"))]
        for turn in turns[1:]:
            at.refuse(turn.mark, f"turn: {at} has one already; a body turns about one axis")


def _immovable_rules(at: Place, word: str) -> None:
    if word in PRESCRIBE_MOTION:
        _prescribed_rules(at)
    else:
        for key, mark in at.given(OF_PRESCRIBED):
            at.refuse(mark, f"{key}: {at} is {word}; a {word} body has no {key}")
    for key, mark in at.given((*_OF_MOVABLE, *(_OF_MOVING if word == "fixed" else ()))):
        at.refuse(mark, f"{key}: {at} is {word}; a {word} body has no {key.replace('_', ' ')}")
    if released := at.written("release"):
        goes = "stays" if word == "fixed" else "its motion is prescribed"
        at.refuse(released, f"release: {at} is {word} and {goes}; specify its position")


def _inertia_rules(at: Place, kind: str) -> None:
    inertia = at.get("inertia")
    if inertia.content is None:
        return
    if kind in TURNED:
        at.refuse(at.key("inertia"), f"inertia: {at} is a {kind}; its shape says it, leave it out")
        return
    moments = [item.number for item in inertia.items]
    numbers = sorted(moment for moment in moments if moment is not None)
    # 1, 2, 3 is a flat body, the limit; written numbers may miss it by their round-off.
    if len(numbers) == 3 and numbers[2] > (numbers[0] + numbers[1]) * (1.0 + 1e-12):
        sentence = "inertia: no body has a moment above the sum of the other two"
        largest = inertia.items[moments.index(numbers[2])]
        at.refuse(largest.mark, f"{sentence}, found {numbers[2]:g}")


def _plane_rules(at: Place) -> None:
    always = f"{at} is a plane; planes are always fixed"
    fixed = at.get("fixed")
    if fixed.content is False:
        at.refuse(fixed.mark, f"fixed: {always}")
    for key in PRESCRIBE_MOTION:
        if at.get(key).is_true:
            at.refuse(at.key(key), f"{key}: {always}")
    for key, mark in at.given((*_OF_MOVABLE, *_OF_MOVING, *OF_PRESCRIBED, *_OF_PLACES)):
        instead = "; its normal and offset say where it is" if key in _OF_PLACES else ""
        has = f"a plane has no {key.replace('_', ' ')}{instead}"
        at.refuse(mark, f"{key}: {at} is a plane; {has}")


def _massless_rules(at: Place, kind: str) -> None:
    if at.written("position") is None:
        at.lacks("position", _PLACES[kind])
    constrained = [key for key in _CONSTRAIN if at.get(key).is_true]
    always = f"a {kind}, which is fixed or has its motion prescribed"
    if at.get("fixed").content is False:
        at.refuse(at.get("fixed").mark, f"fixed: {at} is {always}")
    if len(constrained) > 1:
        at.refuse_both(constrained[:2])
    elif constrained and constrained[0] != "fixed":
        _prescribed_rules(at)
    else:
        for key, mark in at.given((*_OF_MOVING, *OF_PRESCRIBED)):
            words = " or ".join(f"{word}: true" for word in PRESCRIBE_MOTION)
            at.refuse(mark, f"{key}: {at} is fixed, as a {kind} is; expected {words} beside it")
    for key, mark in at.given((*_OF_MOVABLE, "release")):
        at.refuse(mark, f"{key}: {at} is {always}; it has no {key.replace('_', ' ')}")


def _exactly_one(at: Place, keys: tuple[str, str], meaning: str) -> None:
    if not at.refuse_both(keys):
        unknown = [key for key in at.node.entries if key not in Body.model_fields]
        if at.node.incomplete or any(near(key, Body.model_fields) in keys for key in unknown):
            at.doubt()  # a refused key may have been one of them
        else:
            at.lacks(keys[0], meaning)
