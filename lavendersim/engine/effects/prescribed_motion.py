"""Prescribed motion: a kinematic body whose place is a function of time, as of a shaken table.

    x(t) = c + R(t) (x_0 - c) + sum of d (f(t) - f(0))
R(t) turns by theta (f(t) - f(0)) about an axis through c. At the end of every step the body stands
where this says, to round-off. What velocity and spin contacts meet follows how bodies move that
they carry: with their new velocity, then the mean of the step, which leads there exactly; or by the
mean of old and new (`midpoint_contact`), then those of the step's two ends, each less h^2/12 of its
second derivative, h the length of the step. Their mean leads there but for h^5/120 of the fifth
derivative of the place, and a step begins with what the last one ended with: a contact that lasts
sees no jump (Euler and Maclaurin). In substeps (`error_control`), whose lengths differ, nothing is
taken off: velocities that depend on the length would be counted as errors of a run at every one.
"""

from collections.abc import Iterator
from math import cos, hypot, sin
from typing import Annotated, Any

from pydantic import Field as ModelField

from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Position, Quantity, Vector, Vector3

from ..records import POSE, STRETCH
from ..step_terms import step_terms
from .decision import Decision, Facts, named
from .effect import Drive, Effect, Fields, Hooks, kernel
from .keys import BodyKey
from .time_functions import Terms, TimeFunction, terms_of

_AXES = "xyz"
_NONE: Vector3 = (0.0, 0.0, 0.0)


class Motion(ConfigModel):
    """A displacement and a turn from where the body stands at first, times a function of time."""

    displacement: Annotated[Vector3, Vector(3, Quantity("m"))] = ModelField(
        default=_NONE, description="[m] world frame, where the function has grown by 1"
    )
    turn: Annotated[Vector3, Vector(3, Quantity("rad"))] = ModelField(
        default=_NONE,
        description="[rad] right-handed about its direction, world frame, where the function has "
        "grown by 1; one of the motions of a body has a turn, and it comes first",
    )
    through: Position | None = ModelField(
        default=None,
        description="[m] a point of the axis of `turn`, world frame; none: the body's position",
    )
    factor: TimeFunction = ModelField(
        description="a function of time without jumps; its value at time 0 is taken off"
    )

    @classmethod
    def rules(cls, at: Any) -> None:
        """It moves the body, and without jumps."""
        if not at.get("displacement") and not at.get("turn"):
            at.refuse(at.node.mark, f"{at} moves nothing; expected displacement or turn")
        if at.get("through") and not at.get("turn"):
            at.refuse(at.key("through"), "through: the axis of a turn; expected turn beside it")
        kind = at.get("factor", "kind")
        if kind.text == "pulse":
            at.refuse(
                kind.mark, "factor: a pulse jumps, and a body cannot; expected ramp, sine or table"
            )


def body_values(body: Any) -> dict[str, int]:
    """Return the value of the body field of its own that a config gives a body."""
    return {"prescribed": int(bool(body.motion))}


def moves(body: Any) -> tuple[float, bool]:
    """Return the most speed that it gives the centre of a body [m/s], and whether it turns it."""
    speed = 0.0
    for one in body.motion:
        pairs = zip(body.position, one.through or body.position, strict=True)
        lever = hypot(*(place - through for place, through in pairs))
        speed += terms_of(one.factor).steepest * (
            hypot(*one.displacement) + lever * hypot(*one.turn)
        )
    return speed, any(any(one.turn) for one in body.motion)


def decide(facts: Facts) -> Decision:
    """On when the motion of a body is a function of time."""
    moved = [one.name for one in facts.bodies if one.config is not None and one.config.motion]
    if moved:
        return Decision(True, f"{named(moved)}: its motion is a function of time")
    return Decision(False, "no motion is a function of time")


def drives(scene: Any, rows: dict[str, int]) -> list[Drive]:
    """Return the drives of every body, its turn first; rows: of the bodies, by name."""
    return [
        Drive(body=rows[name], terms=terms, begin=None, end=None, values=values)
        for name, body in scene.bodies.items()
        for terms, values in _of_body(body)
    ]


def _of_body(body: Any) -> Iterator[tuple[Terms, dict[str, Any]]]:
    ordered = sorted(body.motion, key=lambda one: not any(one.turn))
    for k, one in enumerate(ordered):
        angle = hypot(*one.turn)
        axis = [part / angle for part in one.turn] if angle else _NONE
        pose = (*body.position, *body.orientation)
        yield (
            terms_of(one.factor),
            {
                "moves": 1,
                "leads": int(k == 0),
                "angle": angle,
                **{f"a{axis_}": part for axis_, part in zip(_AXES, axis, strict=True)},
                **{f"c{k}": x for k, x in zip(_AXES, one.through or body.position, strict=True)},
                **{f"d{k}": x for k, x in zip(_AXES, one.displacement, strict=True)},
                **{f"home_{key}": x for (key, _), x in zip(POSE, pose, strict=True)},
            },
        )


