"""Anisotropic friction: a surface with a grain has one coefficient along it and one across.

    lambda_t = mu lambda_n M u, |u| <= 1         the section of the cone is an ellipse
    M = 1 + (q - 1)(1 - g g^T)                   of one grain g: mu along it, q mu across
M acts in the tangent plane; g is the grain's unit vector, and what of it lies along the normal is
lost: end grain, g = n, has q mu in every direction. What slides obeys maximum dissipation: of the
ellipse the impulse that takes most energy, lambda_t = -mu lambda_n M^2 v / |M v|. So the force is
not against the slip, and a path curves. So the normal cone of a set of forces gives it (doi
10.1007/s11071-019-04829-6, abstract read), and a slider on a turning table showed it: the force
across the slip is the derivative, by its direction, of that along it (doi
10.1140/epjti/s40485-016-0029-y, abstract read).

With tangents M t1, M t2 in place of t1, t2 both laws are Coulomb's of a disc, |l| <= mu lambda_n
against M v: the ellipse's axes are taken as tangents, each times its ratio (`stretch`), so no
solver knows of it.

Of two grains each counts half: M = A # B, the geometric mean of the two surfaces' M with the ratio
of the pair (of 2x2 matrices (A/a + B/b) sqrt(a b / det), a^2 = det A, b^2 = det B). Along each
other that is the pair's ellipse; across each other, a disc. This mean and end grain are ours.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import sqrt
from typing import Annotated, Any

from lavendersim.quantities.quantity import Quantity, Vector, Vector3

from ..records import ORIENTED_BODY
from ..spec import Spec
from ..terms import RowTerms
from .decision import Decision, Facts, named
from .effect import Balance, Column, Effect, Fields, Hooks, Kernel, kernel
from .keys import BodyKey, SurfaceKey, Turn, mean_above_zero

SECTION = "the tangential impulse is impulse_n F u, |u| <= 1"


def resolve(value: Vector3, turn: Turn) -> Vector3:
    """Return the direction in the frame of the principal axes."""
    return turn(value)


def body_values(body: Any) -> dict[str, float]:
    """Return the unit vector of a body's grain in its frame; 0 without one."""
    x, y, z = body.grain
    size = sqrt(x * x + y * y + z * z)
    scale = 1.0 / size if size > 0.0 else 0.0
    return {"grain_x": x * scale, "grain_y": y * scale, "grain_z": z * scale}


def decide(facts: Facts) -> Decision:
    """On when a body has a grain and contacts of a pair more or less friction across one."""
    grained = [body.name for body in facts.bodies if any(body.config.grain)]
    if not grained:
        return Decision(False, "no body has a grain")
    ratios = {
        pair.surface.across_grain
        for pair in facts.pairs
        if pair.surface.friction > 0.0 and pair.surface.across_grain > 0.0
    }
    if ratios:
        listed = ", ".join(f"{ratio:g}" for ratio in sorted(ratios))
        return Decision(True, f"{named(grained)}: a grain; friction across by along it {listed}")
    return Decision(False, f"{named(grained)}: a grain, but nothing has friction across one")


def excludes(config: Any) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """Yield what is specified in vain, and laws that are of unit tangents."""
    bodies = config.scene.bodies
    grained = [name for name, body in bodies.items() if any(body.grain)]
    surfaces = [body.surface for body in bodies.values()]
    partners = [one for surface in surfaces for one in getattr(surface, "partners", ())]
    if grained and not any((one.across_grain or 0.0) > 0.0 for one in (*surfaces, *partners)):
        sentence = "no surface has friction across a grain; expected across_grain beside friction"
        yield ("scene", "bodies", grained[0], "grain"), sentence
    for name, body in bodies.items():
        own = (body.surface, *getattr(body.surface, "partners", ()))
        place = ("scene", "bodies", name, "surface")
        if not grained and any((one.across_grain or 0.0) > 0.0 for one in own):
            yield (*place, "across_grain"), "no body has a grain; expected one with its direction"
        if grained and any((one.rolling_friction or 0.0) > 0.0 for one in own):
            sentence = "its torques have no ellipse, and a body has a grain; expected 0"
            yield (*place, "rolling_friction"), sentence
    if grained and config.numerics.friction_cone == "pyramid":
        sentence = "a body has a grain, whose section is an ellipse; expected disc or convex"
        yield ("numerics", "friction_cone"), sentence


