"""Accelerated projected gradient on Coulomb's cone, around De Saxce's fixed point.

For a held shift s = mu |w_t| e_n the problem is convex, min 1/2 r'W r + (q + s)'r over the cones:
    x_k+1 = P_K(y_k - (w(y_k) + s) / (theta c)),   y_k+1 = x_k+1 + beta_k (x_k+1 - x_k)
with Nesterov's beta_k and a diagonal metric c that W cannot exceed (`step_bound`), eased by theta
while W along the last step allows it. The momentum is dropped where it leads uphill (O'Donoghue and
Candes 2015, gradient scheme). When what is left of the convex problem is small beside what the
shift is off, the shift follows. Impulses are inside their cones after every sweep; velocities are
linear in them, so that a sweep costs one visit for looking and one for acting, as Jacobi's.

Without the shift (`friction_cone: convex`) it is the convex relaxation of the law that is solved.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from ..compile import kernel
from ..cone import project_cone
from ..coupling import make_contact_velocity
from ..residual import make_residual
from ..spec import Spec
from . import step_bound
from .jacobi import make_act
from .solver import Solver
from .sweep import make_account, make_note

CONTACT_FIELDS = [
    *step_bound.CONTACT_FIELDS,
    ("shift", "f8"),  # mu |w_t| as held [m/s]
    *[(f"seen_{k}", "f8") for k in "n12"],  # velocity at the impulses before [m/s]
    *[(f"base_{k}", "f8") for k in "n12"],  # y of the last step [N s]
    *[(f"pull_{k}", "f8") for k in "n12"],  # w(y) without shift [m/s]
    *[(f"change_{k}", "f8") for k in "n12"],  # of the impulse, in the last sweep [N s]
]

# The convex problem is solved to this share of what its shift is off [-].
INEXACT = 0.5
# theta: eased by this factor after a step that W allowed, raised by its inverse eighth power after
# one that it did not; at least [-].
EASE, LEAST = 0.98, 1e-3
# Round-off of a step's curvature, as a share [-].
ROUND_OFF = 1e-9
# Sweeps between two looks at the residual.
LOOK = 8


def make_look(spec: Spec) -> Any:
    """Return `kernel(contact, velocities, beta, theta) -> (along, bent, curved, held, off)`.

    One contact's step. along: gradient times change, for the restart; bent, curved: what W and
    theta c say of the last step [J]; held, off: squared natural maps with the held shift and with
    its change alone [m^2/s^2], in the metric's own units (divided by c).
    """
    friction, compliant = spec.has("friction"), spec.has("compliance")
    shifts = spec.friction_cone != "convex"
    contact_velocity = make_contact_velocity(spec)

    def look(contact, velocities, beta, theta):
        w, w1, w2 = contact_velocity(contact, velocities)
        n, one, two, mu = contact.lambda_n, 0.0, 0.0, 0.0
        if friction:
            one, two, mu = contact.lambda_1, contact.lambda_2, contact.mu
        if compliant:
            w += contact.gamma * n
        bound = contact.bound
        # How W bends along the last step, x - y, beside what was assumed.
        dn, d1, d2 = n - contact.base_n, one - contact.base_1, two - contact.base_2
        bent = dn * (w - contact.pull_n) + d1 * (w1 - contact.pull_1) + d2 * (w2 - contact.pull_2)
        curved = bound * (dn * dn + d1 * d1 + d2 * d2)
        # Natural map of the problem with the held shift, and what the shift is off.
        step = 1.0 / bound
        x, y, z = project_cone(n - step * (w + contact.shift), one - step * w1, two - step * w2, mu)
        x, y, z = x - n, y - one, z - two
        held = bound * (x * x + y * y + z * z)
        off = 0.0
        if friction and shifts:
            off = mu * sqrt(w1 * w1 + w2 * w2) - contact.shift
            off = step * off * off
        # Velocities are linear in the impulses: those at y need no visit of their own.
        cn, c1, c2 = contact.change_n, contact.change_1, contact.change_2
        base_n, base_1, base_2 = n + beta * cn, one + beta * c1, two + beta * c2
        pull_n = w + beta * (w - contact.seen_n)
        pull_1 = w1 + beta * (w1 - contact.seen_1)
        pull_2 = w2 + beta * (w2 - contact.seen_2)
        contact.seen_n, contact.seen_1, contact.seen_2 = w, w1, w2
        contact.base_n, contact.base_1, contact.base_2 = base_n, base_1, base_2
        contact.pull_n, contact.pull_1, contact.pull_2 = pull_n, pull_1, pull_2
        step = 1.0 / (theta * bound)
        x, y, z = project_cone(
            base_n - step * (pull_n + contact.shift), base_1 - step * pull_1,
            base_2 - step * pull_2, mu,
        )  # fmt: skip
        x, y, z = x - n, y - one, z - two
        contact.change_n, contact.change_1, contact.change_2 = x, y, z
        contact.lambda_n = n + x
        if friction:
            contact.lambda_1, contact.lambda_2 = one + y, two + z
        along = (base_n - n - x) * x + (base_1 - one - y) * y + (base_2 - two - z) * z
        return bound * along, bent, curved, held, off

    return kernel(look, spec)


def make_begin(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities)`: at rest at the impulses that there are."""
    friction = spec.has("friction")
    contact_velocity = make_contact_velocity(spec)

    def begin(contacts, count, velocities):
        for c in range(count):
            contact = contacts[c]
            contact.change_n, contact.change_1, contact.change_2 = 0.0, 0.0, 0.0
            contact.base_n, contact.base_1, contact.base_2 = contact.lambda_n, 0.0, 0.0
            if friction:
                contact.base_1, contact.base_2 = contact.lambda_1, contact.lambda_2
            w, w1, w2 = contact_velocity(contact, velocities)
            contact.seen_n, contact.seen_1, contact.seen_2 = w, w1, w2
            contact.pull_n, contact.pull_1, contact.pull_2 = w, w1, w2
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


