"""How the gap of a body inside a cavity closes in free flight, since the wall curves towards it.

A point that flies at v from rho off the centre or the axis meets the wall, R = rho + g, at

    |d + v t| = R:   T = (rho v_n + sqrt((rho v_n)^2 + |v|^2 (R^2 - rho^2))) / |v|^2

v_n: rate of its gap g. What is foreseen reckons with a constant acceleration of the gap: the one
that closes it at T, or where that is after the part the one at its start, -(|v|^2 - v_n^2) / R.
The point is the centre of a ball or of a capsule's end, a corner, or what of a round side is
nearest.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from .collide.manifold.cavity_points import make_axis, make_from_centre
from .collide.shape_kernels import make_radius
from .compile import kernel
from .records import BOX, CAPSULE, HULL, SPHERE
from .spec import Spec
from .step_terms import step_terms
from .vectors import Vec3, cross, dot, length, minus, plus, plus_scaled, position


def make_closing(spec: Spec) -> Any:
    """Return `kernel(contact, pair, bodies, motion, left) -> acceleration` of its gap [m/s^2].

    contact: of a pair whose B is inside of A; left: of the part that is foreseen [s].
    """
    turns, axis_of, from_centre = step_terms(spec).turns, make_axis(spec), make_from_centre(spec)
    radius = make_radius(spec)

    def closing(contact, pair, bodies, motion, left):
        cavity, body = bodies[pair.a], bodies[pair.b]
        ma, mb = motion[contact.a], motion[contact.b]
        n = Vec3(contact.nx, contact.ny, contact.nz)
        grown = 0.0
        if body.shape == SPHERE or body.shape == CAPSULE:
            grown = radius(body)
        core = plus_scaled(position(contact), 0.5 * contact.phi + grown, n)
        v = Vec3(mb.vx - ma.vx, mb.vy - ma.vy, mb.vz - ma.vz)
        pulled = 0.0
        if turns:
            w, arm = Vec3(mb.wx, mb.wy, mb.wz), minus(core, position(bodies[contact.b]))
            turned = cross(w, arm)
            v = plus(v, turned)
            if grown > 0.0 or body.shape == BOX or body.shape == HULL:  # a point of the body
                pulled = dot(n, cross(w, turned))
        axis = axis_of(cavity)
        v = plus_scaled(v, -dot(v, axis), axis)
        rho, gap, squared = length(from_centre(cavity, core)), max(contact.phi, 0.0), dot(v, v)
        wall, rate = rho + gap, dot(n, v)
        if squared == 0.0 or wall == 0.0:
            return pulled
        inwards = rho * rate
        t = (inwards + sqrt(inwards * inwards + squared * gap * (rho + wall))) / squared
        if 0.0 < t < left:
            return pulled - 2.0 * (gap + rate * t) / (t * t)
        return pulled - (squared - rate * rate) / wall

    return kernel(closing, spec)
