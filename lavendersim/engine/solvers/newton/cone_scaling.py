"""Nesterov and Todd's scaling of a contact whose impulse and velocity are inside their cones.

The circular cone |x_t| <= x_n is its own dual, and Coulomb's is brought to it by the coefficient:
    x = (mu lambda_n, lambda_t),    z = (u_n / mu, u_t),
u the velocity with De Saxce's shift. H is the symmetric matrix with z = H x whose root brings both
to one point, H = b (2 w w^T - R), R = diag(1, -1, -1), w^T R w = 1 (Nesterov and Todd 1997, as in
`problems.interior_point`). A contact without friction has its normal alone.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Any, NamedTuple

from ...compile import inner, kernel
from ...row_terms import row_terms
from ...spec import Spec
from ...vectors import Vec3
from .envelope import DOF, SCALED, T1, T2

TINY = 1e-300
# Softness of a contact, as a share of its own response: a bound on its gain [-]. Gains grow without
# end as a contact's state is found, and digits of what bodies do with them. It changes the way, not
# where it ends.
SOFTNESS = 1e-6


class ConePoint(NamedTuple):
    """An impulse and a velocity, of circular cones."""

    x: Vec3
    z: Vec3
    mu: float  # 1 without friction
    frictional: bool


class Scaling(NamedTuple):
    """H."""

    b: float
    w: Vec3


class Gain(NamedTuple):
    """What impulses lose as velocities grow, in the contact's frame [kg]; not symmetric."""

    nn: float
    n1: float
    n2: float
    one_n: float
    t11: float
    t12: float
    two_n: float
    t21: float
    t22: float


@inner
def determinant(x):
    """Return x_n^2 - |x_t|^2, positive inside the cone."""
    side = sqrt(x.y * x.y + x.z * x.z)
    return (x.x - side) * (x.x + side)


def make_cone_point(spec: Spec) -> Any:
    """Return `kernel(contact, impulse, velocity) -> ConePoint`; both along n, t1, t2."""
    mixed = row_terms(spec).frictionless

    def cone_point(contact, impulse, velocity):
        frictional = contact.mu > 0.0
        if mixed:
            frictional = frictional and contact.frictional == 1
        if not frictional:
            return ConePoint(Vec3(impulse.x, 0.0, 0.0), Vec3(velocity.x, 0.0, 0.0), 1.0, False)
        mu = contact.mu
        x = Vec3(mu * impulse.x, impulse.y, impulse.z)
        return ConePoint(x, Vec3(velocity.x / mu, velocity.y, velocity.z), mu, True)

    return kernel(cone_point, spec)


@inner
def impulse_of(contact):
    """Return the impulse of a contact."""
    return Vec3(contact.lambda_n, contact.lambda_1, contact.lambda_2)


@inner
def velocity_inside(contact):
    """Return the velocity of a contact that is kept inside its cone, with the shift."""
    return Vec3(contact.velocity_n, contact.velocity_1, contact.velocity_2)


@inner
def scaling_of(x, z):
    """Return H of a point inside."""
    root_x, root_z = sqrt(max(determinant(x), TINY)), sqrt(max(determinant(z), TINY))
    product = (x.x * z.x + x.y * z.y + x.z * z.z) / (root_x * root_z)
    share = 1.0 / sqrt(2.0 * (1.0 + max(product, 1.0)))
    return Scaling(
        root_z / root_x,
        Vec3(
            share * (x.x / root_x + z.x / root_z),
            share * (z.y / root_z - x.y / root_x),
            share * (z.z / root_z - x.z / root_x),
        ),
    )