def make(spec: Spec) -> Any:
    """Return `kernel(contacts, order, count, bodies, velocities, space, params, counters, rows)`.

    Writes counters.sweeps, .residual [m/s], .residual_contact and .not_converged of this step.
    """
    record_residuals = spec.has("residual_log")
    shifts = spec.has("friction") and spec.friction_cone != "convex"
    note, account = make_note(spec), make_account(spec)
    residual, bound = make_residual(spec), step_bound.make_bound(spec)
    begin, look, act = make_begin(spec), make_look(spec), make_act(spec)
    shift: Any = make_shift(spec) if shifts else None

    def accelerated_projected_gradient(
        contacts, order, count, bodies, velocities, space, params, counters, rows
    ):
        bound(contacts, count, space)
        begin(contacts, count, velocities)
        if shifts:
            shift(contacts, count, velocities)
        largest, worst = residual(contacts, count, velocities)
        sweeps, measured = 0, True
        if record_residuals:
            note(params, counters, rows, 0, largest)
        theta, pace, beta = 1.0, 1.0, 0.0
        while sweeps < params.sweeps:
            if measured and (largest <= params.tolerance or largest != largest):
                break
            along, bent, curved, held, off = 0.0, 0.0, 0.0, 0.0, 0.0
            for c in range(count):
                p, q, r, s, t = look(contacts[c], velocities, beta, theta)
                along, bent, curved = along + p, bent + q, curved + r
                held, off = held + s, off + t
            act(contacts, count, velocities)
            sweeps += 1
            allowed = bent <= theta * curved * (1.0 + ROUND_OFF)
            theta = max(EASE * theta, LEAST) if allowed else min(theta / EASE**8, 1.0)
            if along > 0.0 or not allowed:
                pace, beta = 1.0, 0.0
            else:
                longer = 0.5 * (1.0 + sqrt(1.0 + 4.0 * pace * pace))
                pace, beta = longer, (pace - 1.0) / longer
            if shifts:
                if held <= INEXACT * INEXACT * off:
                    shift(contacts, count, velocities)
            measured = record_residuals or sweeps % LOOK == 0
            if measured:
                largest, worst = residual(contacts, count, velocities)
            if record_residuals:
                note(params, counters, rows, sweeps, largest)
        if not measured:
            largest, worst = residual(contacts, count, velocities)
        account(params, counters, sweeps, largest, worst)

    return kernel(accelerated_projected_gradient, spec)


SOLVER = Solver(
    name="accelerated_projected_gradient",
    make=make,
    allocate=step_bound.allocate,
    contact_fields=CONTACT_FIELDS,
)
