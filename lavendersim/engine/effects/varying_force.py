"""Varying forces: over time, at a point of a body, or in the body's frame; by the midpoint rule.

    v += F dt/m,   omega += I^-1 (T + r x F) dt
with the mean of the factor over the step, which makes impulses exact, and the point's lever r and
the axes of the body's frame as they stand when half of its turn is made with the spin before the
step: of order 2. The work of the step is F . (x_1 - x_0) + (T + r x F) . theta, theta the vector of
its turn by Cayley's map: what the kinetic energy of a free round body gains, to round-off.
"""

import math
from collections.abc import Iterator
from typing import Any

from ..records import ORIENTED_BODY, POSE, STRETCH
from ..step_terms import step_terms
from .decision import Decision, Facts, named
from .effect import Balance, Column, Drive, Effect, Fields, Hooks, kernel
from .time_functions import terms_of

_AXES = "xyz"
# Real parts of a turn below that are round-off: of more than 1e16 rad the work has no digits.
LEAST_REAL = 1e-16


def forces_of(scene: Any) -> Iterator[Any]:
    """Yield the forces of a scene that no constant force on a centre of mass can say."""
    return (one for one in scene.forces if not one.constant_at_centre)


def decide(facts: Facts) -> Decision:
    """On when a force or torque varies, acts at a point or is one of the body's frame."""
    pushed = dict.fromkeys(one.body for one in forces_of(facts.scene)) if facts.scene else {}
    if pushed:
        return Decision(
            True, f"{named(list(pushed))}: a force over time, at a point or in its frame"
        )
    return Decision(False, "no force varies, acts at a point or turns with its body")


def drives(scene: Any, rows: dict[str, int]) -> list[Drive]:
    """Return the drive of every such force; rows: of the bodies, by name."""
    return [
        Drive(
            body=rows[one.body],
            terms=terms_of(one.factor),
            begin=one.begin,
            end=one.end,
            values={
                "pushes": 1,
                "in_body": int(one.frame == "body"),
                **{f"f{axis}": value for axis, value in zip(_AXES, one.force, strict=True)},
                **{f"t{axis}": value for axis, value in zip(_AXES, one.torque, strict=True)},
                **{f"p{axis}": value for axis, value in zip(_AXES, one.point, strict=True)},
            },
        )
        for one in forces_of(scene)
    ]


def make_drive(spec):
    """Return `kernel(drives, bodies, velocities, params, counters)`: the mean forces of a part."""
    from ..drives import make_begin_of_part, make_mean
    from ..vectors import Vec3, cross, from_body, plus, scaled

    turns = step_terms(spec).turns
    begin_of_part, mean = make_begin_of_part(spec), make_mean(spec)

    def half_way(body, v, dt, vector):
        # A vector of the body's frame in the world, half of its turn later.
        r = from_body(body, vector)
        if turns:
            a = scaled(0.25 * dt, Vec3(v.wx, v.wy, v.wz))
            s = 2.0 / (1.0 + a.x * a.x + a.y * a.y + a.z * a.z)
            across = cross(a, r)
            return plus(r, scaled(s, plus(across, cross(a, across))))
        return r

    half_way = kernel(half_way, spec)

    def drive_forces(drives, bodies, velocities, params, counters):
        begin, dt = begin_of_part(params, counters), params.dt
        for i in range(bodies.shape[0]):
            body = bodies[i]
            body.force_x, body.force_y, body.force_z = 0.0, 0.0, 0.0
            body.torque_x, body.torque_y, body.torque_z = 0.0, 0.0, 0.0
            body.from_x, body.from_y, body.from_z = body.x, body.y, body.z
            if turns:
                body.from_qw, body.from_qx = body.qw, body.qx
                body.from_qy, body.from_qz = body.qy, body.qz
            if counters.parts == 0:
                body.pushed_x, body.pushed_y, body.pushed_z, body.worked = 0.0, 0.0, 0.0, 0.0
        for k in range(drives.records.shape[0]):
            drive = drives.records[k]
            if drive.pushes == 0:
                continue
            if not drive.begin_step <= counters.step < drive.end_step:
                continue
            body, v = bodies[drive.body], velocities[drive.body]
            factor = mean(drive, drives.knots, begin, dt)
            force = scaled(factor, Vec3(drive.fx, drive.fy, drive.fz))
            torque = scaled(factor, Vec3(drive.tx, drive.ty, drive.tz))
            if drive.in_body == 1:
                force = half_way(body, v, dt, force)
                torque = half_way(body, v, dt, torque)
            lever = half_way(body, v, dt, Vec3(drive.px, drive.py, drive.pz))
            torque = plus(torque, cross(lever, force))
            body.force_x += force.x
            body.force_y += force.y
            body.force_z += force.z
            body.torque_x += torque.x
            body.torque_y += torque.y
            body.torque_z += torque.z

    return kernel(drive_forces, spec)


