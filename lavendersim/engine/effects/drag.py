"""Drag: force -(c1 + c2 |v|) v and torque -c omega, implicit, so that no step turns a body back.

With `semi_implicit_euler`, of order 1; v has the other forces of the step:
    v' = v - h (c1 + c2 |v'|) v',   h = dt/m
       = 2 v / (k + sqrt(k^2 + 4 c2 h |v|)) = S_h(v),   k = 1 + c1 h
    omega' = (1 + x)^-1 omega,   x = c dt I^-1, axis by axis in the body's frame
With `midpoint` of order 2: the rate is that of the middle, and exp(-x) is Pade's (0, 2),
    x = h (c1 + c2 |S_h/2((v_0 + v)/2)|),   v_0 as the step begins
    v' = (v_0 + (1 + x/2) (v - v_0)) / (1 + x + x^2/2),   and so omega'
Of a body that contacts push, v is known once they are solved. Where they are solved at the middle
of the step (`contact_midpoint`) v and v' have their impulses, and drag is that of both ends
(`drag_by_mean`); elsewhere impulses are added to v', of order 1.
What it changes of the velocity along a contact is known to impacts at their time: after one it is
that of the new velocity.
Explicit steps overshoot rest where x exceeds 1; these come to rest for any dt. In both a fall ends
at the very speed at which drag carries the weight.
"""

from math import sqrt
from typing import Annotated, Any

from pydantic import Field as ModelField

from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Quantity

from ..step_terms import step_terms
from ..terms import StepTerms
from .decision import Decision, Facts, named
from .effect import Balance, Effect, Fields, Hooks, Unlogged, kernel
from .keys import BodyKey


class Drag(ConfigModel):
    """What the medium does: force -(linear + quadratic |v|) v, torque -angular omega."""

    linear: Annotated[float, Quantity("N s/m", minimum=0)] = ModelField(
        default=0.0, description="[N s/m] force per speed"
    )
    quadratic: Annotated[float, Quantity("N s^2/m^2", minimum=0)] = ModelField(
        default=0.0, description="[N s^2/m^2] force per speed squared"
    )
    angular: Annotated[float, Quantity("N m s", minimum=0)] = ModelField(
        default=0.0, description="[N m s] torque per angular velocity"
    )


def body_values(body: Any) -> dict[str, float]:
    """Return the values of the body fields that a config states for a body."""
    return {f"drag_{name}": value for name, value in body.drag}


def decide(facts: Facts) -> Decision:
    """On when a movable body has a coefficient."""
    dragged = [
        body.name
        for body in facts.bodies
        if body.movable and any(body_values(body.config).values())
    ]
    if dragged:
        return Decision(True, f"{named(dragged)}: drag")
    return Decision(False, "no body has drag")


def make_start_step(spec):
    """Return `kernel(bodies, velocities)`: keep the velocities that a step begins with."""
    turns = step_terms(spec).turns

    def keep_start(bodies, velocities):
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            body.drag_vx, body.drag_vy, body.drag_vz = v.vx, v.vy, v.vz
            if turns:
                body.drag_wx, body.drag_wy, body.drag_wz = v.wx, v.wy, v.wz

    return kernel(keep_start, spec)


def make(spec):
    """Return `kernel(body, velocity, params)`."""
    drag = _make_second_order(spec) if step_terms(spec).mean_flight else _make_first_order(spec)
    if not (step_terms(spec).timed_impacts or step_terms(spec).centred):
        return drag
    turns = step_terms(spec).turns

    def noted_drag(body, velocity, params):
        x, y, z = velocity.vx, velocity.vy, velocity.vz
        wx, wy, wz = 0.0, 0.0, 0.0
        if turns:
            wx, wy, wz = velocity.wx, velocity.wy, velocity.wz
        drag(body, velocity, params)
        body.slowed_vx, body.slowed_vy = velocity.vx - x, velocity.vy - y
        body.slowed_vz = velocity.vz - z
        if turns:
            body.slowed_wx, body.slowed_wy = velocity.wx - wx, velocity.wy - wy
            body.slowed_wz = velocity.wz - wz

    return kernel(noted_drag, spec)


def make_changes(spec):
    """Return `kernel(state, count, params) -> whether` contacts change what drag does."""
    from ..drag_by_mean import make_differs_midway

    return make_differs_midway(spec)


def make_note(spec):
    """Return `kernel(bodies, velocities, lead, midway, params) -> change`: drag by both ends."""
    from ..drag_by_mean import make_note_middle

    return make_note_middle(spec)


def make_act(spec):
    """Return `kernel(bodies, poses, velocities)`: velocities get that."""
    from ..drag_by_mean import make_act_midway

    return make_act_midway(spec)


