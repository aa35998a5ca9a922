"""A vector enters, the nearest one in Coulomb's cone leaves.

K = {|r_t| <= mu r_n}       its dual K* = {|u_t| mu <= u_n}       (n, t1, t2), Euclidean norm
"""

from __future__ import annotations

from math import sqrt

from .compile import inner


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
