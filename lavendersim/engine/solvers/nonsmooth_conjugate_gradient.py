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

from typing import Any, NamedTuple

from ..compile import kernel
from ..coupling import make_add_impulse
from ..row_terms import row_terms
from ..spec import Spec
from .iteration import Iteration
from .solver import Solver
from .sweep import make_sweep

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


class Directions(NamedTuple):
    """What conjugate gradients carry, see `iteration.Carry`."""

    aim: float
    sweeps: int  # made
    squared: float  # |g|^2 of the sweep before the last one that a direction followed [m^2 kg/s^2]


def make_follow(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities, previous, fresh) -> squared`.

    Moves along the direction of the sweep that was, and returns |g|^2 of it; previous: of the one
    before, which there is not when the direction is fresh.
    """
    friction = row_terms(spec).frictional
    move_on = make_move_on(spec)

    def follow(contacts, count, velocities, previous, fresh):
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
        for c in range(count):
            contact = contacts[c]
            if fresh:
                contact.path_n = 0.0
                if friction:
                    contact.path_1, contact.path_2 = 0.0, 0.0
            move_on(contact, contacts, velocities, share)
        return squared

    return kernel(follow, spec)


def make(spec: Spec) -> Iteration:
    """Return the sweeps, each but the first ones after a step along the last direction."""
    friction = row_terms(spec).frictional
    sweep, follow = make_sweep(spec), make_follow(spec)

    def prepare(system, workspace, params, counters):
        return Directions(params.tolerance, 0, 0.0)

    def sweep_directed(system, workspace, params, counters, carry):
        contacts, count = system.contacts, system.count
        made, squared = carry.sweeps, carry.squared
        if made > PLAIN_SWEEPS:
            fresh = made == PLAIN_SWEEPS + 1
            squared = follow(contacts, count, system.velocities, squared, fresh)
        if made >= PLAIN_SWEEPS:
            for c in range(count):
                contact = contacts[c]
                contact.start_n = contact.lambda_n
                if friction:
                    contact.start_1, contact.start_2 = contact.lambda_1, contact.lambda_2
        greatest = sweep(system, params)
        return greatest, Directions(carry.aim, made + 1, squared)

    return Iteration(kernel(sweep_directed, spec), prepare=kernel(prepare, spec))


SOLVER = Solver(name="nonsmooth_conjugate_gradient", iteration=make, contact_fields=CONTACT_FIELDS)