def make_lead_to_end(spec):
    """Return `kernel(body, velocity, dt)`: the mean velocity and spin that lead to its end."""
    turns = step_terms(spec).turns

    def lead_to_end(body, v, dt):
        # The mean velocity and spin that lead there; a turn by the vector w dt is Cayley's.
        v.vx, v.vy, v.vz = (
            (body.to_x - body.x) / dt,
            (body.to_y - body.y) / dt,
            (body.to_z - body.z) / dt,
        )
        if turns:
            w, x, y, z = body.qw, body.qx, body.qy, body.qz
            qw, qx, qy, qz = body.to_qw, body.to_qx, body.to_qy, body.to_qz
            share = 2.0 / (dt * (qw * w + qx * x + qy * y + qz * z))
            v.wx = share * (qx * w - qw * x - qy * z + qz * y)
            v.wy = share * (qy * w - qw * y - qz * x + qx * z)
            v.wz = share * (qz * w - qw * z - qx * y + qy * x)

    return kernel(lead_to_end, spec)


def make_ends(spec):
    """Return `kernel(drive, knots, t, arm, after, h) -> (v, spin)` of one end of a step.

    arm: from the axis to the centre [m]; after: where the function bends there, behind the bend.
    """
    from ..drives import make_rates
    from ..vectors import Vec3, cross, plus, scaled

    turns, rates = step_terms(spec).turns, make_rates(spec)
    substeps = step_terms(spec).substeps

    def ends(drive, knots, t, arm, after, h):
        # Velocity of the centre and spin of one end, less h^2/12 of their second derivatives; the
        # spin with h^2/12 of its cube more, by which Cayley's map turns less.
        share = h * h / 12.0
        if substeps:
            share = 0.0
        first, second, third = rates(drive, knots, t, after)
        flat = first - share * third
        v = Vec3(flat * drive.dx, flat * drive.dy, flat * drive.dz)
        spin = Vec3(0.0, 0.0, 0.0)
        if turns:
            if drive.angle != 0.0:
                axis = Vec3(drive.ax, drive.ay, drive.az)
                first, second = drive.angle * first, drive.angle * second
                bent = first - share * (drive.angle * third - first * first * first)
                across = cross(axis, arm)
                # The third derivative of an arm r that turns by theta about the axis a:
                # (theta_3 - theta_1^3) a x r + 3 theta_1 theta_2 a x (a x r).
                v = plus(v, scaled(bent, across))
                v = plus(v, scaled(-3.0 * share * first * second, cross(axis, across)))
                spin = scaled(bent, axis)
        return v, spin

    return kernel(ends, spec)


def make_drive(spec):
    """Return `kernel(drives, bodies, velocities, params, counters)`: where the part ends."""
    from ..drives import make_begin_of_part, make_value
    from ..vectors import Vec3, cross, dot, plus, scaled

    turns, centred = step_terms(spec).turns, step_terms(spec).centred
    begin_of_part, value = make_begin_of_part(spec), make_value(spec)
    ends: Any = make_ends(spec) if centred else None
    lead_to_end: Any = None if centred else make_lead_to_end(spec)

    def about(axis, angle, r):
        # r, turned about a unit axis (Rodrigues).
        c, s = cos(angle), sin(angle)
        turned = plus(scaled(c, r), scaled(s, cross(axis, r)))
        return plus(turned, scaled((1.0 - c) * dot(axis, r), axis))

    about = kernel(about, spec)

    def lead(body, drive):
        body.to_x, body.to_y, body.to_z = drive.home_x, drive.home_y, drive.home_z
        body.to_qw, body.to_qx = drive.home_qw, drive.home_qx
        body.to_qy, body.to_qz = drive.home_qy, drive.home_qz
        body.end_vx, body.end_vy, body.end_vz = 0.0, 0.0, 0.0
        body.end_wx, body.end_wy, body.end_wz = 0.0, 0.0, 0.0

    lead = kernel(lead, spec)

    def turn_to(body, axis, angle):
        # The quaternion at home, turned.
        c, s = cos(0.5 * angle), sin(0.5 * angle)
        x, y, z = s * axis.x, s * axis.y, s * axis.z
        qw, qx, qy, qz = body.to_qw, body.to_qx, body.to_qy, body.to_qz
        body.to_qw = c * qw - x * qx - y * qy - z * qz
        body.to_qx = c * qx + x * qw + y * qz - z * qy
        body.to_qy = c * qy + y * qw + z * qx - x * qz
        body.to_qz = c * qz + z * qw + x * qy - y * qx

    turn_to = kernel(turn_to, spec)

    def drive_motion(drives, bodies, velocities, params, counters):
        begin, dt = begin_of_part(params, counters), params.dt
        end, knots = begin + dt, drives.knots
        for k in range(drives.records.shape[0]):
            drive = drives.records[k]
            if drive.moves == 0 or bodies[drive.body].kinematic == 0:
                continue
            body, v = bodies[drive.body], velocities[drive.body]
            if drive.leads == 1:
                lead(body, drive)
                if centred:
                    v.vx, v.vy, v.vz = 0.0, 0.0, 0.0
                    if turns:
                        v.wx, v.wy, v.wz = 0.0, 0.0, 0.0
            first = value(drive, knots, 0.0)
            there = value(drive, knots, end) - first
            arm, at_end = Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0)
            if turns:
                if drive.angle != 0.0:
                    axis = Vec3(drive.ax, drive.ay, drive.az)
                    centre = Vec3(drive.cx, drive.cy, drive.cz)
                    arm = Vec3(body.to_x - centre.x, body.to_y - centre.y, body.to_z - centre.z)
                    at_end = about(axis, drive.angle * there, arm)
                    body.to_x, body.to_y = centre.x + at_end.x, centre.y + at_end.y
                    body.to_z = centre.z + at_end.z
                    turn_to(body, axis, drive.angle * there)
                    if centred:
                        here = value(drive, knots, begin) - first
                        arm = about(axis, drive.angle * here, arm)
            body.to_x += there * drive.dx
            body.to_y += there * drive.dy
            body.to_z += there * drive.dz
            if centred:
                velocity, spin = ends(drive, knots, begin, arm, True, dt)
                v.vx, v.vy, v.vz = v.vx + velocity.x, v.vy + velocity.y, v.vz + velocity.z
                if turns:
                    v.wx, v.wy, v.wz = v.wx + spin.x, v.wy + spin.y, v.wz + spin.z
                velocity, spin = ends(drive, knots, end, at_end, False, dt)
                body.end_vx += velocity.x
                body.end_vy += velocity.y
                body.end_vz += velocity.z
                body.end_wx += spin.x
                body.end_wy += spin.y
                body.end_wz += spin.z
        if not centred:
            for k in range(drives.records.shape[0]):
                drive = drives.records[k]
                if drive.moves == 1 and drive.leads == 1 and bodies[drive.body].kinematic == 1:
                    lead_to_end(bodies[drive.body], velocities[drive.body], dt)

    return kernel(drive_motion, spec)


