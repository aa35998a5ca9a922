"""Gyroscopic term: bodies with unequal principal inertias precess at constant angular momentum.

Implicit midpoint on the rotation at constant world momentum L = I omega:
    omega_m = I(q_m)^-1 L,  q_m = q turned by omega_m dt / 2   (fixed point)
    q' = q turned by omega_m dt,  omega' = I(q')^-1 L
L is kept to round-off by construction; the energy error is second order in dt.
"""

from ..compile import kernel
from ..rotation import inertia_times, inverse_inertia_times, orient, turn
from .decision import Decision, Facts, named

NAME = "gyroscopic"
STAGE = "integrate"
# The fixed point contracts by about |omega| dt / 2 a pass; four passes leave |omega dt|^4 / 16.
PASSES = 4


def wanted(facts: Facts) -> Decision:
    """On when a movable body that may turn has unequal principal inertias."""
    uneven = [
        body.name
        for body in facts.bodies
        if body.movable
        and not body.round
        and (body.spins or (body.shape == "box" and bool(facts.pairs)))
    ]
    if uneven:
        return Decision(True, f"{named(uneven)}: unequal principal inertias and may turn")
    return Decision(False, "no body that may turn has unequal principal inertias")


def make(spec):
    """Return `kernel(body, velocity, dt)` that replaces the plain turn."""

    def integrate_gyroscopic(body, velocity, dt):
        wx, wy, wz = velocity.wx, velocity.wy, velocity.wz
        if wx == 0.0 and wy == 0.0 and wz == 0.0:
            return
        lx, ly, lz = inertia_times(body, wx, wy, wz)
        qw, qx, qy, qz = body.qw, body.qx, body.qy, body.qz
        for _ in range(PASSES):
            body.qw, body.qx, body.qy, body.qz = qw, qx, qy, qz
            turn(body, 0.5 * dt * wx, 0.5 * dt * wy, 0.5 * dt * wz)
            wx, wy, wz = inverse_inertia_times(body, lx, ly, lz)
        body.qw, body.qx, body.qy, body.qz = qw, qx, qy, qz
        orient(body)
        turn(body, dt * wx, dt * wy, dt * wz)
        velocity.wx, velocity.wy, velocity.wz = inverse_inertia_times(body, lx, ly, lz)

    return kernel(integrate_gyroscopic, spec)
