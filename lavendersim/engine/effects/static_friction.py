"""Static friction: what sticks holds more than what slides; Stribeck's velocity lies between.

    mu(v) = mu_k + (mu_s - mu_k) / (1 + (v / v_s)^2)
v is the slip speed at which the step begins, before forces act; mu_k the pair's `friction`, mu_s
its `static_friction`, v_s its `stribeck_velocity`, at which half of the difference is left. The
falling coefficient is Stribeck's, the algebraic form that of Hess and Soom (1990; cited as
background, not opened): no exponential, whose last bit differs between machines. Each step solves
Coulomb's law with the coefficient that its beginning gives (lagged), so no solver knows of it, and
the motion of what slides is of first order in the timestep; what rests holds up to mu_s at any.

A pair's static coefficient is the geometric mean of its surfaces', as the kinetic one is. Without
kinetic friction a contact has no tangents to hold it by: a surface with the one alone is refused.
"""

from typing import Annotated

from lavendersim.quantities.quantity import Quantity

from ..spec import Spec
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Balance, Effect, Fields, Hooks, Kernel, kernel
from .keys import COEFFICIENT, SurfaceKey, geometric_mean, larger


def _is_static(pair: PairFacts[str]) -> bool:
    return bool(0.0 < pair.surface.friction < pair.surface.static_friction)


def _reason(pair: PairFacts[str]) -> str:
    if not _is_static(pair):
        return ""
    at_rest, speed = pair.surface.static_friction, pair.surface.stribeck_velocity
    return f"{at_rest:g} at rest, {pair.surface.friction:g} well above {speed:g} m/s"


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch has more friction at rest than while it slides."""
    if any(_is_static(pair) for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _reason))
    return Decision(False, "no pair that may touch has friction and more of it at rest")


def make_start_step(spec: Spec) -> Kernel:
    """Return `kernel(bodies, velocities)`: keep the velocities that a step begins with."""

    def keep_start(bodies, velocities):
        for i in range(bodies.shape[0]):
            v = velocities[i]
            v.start_vx, v.start_vy, v.start_vz = v.vx, v.vy, v.vz
            v.start_wx, v.start_wy, v.start_wz = v.wx, v.wy, v.wz

    return kernel(keep_start, spec)


def make_prepare(spec: Spec) -> Kernel:
    """Return `kernel(contact, va, vb, pair, params)`: mu at the slip that the step begins with."""
    from ..row_terms import row_terms
    from . import has_hook

    moving_surface, terms = has_hook(spec, "surface_velocity"), row_terms(spec)
    stretched, coupled = terms.stretched, terms.coupled

    def set_friction(contact, va, vb, pair, params):
        if pair.static_friction > pair.friction and pair.friction > 0.0:
            x = (
                vb.start_vx + vb.start_wy * contact.rbz - vb.start_wz * contact.rby
                - va.start_vx - va.start_wy * contact.raz + va.start_wz * contact.ray
            )  # fmt: skip
            y = (
                vb.start_vy + vb.start_wz * contact.rbx - vb.start_wx * contact.rbz
                - va.start_vy - va.start_wz * contact.rax + va.start_wx * contact.raz
            )  # fmt: skip
            z = (
                vb.start_vz + vb.start_wx * contact.rby - vb.start_wy * contact.rbx
                - va.start_vz - va.start_wx * contact.ray + va.start_wy * contact.rax
            )  # fmt: skip
            if coupled:
                spin = contact.nx * (vb.start_wx - va.start_wx)
                spin += contact.ny * (vb.start_wy - va.start_wy)
                spin += contact.nz * (vb.start_wz - va.start_wz)
                x += spin * contact.patch_x
                y += spin * contact.patch_y
                z += spin * contact.patch_z
            v_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
            v_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
            if moving_surface:
                v_1 += contact.surface_1
                v_2 += contact.surface_2
            squared = v_1 * v_1 + v_2 * v_2
            if stretched:
                squared = v_1 * v_1 * contact.ease_1 + v_2 * v_2 * contact.ease_2
            ratio = squared / (pair.stribeck_velocity * pair.stribeck_velocity)
            contact.mu = pair.friction + (pair.static_friction - pair.friction) / (1.0 + ratio)

    return kernel(set_friction, spec)


EFFECT = Effect(
    name="static_friction",
    decide=decide,
    per="contact",
    needs=("friction",),
    surface_keys=(
        SurfaceKey(
            name="static_friction",
            type=COEFFICIENT,
            default=0.0,
            doc="coefficient at rest, where above `friction`, which must then be above 0 as well; "
            "a pair takes the geometric mean",
            mix=geometric_mean,
            needs="friction",
        ),
        SurfaceKey(
            name="stribeck_velocity",
            type=Annotated[float, Quantity("m/s", above=0)],
            default=0.001,
            doc="[m/s] slip at which half of what static friction adds is left; the larger of two",
            mix=larger,
        ),
    ),
    fields=Fields(
        velocity=[(f"start_{k}{axis}", "f8") for k in "vw" for axis in "xyz"],  # [m/s], [rad/s]
        pair=[("static_friction", "f8"), ("stribeck_velocity", "f8")],  # [-], [m/s]
    ),
    balance=Balance(varies_friction="static_friction"),
    hooks=Hooks(start_step=make_start_step, prepare=make_prepare),
)