def make_prescribe(spec):
    """Return `kernel(body, velocity)`: that of the end of the part, for that of its begin."""
    turns, centred = step_terms(spec).turns, step_terms(spec).centred

    def prescribe(body, velocity):
        if centred:
            if body.prescribed == 1:
                velocity.vx, velocity.vy, velocity.vz = body.end_vx, body.end_vy, body.end_vz
                if turns:
                    velocity.wx, velocity.wy, velocity.wz = body.end_wx, body.end_wy, body.end_wz

    return kernel(prescribe, spec)


def make_end_part(spec):
    """Return `kernel(state, params)`: bodies stand where the function says."""
    from ..rotation import orient

    turns = step_terms(spec).turns

    def stand_there(state, params):
        bodies = state.bodies
        for i in range(bodies.shape[0]):
            body = bodies[i]
            if body.prescribed == 1 and body.kinematic == 1:
                body.x, body.y, body.z = body.to_x, body.to_y, body.to_z
                if turns:
                    body.qw, body.qx = body.to_qw, body.to_qx
                    body.qy, body.qz = body.to_qy, body.to_qz
                    orient(body)

    return kernel(stand_there, spec)


EFFECT = Effect(
    name="prescribed_motion",
    decide=decide,
    per="body",
    needs=("kinematic",),
    body_keys=(
        BodyKey(
            name="motion",
            type=tuple[Motion, ...],
            default=(),
            doc="of a kinematic body, in place of velocities: where it is as a function of time; a "
            "list whose displacements add",
            of_prescribed=True,
        ),
    ),
    moves=moves,
    drives=drives,
    fields=Fields(
        body=[
            ("prescribed", "i8"),  # 1: its motion is a function of time
            *[(f"to_{key}", kind) for key, kind in POSE],  # where the part ends
            *[(f"end_v{axis}", "f8") for axis in _AXES],  # velocity there [m/s]
            *[(f"end_w{axis}", "f8") for axis in _AXES],  # spin there [rad/s]
        ],
        parameters=STRETCH,
        drive=[
            ("moves", "i8"),  # 1: it is a motion
            ("leads", "i8"),  # 1: the first of its body
            ("angle", "f8"),  # [rad]
            *[(f"a{axis}", "f8") for axis in _AXES],  # unit axis of the turn
            *[(f"c{axis}", "f8") for axis in _AXES],  # a point of it [m]
            *[(f"d{axis}", "f8") for axis in _AXES],  # displacement [m]
            *[(f"home_{key}", kind) for key, kind in POSE],  # where the body stands at first
        ],
    ),
    body_values=body_values,
    hooks=Hooks(drive=make_drive, prescribe=make_prescribe, end_part=make_end_part),
)
