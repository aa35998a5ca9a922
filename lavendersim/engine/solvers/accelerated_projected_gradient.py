"""Accelerated projected gradient on Coulomb's cone, around De Saxce's fixed point.

For a fixed shift s = mu |w_t| e_n the problem is convex, min 1/2 r'W r + (q + s)'r over the cones:
    x_k+1 = P_K(y_k - (w(y_k) + s) / (theta c)),   y_k+1 = x_k+1 + beta_k (x_k+1 - x_k)
with Nesterov's beta_k and a diagonal metric c that W cannot exceed (`step_bound`), eased by theta
while W along the last step allows it. The momentum is dropped where it leads uphill (O'Donoghue and
Candes 2015, gradient scheme). When what is left of the convex problem is small beside what the
shift is off, the shift follows. Impulses are inside their cones after every sweep; velocities are
linear in them, so that a sweep costs one visit for looking and one for acting, as Jacobi's.

Without the shift (`friction_cone: convex`) it is the convex relaxation of the law that is solved.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Any, NamedTuple

from ..compile import kernel
from ..cone import project_cone
from ..coupling import make_contact_velocity
from ..row_terms import row_terms
from ..spec import Spec
from . import step_bound
from .iteration import Iteration
from .jacobi import make_apply_changes
from .solver import Solver

CONTACT_FIELDS = [
    *step_bound.CONTACT_FIELDS,
    ("shift", "f8"),  # De Saxce's, mu |w_t| [m/s]
    *[(f"velocity_{k}", "f8") for k in "n12"],  # velocity at the impulses before [m/s]
    *[(f"base_{k}", "f8") for k in "n12"],  # y of the last step [N s]
    *[(f"gradient_{k}", "f8") for k in "n12"],  # w(y) without shift [m/s]
    *[(f"change_{k}", "f8") for k in "n12"],  # of the impulse, in the last sweep [N s]
]

# The convex problem is solved to this share of what its shift is off [-].
INEXACT = 0.5
# theta: eased by this factor after a step that W allowed, raised by its inverse eighth power after
# one that it did not; at least [-].
EASE, LEAST = 0.98, 1e-3
# Round-off of a step's curvature, as a share [-].
ROUND_OFF = 1e-9
# Sweeps between two evaluations of the residual.
RESIDUAL_EVERY = 8


class StepSums(NamedTuple):
    """What one contact's step, or the sum over contacts, says of the next step."""

    uphill: float  # gradient times change: above 0 the momentum is dropped
    curvature: float  # of W along the last step [J]
    bound_curvature: float  # the same as c has it, without theta
    natural_map: float  # squared, of the problem with the shift of now [m^2 kg/s^2]
    shift_defect: float  # squared, of what the shift is off


def make_advance(spec: Spec) -> Any:
    """Return `kernel(contact, velocities, beta, theta) -> StepSums`: one contact's step."""
    terms = row_terms(spec)
    friction, compliant = terms.frictional, terms.compliant
    shifts = spec.friction_cone != "convex"
    contact_velocity = make_contact_velocity(spec)

    def advance(contact, velocities, beta, theta):
        w, w1, w2 = contact_velocity(contact, velocities)
        n, one, two, mu = contact.lambda_n, 0.0, 0.0, 0.0
        if friction:
            one, two, mu = contact.lambda_1, contact.lambda_2, contact.mu
        if compliant:
            w += contact.gamma * n
        bound = contact.bound
        # How W bends along the last step, x - y, beside what was assumed.
        dn, d1, d2 = n - contact.base_n, one - contact.base_1, two - contact.base_2
        curvature = (
            dn * (w - contact.gradient_n)
            + d1 * (w1 - contact.gradient_1)
            + d2 * (w2 - contact.gradient_2)
        )
        bound_curvature = bound * (dn * dn + d1 * d1 + d2 * d2)
        # Natural map of the problem with the shift of now, and what that is off.
        step = 1.0 / bound
        x, y, z = project_cone(n - step * (w + contact.shift), one - step * w1, two - step * w2, mu)
        x, y, z = x - n, y - one, z - two
        natural_map = bound * (x * x + y * y + z * z)
        shift_defect = 0.0
        if friction and shifts:
            shift_defect = mu * sqrt(w1 * w1 + w2 * w2) - contact.shift
            shift_defect = step * shift_defect * shift_defect
        # Velocities are linear in the impulses: those at y need no visit of their own.
        cn, c1, c2 = contact.change_n, contact.change_1, contact.change_2
        base_n, base_1, base_2 = n + beta * cn, one + beta * c1, two + beta * c2
        gradient_n = w + beta * (w - contact.velocity_n)
        gradient_1 = w1 + beta * (w1 - contact.velocity_1)
        gradient_2 = w2 + beta * (w2 - contact.velocity_2)
        contact.velocity_n, contact.velocity_1, contact.velocity_2 = w, w1, w2
        contact.base_n, contact.base_1, contact.base_2 = base_n, base_1, base_2
        contact.gradient_n = gradient_n
        contact.gradient_1, contact.gradient_2 = gradient_1, gradient_2
        step = 1.0 / (theta * bound)
        x, y, z = project_cone(
            base_n - step * (gradient_n + contact.shift), base_1 - step * gradient_1,
            base_2 - step * gradient_2, mu,
        )  # fmt: skip
        x, y, z = x - n, y - one, z - two
        contact.change_n, contact.change_1, contact.change_2 = x, y, z
        contact.lambda_n = n + x
        if friction:
            contact.lambda_1, contact.lambda_2 = one + y, two + z
        uphill = (base_n - n - x) * x + (base_1 - one - y) * y + (base_2 - two - z) * z
        return StepSums(bound * uphill, curvature, bound_curvature, natural_map, shift_defect)

    return kernel(advance, spec)