def make_slowed_n(spec):
    """Return `kernel(contact, body_a, body_b) -> v_n` that drag adds in the step [m/s]."""
    from ..collide.nearest_image import place_beside
    from ..vectors import Vec3, cross, dot, minus, plus, position

    turns, beside = step_terms(spec).turns, place_beside(spec)

    def slowed(body, arm):
        v = Vec3(body.slowed_vx, body.slowed_vy, body.slowed_vz)
        if turns:
            w = Vec3(body.slowed_wx, body.slowed_wy, body.slowed_wz)
            v = plus(v, cross(w, arm))
        return v

    slowed = kernel(slowed, spec)

    def slowed_n(contact, body_a, body_b):
        x, total = position(contact), 0.0
        n = Vec3(contact.nx, contact.ny, contact.nz)
        if body_a.inv_m > 0.0:
            total -= dot(n, slowed(body_a, minus(x, position(body_a))))
        if body_b.inv_m > 0.0:
            total += dot(n, slowed(body_b, minus(x, beside(body_a, body_b))))
        return total

    return kernel(slowed_n, spec)


def _make_second_order(spec):
    from ..rotation import to_body, to_world

    turns = step_terms(spec).turns

    def decayed(begin, driven, x):
        # What other forces alone lead from `begin` to, with a decay of x in the step.
        return (begin + (1.0 + 0.5 * x) * (driven - begin)) / (1.0 + x + 0.5 * x * x)

    decayed = kernel(decayed, spec)

    def drag(body, velocity, params):
        dt = params.dt
        if body.drag_linear > 0.0 or body.drag_quadratic > 0.0:
            bx, by, bz = body.drag_vx, body.drag_vy, body.drag_vz
            mx, my, mz = bx + velocity.vx, by + velocity.vy, bz + velocity.vz
            speed = 0.5 * sqrt(mx * mx + my * my + mz * mz)
            h = 0.5 * dt * body.inv_m
            k = 1.0 + body.drag_linear * h
            speed *= 2.0 / (k + sqrt(k * k + 4.0 * body.drag_quadratic * h * speed))
            x = 2.0 * h * (body.drag_linear + body.drag_quadratic * speed)
            velocity.vx = decayed(bx, velocity.vx, x)
            velocity.vy = decayed(by, velocity.vy, x)
            velocity.vz = decayed(bz, velocity.vz, x)
        if turns:
            if body.drag_angular > 0.0:
                bx, by, bz = to_body(body, body.drag_wx, body.drag_wy, body.drag_wz)
                x, y, z = to_body(body, velocity.wx, velocity.wy, velocity.wz)
                c = body.drag_angular * dt
                velocity.wx, velocity.wy, velocity.wz = to_world(
                    body,
                    decayed(bx, x, c * body.inv_ix),
                    decayed(by, y, c * body.inv_iy),
                    decayed(bz, z, c * body.inv_iz),
                )

    return kernel(drag, spec)


def _make_first_order(spec):
    from ..rotation import to_body, to_world

    turns = step_terms(spec).turns

    def drag(body, velocity, params):
        dt = params.dt
        if body.drag_linear > 0.0 or body.drag_quadratic > 0.0:
            vx, vy, vz = velocity.vx, velocity.vy, velocity.vz
            speed = sqrt(vx * vx + vy * vy + vz * vz)
            h = dt * body.inv_m
            k = 1.0 + body.drag_linear * h
            scale = 2.0 / (k + sqrt(k * k + 4.0 * body.drag_quadratic * h * speed))
            velocity.vx, velocity.vy, velocity.vz = vx * scale, vy * scale, vz * scale
        if turns:
            if body.drag_angular > 0.0:
                x, y, z = to_body(body, velocity.wx, velocity.wy, velocity.wz)
                c = body.drag_angular * dt
                velocity.wx, velocity.wy, velocity.wz = to_world(
                    body,
                    x / (1.0 + c * body.inv_ix),
                    y / (1.0 + c * body.inv_iy),
                    z / (1.0 + c * body.inv_iz),
                )

    return kernel(drag, spec)


def contact_fields(spec):
    """Return what contacts have where impacts have a time."""
    timed = step_terms(spec).timed_impacts
    return [("slowed_n", "f8")] if timed else []  # v_n by drag in the step [m/s]


EFFECT = Effect(
    name="drag",
    decide=decide,
    per="body",
    body_keys=(
        BodyKey(
            name="drag",
            type=Drag,
            default=Drag(),
            doc="force -(linear + quadratic |v|) v and torque -angular omega of the medium",
            of_movable=True,
        ),
    ),
    step=StepTerms(bounces_vary=True),
    balance=Balance(unlogged=Unlogged("momentum", "what the drag of {body} takes")),
    fields=Fields(
        body=[
            ("drag_linear", "f8"),  # c1 [N s/m]
            ("drag_quadratic", "f8"),  # c2 [N s^2/m^2]
            ("drag_angular", "f8"),  # c [N m s]
            # velocities that the step begins with [m/s], [rad/s]
            *[(f"drag_{k}{axis}", "f8") for k in "vw" for axis in "xyz"],
            # what drag changes of them in the step, where impacts have a time or contacts a middle
            *[(f"slowed_{k}{axis}", "f8") for k in "vw" for axis in "xyz"],
        ],
        contact_with=contact_fields,
    ),
    body_values=body_values,
    hooks=Hooks(
        start_step=make_start_step,
        accelerate=make,
        slowed_n=make_slowed_n,
        differs_midway=make_changes,
        note_middle=make_note,
        act_midway=make_act,
    ),
)
