"""Whether what contacts' rows are made of turns within a step (`effects.contact_midpoint`)."""

from __future__ import annotations

from math import sqrt
from typing import Any

from .collide.records import UNBOUNDED
from .compile import kernel
from .midpoint_rows import SAME
from .records import PLANE
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms


def make_is_turning(spec: Spec) -> Any:
    """Return `kernel(contacts, count, bodies, motion, params) -> whether the geometry changes`."""
    turns, ropes = step_terms(spec).turns, row_terms(spec).taut

    def is_turning(contacts, count, bodies, motion, params):
        for c in range(count):
            contact = contacts[c]
            ma, mb = motion[contact.a], motion[contact.b]
            x, y, z = mb.vx - ma.vx, mb.vy - ma.vy, mb.vz - ma.vz
            speed = sqrt(x * x + y * y + z * z)
            body_a, body_b = bodies[contact.a], bodies[contact.b]
            rate, size = 0.0, UNBOUNDED
            if body_a.shape != PLANE:
                size = body_a.bound
            if body_b.shape != PLANE:
                size = min(size, body_b.bound)
            if body_a.shape != PLANE and body_b.shape != PLANE:
                rate = speed / size
            if ropes:
                if contact.span > 0.0:
                    rate = max(rate, speed / contact.span)
            if turns:
                spin = sqrt(ma.wx * ma.wx + ma.wy * ma.wy + ma.wz * ma.wz)
                spin += sqrt(mb.wx * mb.wx + mb.wy * mb.wy + mb.wz * mb.wz)
                rate += spin
                speed += spin * size
            if rate * speed * params.dt > SAME:
                return True
        return False

    return kernel(is_turning, spec)