def make_section(spec: Spec) -> Kernel:
    """Return `kernel(x, y, q) -> (a, b, c)`: M = [[a, b], [b, c]] of a grain's tangential part."""

    def section(x, y, q):
        less = 1.0 - q
        return q + less * x * x, less * x * y, q + less * y * y

    return kernel(section, spec)


def make_mean(spec: Spec) -> Kernel:
    """Return `kernel(one, other) -> (a, b, c)`: the geometric mean of two of those."""

    def mean(one, other):
        size = sqrt(one[0] * one[2] - one[1] * one[1])
        size_of_other = sqrt(other[0] * other[2] - other[1] * other[1])
        a = one[0] / size + other[0] / size_of_other
        b = one[1] / size + other[1] / size_of_other
        c = one[2] / size + other[2] / size_of_other
        scale = sqrt(size * size_of_other / (a * c - b * b))
        return a * scale, b * scale, c * scale

    return kernel(mean, spec)


def make_axes(spec: Spec) -> Kernel:
    """Return `kernel(a, b, c) -> (more, less, x, y)`: eigenvalues; unit vector of the first."""

    def axes(a, b, c):
        half = 0.5 * (a - c)
        radius = sqrt(half * half + b * b)
        more = 0.5 * (a + c) + radius
        if radius == 0.0:
            return more, more, 1.0, 0.0
        # Of the two columns of M - less 1 the longer one: no difference of near numbers.
        x, y = (radius + half, b) if half >= 0.0 else (b, radius - half)
        size = sqrt(x * x + y * y)
        return more, (a * c - b * b) / more, x / size, y / size

    return kernel(axes, spec)


def make_stretch(spec: Spec) -> Kernel:
    """Return `kernel(contact, body_a, body_b, pair)`: its tangents along the ellipse's axes."""
    from ..rotation import to_world

    section, mean, axes = make_section(spec), make_mean(spec), make_axes(spec)

    def along_tangents(contact, body):
        x, y, z = to_world(body, body.grain_x, body.grain_y, body.grain_z)
        one = contact.t1x * x + contact.t1y * y + contact.t1z * z
        return one, contact.t2x * x + contact.t2y * y + contact.t2z * z

    along_tangents = kernel(along_tangents, spec)

    def has_grain(body):
        return body.grain_x != 0.0 or body.grain_y != 0.0 or body.grain_z != 0.0

    has_grain = kernel(has_grain, spec)

    def stretch(contact, body_a, body_b, pair):
        contact.ease_1, contact.ease_2, contact.stretched = 1.0, 1.0, 0
        grain_a, grain_b = has_grain(body_a), has_grain(body_b)
        if pair.across_grain == 0.0 or not (grain_a or grain_b):
            return
        x, y = along_tangents(contact, body_a if grain_a else body_b)
        m = section(x, y, pair.across_grain)
        if grain_a and grain_b:
            x, y = along_tangents(contact, body_b)
            m = mean(m, section(x, y, pair.across_grain))
        more, less, x, y = axes(m[0], m[1], m[2])
        ax, ay, az = contact.t1x, contact.t1y, contact.t1z
        bx, by, bz = contact.t2x, contact.t2y, contact.t2z
        contact.t1x = more * (x * ax + y * bx)
        contact.t1y = more * (x * ay + y * by)
        contact.t1z = more * (x * az + y * bz)
        contact.t2x = less * (x * bx - y * ax)
        contact.t2y = less * (x * by - y * ay)
        contact.t2z = less * (x * bz - y * az)
        contact.ease_1, contact.ease_2 = 1.0 / (more * more), 1.0 / (less * less)
        contact.stretched = 1

    return kernel(stretch, spec)


