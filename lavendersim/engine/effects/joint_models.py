"""Joints as a config says them, and the rows that each has (`effects.joint`).

Limits and a motor are effects of their own: `joint_stop`, `motor`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf, pi
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

from pydantic import Field as ModelField
from pydantic import Strict

from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import BodyName
from lavendersim.quantities.quantity import Direction, Quantity, Vector, Vector3

_Point = Annotated[Vector3, Vector(3, Quantity("m"))]
# In a cell's JSON they are lists.
Limits = tuple[float, float]
_Names = Annotated[tuple[BodyName, ...], Strict(False), ModelField(min_length=2, max_length=2)]


class RowOfJoint(NamedTuple):
    """A row: which point of the joint, which direction (`collide.joint`)."""

    # 0: where the joint is; 1: further along its axis, z; 2: beside it, along x; 3: of stops and
    # motor, from the axis to what B's centre is at.
    point: int
    # x y z of the world: 0 1 2; of the end on A: 3 4, where ends slide along z: 6 7. What turns
    # about z: the motor 8, the lower stop 9, the upper stop 10; what slides along z: 11 12 13.
    direction: int


BALL = (RowOfJoint(0, 0), RowOfJoint(0, 1), RowOfJoint(0, 2))
HINGE = (*BALL, RowOfJoint(1, 3), RowOfJoint(1, 4))
FIXED = (*HINGE, RowOfJoint(2, 4))
SLIDER = (
    *(RowOfJoint(0, 6), RowOfJoint(0, 7), RowOfJoint(1, 6), RowOfJoint(1, 7)),
    RowOfJoint(2, 7),
)
DRIVEN_POINT = 3
ABOUT, ALONG = 8, 11  # directions of what moves about, or along, z: of the motor, the stops follow


class Connection(ConfigModel):
    """What joints and ropes have: two bodies."""

    kind: str
    between: _Names = ModelField(description="names of two bodies, of which at least one moves")

    @classmethod
    def rules(cls, at: Any) -> None:
        """Two different bodies."""
        names = [one.text for one in at.get("between").items]
        if len(names) == 2 and names[0] is not None and names[0] == names[1]:
            sentence = f'"{names[0]}" twice; expected two bodies'
            at.refuse(at.get("between").mark, f"between: {sentence}")

    @property
    def name_of_pair(self) -> str:
        """Return its bodies, for a sentence."""
        return " and ".join(self.between)


class Joint(Connection):
    """What all joints have: two bodies, and a place."""

    at: _Point = ModelField(description="[m] the point that they share, as the run begins")
    collide: bool = ModelField(
        default=False, description="whether the two bodies also touch each other"
    )

    @property
    def rows(self) -> tuple[RowOfJoint, ...]:
        """Return its rows, in their order."""
        return BALL

    @property
    def along(self) -> Vector3:
        """Return the direction of its axis; of a joint without one any will do."""
        return (1.0, 0.0, 0.0)

    @property
    def motor_row(self) -> tuple[RowOfJoint, ...]:
        """Return the row of its motor, if it has one."""
        return ()

    @property
    def stop_rows(self) -> tuple[RowOfJoint, ...]:
        """Return the rows of its lower and its upper stop, if it has limits."""
        return ()


class BallJoint(Joint):
    """A ball joint: two bodies share a point, about which they turn freely."""

    kind: Literal["ball"] = ModelField(description="`ball`")


class JointWithAxis(Joint):
    """What joints about, or along, an axis have."""

    axis: Direction = ModelField(
        description="its axis through `at`, world frame, as the run begins; is normalised"
    )

    round: ClassVar[float] = inf  # once round [rad]
    moves: ClassVar[int] = ALONG
    limits: Any
    motor: Any

    @classmethod
    def rules(cls, at: Any) -> None:
        """Limits have the place between them where the run begins."""
        super().rules(at)
        limits = at.get("limits")
        lower, upper = (
            (one.number for one in limits.items) if len(limits.items) == 2 else (None,) * 2
        )
        if lower is None or upper is None:
            return
        if not lower <= 0.0 <= upper or lower == upper:
            sentence = f"expected 0, where the run begins, between them, found {lower:g}, {upper:g}"
            at.refuse(limits.mark, f"limits: {sentence}")
        elif upper - lower >= cls.round:
            sentence = f"expected less than {cls.round:.4g} rad from one to the other, once round"
            at.refuse(limits.mark, f"limits: {sentence}, found {upper - lower:g}")

    @property
    def along(self) -> Vector3:
        """Return the direction of its axis."""
        return self.axis

    @property
    def motor_row(self) -> tuple[RowOfJoint, ...]:
        """Return the row of its motor, if it has one."""
        return (RowOfJoint(DRIVEN_POINT, self.moves),) if self.motor is not None else ()

    @property
    def stop_rows(self) -> tuple[RowOfJoint, ...]:
        """Return the rows of its lower and its upper stop, if it has limits."""
        if self.limits is None:
            return ()
        return (RowOfJoint(DRIVEN_POINT, self.moves + 1), RowOfJoint(DRIVEN_POINT, self.moves + 2))


class HingeMotor(ConfigModel):
    """A motor of a hinge: it turns the second body of `between` against the first."""

    speed: Annotated[float, Quantity("rad/s")] = ModelField(
        description="[rad/s] that it drives to, about `axis`; 0: it brakes, as friction of a joint"
    )
    max_torque: Annotated[float, Quantity("N m", minimum=0)] = ModelField(
        description="[N m] that it turns by at most, either way"
    )

    @property
    def most(self) -> float:
        """Return what it turns by at most [N m]."""
        return self.max_torque


class SliderMotor(ConfigModel):
    """A motor of a slider: it pushes the second body of `between` along the first."""

    speed: Annotated[float, Quantity("m/s")] = ModelField(
        description="[m/s] that it drives to, along `axis`; 0: it brakes, as friction of a joint"
    )
    max_force: Annotated[float, Quantity("N", minimum=0)] = ModelField(
        description="[N] that it pushes by at most, either way"
    )

    @property
    def most(self) -> float:
        """Return what it pushes by at most [N]."""
        return self.max_force


class HingeJoint(JointWithAxis):
    """A hinge: two bodies share an axis, about which they turn freely."""

    round: ClassVar[float] = 2.0 * pi
    moves: ClassVar[int] = ABOUT
    kind: Literal["hinge"] = ModelField(description="`hinge`")
    limits: Annotated[Limits, Vector(2, Quantity("rad"))] | None = ModelField(
        default=None,
        description="[rad] least and greatest angle of the second body of `between` against the "
        "first, about `axis`, 0 as the run begins; where it stops nothing is thrown back",
    )
    motor: HingeMotor | None = ModelField(default=None, description="what drives it")

    @property
    def rows(self) -> tuple[RowOfJoint, ...]:
        """Return its rows, in their order."""
        return HINGE


class FixedJoint(Joint):
    """A fixed joint: two bodies move as one."""

    kind: Literal["fixed"] = ModelField(description="`fixed`")

    @property
    def rows(self) -> tuple[RowOfJoint, ...]:
        """Return its rows, in their order."""
        return FIXED


class SliderJoint(JointWithAxis):
    """A slider: two bodies turn as one, and slide freely along an axis."""

    kind: Literal["slider"] = ModelField(description="`slider`")
    limits: Annotated[Limits, Vector(2, Quantity("m"))] | None = ModelField(
        default=None,
        description="[m] least and greatest displacement of the second body of `between` from the "
        "first, along `axis`, 0 as the run begins; where it stops nothing is thrown back",
    )
    motor: SliderMotor | None = ModelField(default=None, description="what drives it")

    @property
    def rows(self) -> tuple[RowOfJoint, ...]:
        """Return its rows, in their order."""
        return SLIDER


JOINTS = ("ball", "hinge", "fixed", "slider")
AnyJoint = BallJoint | HingeJoint | FixedJoint | SliderJoint


def holding(scene: Any) -> Mapping[str, Joint]:
    """Return the joints of a scene that hold a body that moves, by name; in the file's order."""
    return {
        name: one
        for name, one in scene.connections.items()
        if isinstance(one, Joint)
        if not all(scene.bodies[body].fixed for body in one.between)
    }


def driving(facts: Any) -> list[str]:
    """Return the pairs of bodies whose joint has a motor that reaches its speed within a step.

    Where contact is at the middle of the step, so that it is of second order.
    """
    if facts.scene is None or facts.integrator != "midpoint_contact":
        return []
    return [one.name_of_pair for one in holding(facts.scene).values() if one.motor_row]


def turned_by_joints(scene: Any) -> Iterator[str]:
    """Yield the movable bodies that a joint may turn: beside their centre, or with the other."""
    for one in holding(scene).values():
        for name in one.between:
            body = scene.bodies[name]
            centred = one.rows == BALL and tuple(body.position) == tuple(one.at)
            if not body.fixed and not centred:
                yield name