def make(spec):
    """Return `kernel(body, velocity, params)`."""
    from ..applied_force import make_apply_force
    from ..vectors import Vec3

    apply_force = make_apply_force(spec)

    def varying_force(body, velocity, params):
        force = Vec3(body.force_x, body.force_y, body.force_z)
        torque = Vec3(body.torque_x, body.torque_y, body.torque_z)
        apply_force(body, velocity, force, torque, params.dt)

    return kernel(varying_force, spec)


def make_pushes(spec):
    """Return `kernel(body) -> whether` a force or a torque acts on it in this part."""

    def varying_force_acts(body):
        force = body.force_x != 0.0 or body.force_y != 0.0 or body.force_z != 0.0
        return force or body.torque_x != 0.0 or body.torque_y != 0.0 or body.torque_z != 0.0

    return kernel(varying_force_acts, spec)


def make_end_part(spec):
    """Return `kernel(state, params)`: impulse and work of a part."""
    turns = step_terms(spec).turns

    def add_work(state, params):
        bodies = state.bodies
        for i in range(bodies.shape[0]):
            body = bodies[i]
            if body.inv_m == 0.0:
                continue
            fx, fy, fz = body.force_x, body.force_y, body.force_z
            body.pushed_x += fx * params.dt
            body.pushed_y += fy * params.dt
            body.pushed_z += fz * params.dt
            done = fx * (body.x - body.from_x)
            done += fy * (body.y - body.from_y) + fz * (body.z - body.from_z)
            if turns:
                # Of q_1 times the conjugate of q_0: twice the imaginary over the real part.
                w, x, y, z = body.from_qw, body.from_qx, body.from_qy, body.from_qz
                qw, qx, qy, qz = body.qw, body.qx, body.qy, body.qz
                real = qw * w + qx * x + qy * y + qz * z
                tx = qx * w - qw * x - qy * z + qz * y
                ty = qy * w - qw * y - qz * x + qx * z
                tz = qz * w - qw * z - qx * y + qy * x
                turned = body.torque_x * tx + body.torque_y * ty + body.torque_z * tz
                if abs(real) < LEAST_REAL:
                    real = math.copysign(LEAST_REAL, real)
                if turned != 0.0:
                    done += 2.0 * turned / real
            body.worked += done

    return kernel(add_work, spec)


def make_step_row(spec):
    """Return `kernel(row, bodies, counters)` that fills its columns of a step."""

    def log_forces(row, bodies, counters):
        work, x, y, z = 0.0, 0.0, 0.0, 0.0
        for i in range(bodies.shape[0]):
            body = bodies[i]
            work += body.worked
            x, y, z = x + body.pushed_x, y + body.pushed_y, z + body.pushed_z
        row.force_work = work
        row.force_impulse_x, row.force_impulse_y, row.force_impulse_z = x, y, z

    return kernel(log_forces, spec)


_IMPULSE = "impulse of varying forces in the step, world"

EFFECT = Effect(
    name="varying_force",
    decide=decide,
    per="body",
    drives=drives,
    fields=Fields(
        body=[
            *ORIENTED_BODY,
            *[(f"force_{axis}", "f8") for axis in _AXES],  # mean of the part, world [N]
            *[(f"torque_{axis}", "f8") for axis in _AXES],  # about the centre of mass [N m]
            *[(f"from_{name}", kind) for name, kind in POSE],  # where the part begins
            *[(f"pushed_{axis}", "f8") for axis in _AXES],  # impulse of the step so far [N s]
            ("worked", "f8"),  # work of the step so far [J]
        ],
        parameters=STRETCH,
        drive=[
            ("pushes", "i8"),  # 1: it is a force
            ("in_body", "i8"),  # 1: in the body's frame
            *[(f"f{axis}", "f8") for axis in _AXES],  # [N]
            *[(f"t{axis}", "f8") for axis in _AXES],  # [N m]
            *[(f"p{axis}", "f8") for axis in _AXES],  # point, body frame [m]
        ],
    ),
    step_columns=(
        Column("force_work", "f8", "work of varying forces in the step", "J", number=40),
        Column("force_impulse_x", "f8", f"{_IMPULSE} x", "N s", number=41),
        Column("force_impulse_y", "f8", f"{_IMPULSE} y", "N s", number=42),
        Column("force_impulse_z", "f8", f"{_IMPULSE} z", "N s", number=43),
    ),
    balance=Balance(
        work="force_work",
        outer=("force_impulse_x", "force_impulse_y", "force_impulse_z"),
    ),
    hooks=Hooks(
        drive=make_drive,
        accelerate=make,
        end_part=make_end_part,
        pushes=make_pushes,
        step_row=make_step_row,
    ),
)
