"""How far a point of a body can move in the next step: a bound for speculative contacts.

    reach = |v| dt + |omega| R dt + 2 |g| dt^2,   R radius about the centre of mass that holds it

The narrow phase must not make speculative contacts beyond the sum of two reaches and TOUCHING.
Where it makes some, forces have acted on v and omega before pairs are looked for, and the first two
terms are its own bound (`integrate.make_begin`); what gravity adds in two steps is a margin, which
what nothing can push has not. What springs of contacts may give a body counts as its speed.
Without speculative contacts only what touches when the step begins matters, and velocities may be
those before forces.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...row_terms import row_terms
from ...spec import Spec
from ...step_terms import step_terms


def make_reach(spec: Spec):
    """Return `kernel(body, velocity, params) -> reach [m]`; a body with parts has its own bound."""
    turns, springs = step_terms(spec).turns, row_terms(spec).elastic

    def reach(body, velocity, params):
        vx, vy, vz = velocity.vx, velocity.vy, velocity.vz
        speed = sqrt(vx * vx + vy * vy + vz * vz)
        if turns:
            wx, wy, wz = velocity.wx, velocity.wy, velocity.wz
            speed += sqrt(wx * wx + wy * wy + wz * wz) * body.bound
        if springs:
            speed += velocity.released
        far = speed * params.dt
        if body.inv_m > 0.0:
            gx, gy, gz = params.gx, params.gy, params.gz
            far += 2.0 * sqrt(gx * gx + gy * gy + gz * gz) * params.dt * params.dt
        return far

    return kernel(reach, spec)