def make_begin(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities)`: at rest at the impulses that there are."""
    friction = row_terms(spec).frictional
    contact_velocity = make_contact_velocity(spec)

    def begin(contacts, count, velocities):
        for c in range(count):
            contact = contacts[c]
            contact.change_n, contact.change_1, contact.change_2 = 0.0, 0.0, 0.0
            contact.base_n, contact.base_1, contact.base_2 = contact.lambda_n, 0.0, 0.0
            if friction:
                contact.base_1, contact.base_2 = contact.lambda_1, contact.lambda_2
            w, w1, w2 = contact_velocity(contact, velocities)
            contact.velocity_n, contact.velocity_1, contact.velocity_2 = w, w1, w2
            contact.gradient_n, contact.gradient_1, contact.gradient_2 = w, w1, w2
            contact.shift = 0.0

    return kernel(begin, spec)


def make_shift(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities)`: De Saxce's shift of the velocities now."""
    contact_velocity = make_contact_velocity(spec)

    def shift(contacts, count, velocities):
        for c in range(count):
            contact = contacts[c]
            _, w1, w2 = contact_velocity(contact, velocities)
            contact.shift = contact.mu * sqrt(w1 * w1 + w2 * w2)

    return kernel(shift, spec)


class Momentum(NamedTuple):
    """What accelerated gradients carry, see `iteration.Carry`."""

    aim: float
    theta: float  # how much the metric is eased [-]
    momentum: float  # Nesterov's t [-]
    beta: float  # share of the last step that the next one begins with [-]


def make(spec: Spec) -> Iteration:
    """Return the sweeps: one projected gradient step of all contacts each."""
    shifts = row_terms(spec).frictional and spec.friction_cone != "convex"
    bound = step_bound.make_bound(spec)
    begin, advance, apply_changes = make_begin(spec), make_advance(spec), make_apply_changes(spec)
    shift: Any = make_shift(spec) if shifts else None

    def prepare(system, workspace, params, counters):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        bound(contacts, count, workspace)
        begin(contacts, count, velocities)
        if shifts:
            shift(contacts, count, velocities)
        return Momentum(params.tolerance, 1.0, 1.0, 0.0)

    def sweep_accelerated(system, workspace, params, counters, carry):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        theta, momentum, beta = carry.theta, carry.momentum, carry.beta
        uphill, curvature, bound_curvature = 0.0, 0.0, 0.0
        natural_map, shift_defect = 0.0, 0.0
        for c in range(count):
            own = advance(contacts[c], velocities, beta, theta)
            uphill, curvature = uphill + own.uphill, curvature + own.curvature
            bound_curvature += own.bound_curvature
            natural_map += own.natural_map
            shift_defect += own.shift_defect
        apply_changes(contacts, count, velocities)
        allowed = curvature <= theta * bound_curvature * (1.0 + ROUND_OFF)
        theta = max(EASE * theta, LEAST) if allowed else min(theta / EASE**8, 1.0)
        if uphill > 0.0 or not allowed:
            momentum, beta = 1.0, 0.0
        else:
            longer = 0.5 * (1.0 + sqrt(1.0 + 4.0 * momentum * momentum))
            momentum, beta = longer, (momentum - 1.0) / longer
        if shifts:
            if natural_map <= INEXACT * INEXACT * shift_defect:
                shift(contacts, count, velocities)
        # A step may be short far from the solution: its changes say nothing.
        return inf, Momentum(carry.aim, theta, momentum, beta)

    return Iteration(
        kernel(sweep_accelerated, spec),
        prepare=kernel(prepare, spec),
        residual_every=RESIDUAL_EVERY,
    )


SOLVER = Solver(
    name="accelerated_projected_gradient",
    iteration=make,
    allocate=step_bound.allocate,
    contact_fields=CONTACT_FIELDS,
)
