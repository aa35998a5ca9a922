"""Projections onto Coulomb's cone, and onto a section across it.

K = {|r_t| <= mu r_n}       its dual K* = {|u_t| mu <= u_n}       (n, t1, t2), Euclidean norm
"""

from __future__ import annotations

from math import sqrt

from .compile import inner, kernel
from .spec import Spec

# By how much a length is beyond another that it was made as long as [-].
ROUND_OFF = 1e-13


@inner
def project_cone(n, one, two, mu):
    """Return the nearest point of K to (n, one, two)."""
    radius = sqrt(one * one + two * two)
    # Without friction and slip mu n is -0.0 for a contact that pulls, and no radius exceeds it.
    if n >= 0.0 and radius <= mu * n:
        return n, one, two
    along = n + mu * radius
    if along <= 0.0:
        return 0.0, 0.0, 0.0
    n = along / (1.0 + mu * mu)
    # The radius is positive here: radius = 0 and along > 0 would have been inside.
    scale = mu * n / radius
    return n, one * scale, two * scale


@inner
def within(x, most):
    """Return x, brought to -most or most where it is beyond; a NaN stays."""
    if x > most:
        return most
    if x < -most:
        return -most
    return x


@inner
def project_disc(one, two, limit):
    """Return the nearest point of the disc of radius `limit` to (one, two)."""
    squared = one * one + two * two
    if squared > limit * limit:
        scale = limit / sqrt(squared)
        return one * scale, two * scale
    return one, two


@inner
def project_square(one, two, limit):
    """Return the nearest point of the square of half width `limit` to (one, two)."""
    return min(max(one, -limit), limit), min(max(two, -limit), limit)


def make_are_within(spec: Spec):
    """Return `kernel(contacts, count)`: whether impulses lie within their cones, but for rounding.

    Of rows without friction, of which mu is 0, nothing is said.
    """
    square = spec.friction_cone == "pyramid"

    def are_within(contacts, count):
        for c in range(count):
            contact = contacts[c]
            one, two = contact.lambda_1, contact.lambda_2
            most = (1.0 + ROUND_OFF) * contact.mu * contact.lambda_n
            if contact.mu == 0.0:
                continue
            if square:
                if abs(one) > most or abs(two) > most:
                    return False
            elif one * one + two * two > most * most:
                return False
        return True

    return kernel(are_within, spec)


def make_project_section(spec: Spec):
    """Return `kernel(one, two, limit)`: onto the section of the cone, or of its pyramid."""
    return project_square if spec.friction_cone == "pyramid" else project_disc
