"""Nonsmooth nonlinear conjugate gradients over projected Gauss-Seidel sweeps.

A sweep is a fixed-point map; its step lambda' - lambda stands for the negative gradient g of a
function whose minimum is the solution. Between sweeps the impulses move on along the last search
direction, by Fletcher and Reeves' share,
    beta = |g_k|^2 / |g_k-1|^2,    p_k = beta p_k-1 - g_k,
and where beta > 1 the direction is dropped. Silcowitz-Hansen, Niebe and Erleben 2010, "A nonsmooth
nonlinear conjugate gradient method for interactive contact force problems". Norms are taken in the
metric of the rows' own inverse masses, so light and heavy bodies count alike.

The first sweeps are plain: a solve that begins near its solution needs no directions. The last
thing done is always a sweep, so impulses end inside their cones.
"""

from __future__ import annotations

from ..compile import kernel
from ..coupling import make_add_impulse
from ..effects import made_once
from ..residual import make_residual
from ..row_terms import row_terms
from ..spec import Spec
from .solver import Solver
from .sweep import make_report, make_sweep

CONTACT_FIELDS = [
    ("start_n", "f8"),  # impulse before the sweep [N s]
    ("start_1", "f8"),
    ("start_2", "f8"),
    ("path_n", "f8"),  # search direction [N s]
    ("path_1", "f8"),
    ("path_2", "f8"),
]
PLAIN_SWEEPS = 8


def make_move_on(spec: Spec):
    """Return `kernel(contact, contacts, velocities, share)`: a step along the last direction.

    lambda += share p, then p <- share p + last change.
    """
    friction = row_terms(spec).frictional
    add_impulse = make_add_impulse(spec)

    def move_on(contact, contacts, velocities, share):
        step = share * contact.path_n
        contact.path_n = step + contact.lambda_n - contact.start_n
        contact.lambda_n += step
        step_1, step_2 = 0.0, 0.0
        if friction:
            step_1, step_2 = share * contact.path_1, share * contact.path_2
            contact.path_1 = step_1 + contact.lambda_1 - contact.start_1
            contact.path_2 = step_2 + contact.lambda_2 - contact.start_2
            contact.lambda_1 += step_1
            contact.lambda_2 += step_2
        if share > 0.0:
            add_impulse(contact, contacts, velocities, step, step_1, step_2)

    return kernel(move_on, spec)


def make(spec: Spec):
    """Return `kernel(system, workspace, params, counters, residual_rows)`.

    Writes counters.sweeps, .residual [m/s], .residual_contact and .not_converged of this step.
    """
    friction = row_terms(spec).frictional
    record_residuals, record_residual = made_once(spec, "sweep_row")
    sweep, report = make_sweep(spec), make_report(spec)
    residual = make_residual(spec)
    move_on = make_move_on(spec)

    def nonsmooth_conjugate_gradient(system, workspace, params, counters, residual_rows):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        largest, worst = 0.0, -1
        previous, fresh = 0.0, True
        if record_residuals:
            largest, worst = residual(contacts, count, velocities)
            record_residual(params, counters, residual_rows, 0, largest)
        sweeps = 0
        measured = False
        while sweeps < params.sweeps:
            directed = sweeps >= PLAIN_SWEEPS
            if directed:
                for c in range(count):
                    contact = contacts[c]
                    contact.start_n = contact.lambda_n
                    if friction:
                        contact.start_1, contact.start_2 = contact.lambda_1, contact.lambda_2
            greatest = sweep(system, params)
            sweeps += 1
            measured = False
            if record_residuals:
                largest, worst = residual(contacts, count, velocities)
                measured = True
                record_residual(params, counters, residual_rows, sweeps, largest)
            # The residual is evaluated when the sweep's own changes say that it may be small.
            if greatest <= params.tolerance or greatest == 0.0 or greatest != greatest:
                if not measured:
                    largest, worst = residual(contacts, count, velocities)
                    measured = True
                if largest <= params.tolerance or greatest == 0.0 or greatest != greatest:
                    break
            if directed:
                squared = 0.0
                for c in range(count):
                    contact = contacts[c]
                    change = contact.lambda_n - contact.start_n
                    squared += change * change * contact.k_n
                    if friction:
                        one = contact.lambda_1 - contact.start_1
                        two = contact.lambda_2 - contact.start_2
                        squared += (one * one + two * two) * contact.k_t
                share = 0.0 if fresh else squared / previous
                if share > 1.0:
                    share = 0.0
                if sweeps < params.sweeps:
                    for c in range(count):
                        contact = contacts[c]
                        if fresh:
                            contact.path_n = 0.0
                            if friction:
                                contact.path_1, contact.path_2 = 0.0, 0.0
                        move_on(contact, contacts, velocities, share)
                previous, fresh = squared, False
        if not measured:
            largest, worst = residual(contacts, count, velocities)
        report(params, counters, sweeps, largest, worst)

    return kernel(nonsmooth_conjugate_gradient, spec)


SOLVER = Solver(name="nonsmooth_conjugate_gradient", make=make, contact_fields=CONTACT_FIELDS)