def make_contact_row(spec: Spec) -> Kernel:
    """Return `kernel(out, contact, va, vb)`: the log has unit tangents, as without a grain.

    And the coefficient in the direction of the impulse, so that |lambda_t| <= mu lambda_n holds.
    """
    from ..block import t1_of, t2_of

    def log_ellipse(out, contact, va, vb):
        out.friction_11, out.friction_12, out.friction_22 = contact.mu, 0.0, contact.mu
        if contact.stretched == 0:
            return
        nx, ny, nz = contact.nx, contact.ny, contact.nz
        side = 1.0 if nz >= 0.0 else -1.0
        ax, ay, az = t1_of(nx, ny, nz, side)
        bx, by, bz = t2_of(nx, ny, nz, side)
        out.t1x, out.t1y, out.t1z = ax, ay, az
        # Of the unit tangents (c, d) along the long axis: mu (s_1 e e^T + s_2 f f^T), f across e.
        s_1, s_2 = contact.mu / sqrt(contact.ease_1), contact.mu / sqrt(contact.ease_2)
        c = sqrt(contact.ease_1) * (ax * contact.t1x + ay * contact.t1y + az * contact.t1z)
        d = sqrt(contact.ease_1) * (bx * contact.t1x + by * contact.t1y + bz * contact.t1z)
        out.friction_11 = s_1 * c * c + s_2 * d * d
        out.friction_12 = (s_1 - s_2) * c * d
        out.friction_22 = s_1 * d * d + s_2 * c * c
        one, two = contact.lambda_1, contact.lambda_2
        x = contact.t1x * one + contact.t2x * two
        y = contact.t1y * one + contact.t2y * two
        z = contact.t1z * one + contact.t2z * two
        out.impulse_t1, out.impulse_t2 = ax * x + ay * y + az * z, bx * x + by * y + bz * z
        length = sqrt(one * one + two * two)
        out.friction = s_2
        if length > 0.0:
            out.friction = contact.mu * sqrt(x * x + y * y + z * z) / length
        one, two = out.slip_t1 * contact.ease_1, out.slip_t2 * contact.ease_2
        x = contact.t1x * one + contact.t2x * two
        y = contact.t1y * one + contact.t2y * two
        z = contact.t1z * one + contact.t2z * two
        out.slip_t1, out.slip_t2 = ax * x + ay * y + az * z, bx * x + by * y + bz * z

    return kernel(log_ellipse, spec)


EFFECT = Effect(
    name="anisotropic_friction",
    decide=decide,
    per="contact",
    row=RowTerms(stretched=True),
    needs=("friction",),
    excludes=excludes,
    surface_keys=(
        SurfaceKey(
            name="across_grain",
            type=Annotated[float, Quantity(minimum=0)],
            default=0.0,
            doc="friction across a body's `grain` by that along it, which is `friction`, 0: no "
            "difference; a pair takes the geometric mean of those above 0",
            mix=mean_above_zero,
            needs="friction",
        ),
    ),
    body_keys=(
        BodyKey(
            name="grain",
            type=Annotated[Vector3, Vector(3, Quantity())],
            default=(0.0, 0.0, 0.0),
            doc="direction of the grain in the body's frame, along which `friction` holds and "
            "across which `across_grain` of it, any length; 0, 0, 0: none",
            resolve=resolve,
        ),
    ),
    balance=Balance(varies_friction="across_grain"),
    fields=Fields(
        body=[*ORIENTED_BODY, ("grain_x", "f8"), ("grain_y", "f8"), ("grain_z", "f8")],  # unit
        pair=[("across_grain", "f8")],  # q [-]
        contact=[
            ("ease_1", "f8"),  # 1 / |t1|^2, of the stretched tangent [-]
            ("ease_2", "f8"),
            ("stretched", "i8"),  # 0: the tangents are of unit length
        ],
    ),
    body_values=body_values,
    contact_columns=(
        Column("friction_11", "f8", f"of the matrix F along t1 and t2: {SECTION}", "-"),
        Column("friction_12", "f8", f"of the matrix F along t1 and t2: {SECTION}", "-"),
        Column("friction_22", "f8", f"of the matrix F along t1 and t2: {SECTION}", "-"),
    ),
    hooks=Hooks(stretch_tangents=make_stretch, contact_row=make_contact_row),
)