@inner
def unscaled(scaling, softness, y):
    """Return (H + softness)^-1 y; by the axes of H, so that none drowns in another's digits."""
    w = scaling.w
    side = sqrt(w.y * w.y + w.z * w.z)
    stretch = (w.x + side) * (w.x + side)
    out, back = scaling.b * stretch + softness, scaling.b / stretch + softness
    around = scaling.b + softness
    if side == 0.0:
        return Vec3(y.x / around, y.y / around, y.z / around)
    u, v = w.y / side, w.z / side
    along = u * y.y + v * y.z
    p, q = 0.5 * (y.x + along) / out, 0.5 * (y.x - along) / back
    rest = (u * y.z - v * y.y) / around
    return Vec3(p + q, u * (p - q) - v * rest, v * (p - q) + u * rest)


@inner
def to_boundary(x, d):
    """Return the length at which x + length d leaves the cone first; infinite if never."""
    a = d.x * d.x - d.y * d.y - d.z * d.z
    b, c = x.x * d.x - x.y * d.y - x.z * d.z, determinant(x)
    inside, least = b * b - a * c, inf
    if inside >= 0.0:
        root = sqrt(inside)
        if root > b:
            least = c / (root - b)
        if root < -b:
            least = min(least, c / (-b - root))
    if d.x < 0.0:
        least = min(least, -x.x / d.x)
    return least


def make_gain(spec: Spec) -> Any:
    """Return `kernel(contact) -> Gain`: T (H + softness)^-1 C^-1 T, with C = I - e_n d^T.

    T brings circular cones back to Coulomb's, and d is the direction of slip, by which the shift
    grows; contact.scale: 1, or 0 where the shift is taken to stay.
    """
    cone_point = make_cone_point(spec)

    def gain(contact):
        softness = SOFTNESS / contact.inv_k
        p = cone_point(contact, impulse_of(contact), velocity_inside(contact))
        scaling = scaling_of(p.x, p.z)
        normal = unscaled(scaling, softness, Vec3(1.0, 0.0, 0.0))
        if not p.frictional:
            return Gain(normal.x, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        one = unscaled(scaling, softness, Vec3(0.0, 1.0, 0.0))
        two = unscaled(scaling, softness, Vec3(0.0, 0.0, 1.0))
        side = sqrt(p.z.y * p.z.y + p.z.z * p.z.z)
        d_1, d_2 = 0.0, 0.0
        if side > 0.0:
            d_1, d_2 = contact.scale * p.z.y / side, contact.scale * p.z.z / side
        t = 1.0 / p.mu
        return Gain(
            t * t * normal.x, t * (one.x + d_1 * normal.x), t * (two.x + d_2 * normal.x),
            t * normal.y, one.y + d_1 * normal.y, two.y + d_2 * normal.y,
            t * normal.z, one.z + d_1 * normal.z, two.z + d_2 * normal.z,
        )  # fmt: skip

    return kernel(gain, spec)


def make_scale_by_gain(spec: Spec) -> Any:
    """Return `kernel(rows, source, h)`: the scaled rows are the gain times those from `source`."""

    def scale_by_gain(rows, source, h):
        for j in range(DOF):
            n, one, two = rows[source, j], rows[source + T1, j], rows[source + T2, j]
            rows[SCALED, j] = h.nn * n + h.n1 * one + h.n2 * two
            rows[SCALED + T1, j] = h.one_n * n + h.t11 * one + h.t12 * two
            rows[SCALED + T2, j] = h.two_n * n + h.t21 * one + h.t22 * two

    return kernel(scale_by_gain, spec)


def make_scale_by_gain_transposed(spec: Spec) -> Any:
    """Return the same kernel for the gain transposed."""

    def scale_transposed_gain(rows, source, h):
        for j in range(DOF):
            n, one, two = rows[source, j], rows[source + T1, j], rows[source + T2, j]
            rows[SCALED, j] = h.nn * n + h.one_n * one + h.two_n * two
            rows[SCALED + T1, j] = h.n1 * n + h.t11 * one + h.t21 * two
            rows[SCALED + T2, j] = h.n2 * n + h.t12 * one + h.t22 * two

    return kernel(scale_transposed_gain, spec)
