"""Laws of contact springs: impulse of a step, its tangent row, solves with new tangents; energy.

    F = (d + c k_d d')/c,      0 <= F,   U = d^2/(2 c)              linear, k_d = 2 zeta sqrt(m/c)
    F = k d^(3/2) (1 + a d'),  0 <= F,   U = 2/5 k d^(5/2)          Hertz, Hunt and Crossley
where d = -phi is above 0. Bodies that move by the mean of the velocities at the step's ends
(`contact_midpoint`) get
    lambda = dt G + k_d (d_1^+ - d_0^+)      or      lambda = dt G (1 + a r)
    G = (U(d_1) - U(d_0))/(d_1 - d_0),   d_1 = d_0 + dt r,   r = -(v_0 + v_1)/2,   d^+ = max(d, 0)
G is the discrete gradient of U: without damping the work is the change of U to the last digit,
where surfaces meet and leave, too; a damper takes some of it. The linear one inside is the
trapezoidal rule, G = (d_0 + d_1)/(2 c). Hertz's is, with a, b the roots of both depths, which does
not cancel,
    G = 2/5 k (a^4 + a^3 b + a^2 b^2 + a b^3 + b^4)/(a + b)
    dG/dd_1 = k/5 (2 a^3 + 4 a^2 b + 6 a b^2 + 3 b^3)/(a + b)^2
Of bodies that move by v_1 alone F is that of d_1 and r = -v_1: the implicit Euler rule.

lambda(v_1) falls, and is convex: a chord's mean of a convex F is, and so is its product with the
damping's factor. The row is its tangent,
    v_1 + target + gamma lambda >= 0,   gamma = 1/s,   target = -v - lambda(v)/s,   s = -dlambda/dv
at the velocity v of the last solve: Newton's method, which for one contact finds lambda from any v.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Any

from .compile import inner, kernel
from .contact import make_normal_velocity
from .parts import make_forget_history
from .row_terms import row_terms
from .solvers.iteration import NOTHING
from .spec import Spec
from .step_terms import step_terms

# Flattest tangent of a row, as a share of the mass at the contact 1/k_n. Below it each solve leaves
# this share of what the last one was off by [-].
FLATTEST = 1e-3
# Solves with a new tangent each: one takes off two thirds of a depth that is far too deep, so that
# a contact alone takes up to some 15 where a step is 1e5 times longer than its impact.
SOLVES = 40
# What a law may be missed by, of the tolerance; and of the speed, what is round-off [-].
SHARP, ROUND_OFF = 1e-3, 1e-14


@inner
def mean_force(d_0, d_1):
    """Return G of k = 1 by Hertz, and its derivative by d_1; depths at both ends of a step [m]."""
    if d_0 >= 0.0 and d_1 >= 0.0:
        a, b = sqrt(d_0), sqrt(d_1)
        both = a + b
        if both == 0.0:
            return 0.0, 0.0
        even = d_0 * d_0 + d_0 * d_1 + d_1 * d_1 + a * b * (d_0 + d_1)
        steep = 2.0 * a * d_0 + 4.0 * d_0 * b + 6.0 * a * d_1 + 3.0 * b * d_1
        return 0.4 * even / both, 0.2 * steep / (both * both)
    if d_1 > 0.0:  # it meets
        way = d_1 - d_0
        mean = 0.4 * d_1 * d_1 * sqrt(d_1) / way
        return mean, d_1 * sqrt(d_1) / way - mean / way
    if d_0 > 0.0:  # it leaves
        way = d_0 - d_1
        mean = 0.4 * d_0 * d_0 * sqrt(d_0) / way
        return mean, mean / way
    return 0.0, 0.0


@inner
def mean_depth(d_0, d_1):
    """Return G of c = 1 by the linear law, and its derivative by d_1."""
    if d_0 >= 0.0 and d_1 >= 0.0:
        return 0.5 * (d_0 + d_1), 0.5
    if d_1 > 0.0:  # it meets
        share = d_1 / (d_1 - d_0)
        return 0.5 * d_1 * share, share * (1.0 - 0.5 * share)
    if d_0 > 0.0:  # it leaves
        share = d_0 / (d_0 - d_1)
        return 0.5 * d_0 * share, 0.5 * share * share
    return 0.0, 0.0


def make_linear_push(spec: Spec) -> Any:
    """Return `kernel(contact, v, params) -> (lambda, s)`, where v_n ends at v [N s], [kg]."""
    mean = step_terms(spec).centred

    def linear_push(contact, v, params):
        dt, c, begin = params.dt, contact.spring_compliance, -contact.phi
        damper = 2.0 * contact.damping_ratio / sqrt(contact.k_n * c)
        if mean:
            rate, follows = -0.5 * (contact.spring_v + v), 0.5
            end = begin + dt * rate
            depth, steep = mean_depth(begin, end)
        else:
            rate, follows = -v, 1.0
            end = begin + dt * rate
            depth, steep = max(end, 0.0), 1.0 if end > 0.0 else 0.0
        impulse = dt * depth / c + damper * (max(end, 0.0) - max(begin, 0.0))
        slope = dt * steep / c
        if end > 0.0:
            slope += damper
        if impulse < 0.0:  # nothing pulls
            return 0.0, 0.0
        return impulse, dt * slope * follows

    return kernel(linear_push, spec)


def make_hertz_push(spec: Spec) -> Any:
    """Return `kernel(contact, v, params) -> (lambda, s)`, where v_n ends at v [N s], [kg]."""
    mean = step_terms(spec).centred

    def hertz_push(contact, v, params):
        dt, begin = params.dt, -contact.phi
        stiff, dissipation = contact.hertz_stiffness, contact.dissipation
        if mean:
            rate = -0.5 * (contact.spring_v + v)
            force, steep = mean_force(begin, begin + dt * rate)
            follows = 0.5  # the rate, what v_1 changes
        else:
            rate = -v
            root = sqrt(max(begin + dt * rate, 0.0))
            force, steep, follows = root * root * root, 1.5 * root, 1.0
        damped = max(1.0 + dissipation * rate, 0.0)
        change = dt * steep * damped
        if damped > 0.0:
            change += dissipation * force
        return dt * stiff * force * damped, dt * stiff * change * follows

    return kernel(hertz_push, spec)


def make_push(spec: Spec) -> Any:
    """Return that of the contact's law."""
    linear = make_linear_push(spec)
    if not row_terms(spec).curved:
        return linear
    hertz = make_hertz_push(spec)

    def push(contact, v, params):
        if contact.hertz_stiffness > 0.0:
            return hertz(contact, v, params)
        return linear(contact, v, params)

    return kernel(push, spec)


def make_touch(spec: Spec) -> Any:
    """Return `kernel(contact, v, params) -> missed`: its row is the tangent where v_n ends at v.

    missed: what its impulse, or that of its row so far, is off the law, as a velocity [m/s].
    """
    push, curved = make_push(spec), row_terms(spec).curved

    def touch(contact, v, params):
        impulse, slope = push(contact, v, params)
        flattest = FLATTEST / contact.k_n
        linear = True
        if curved:
            linear = contact.hertz_stiffness == 0.0
        found = contact.lambda_n
        if linear:
            # What solves leave is theirs: the law is missed where it leaves its last tangent.
            if contact.gamma > 0.0:
                found = max(-(v + contact.target) / contact.gamma, 0.0)
            # What is softer is so wherever it is pressed.
            flattest = min(flattest, 0.25 * params.dt * params.dt / contact.spring_compliance)
        contact.gamma = 1.0 / max(slope, flattest)
        contact.target = -v - contact.gamma * impulse
        contact.inv_k = 1.0 / (contact.k_n + contact.gamma)
        return contact.k_n * contact.gamma * contact.inv_k * abs(found - impulse)

    return kernel(touch, spec)


def make_linearise(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities, params) -> (missed, speed)` [m/s].

    Rows become tangents at these velocities. missed: the most that one was off its law; speed: the
    largest along their normals.
    """
    normal_velocity, touch = make_normal_velocity(spec), make_touch(spec)

    def linearise(contacts, count, velocities, params):
        missed, speed = 0.0, 0.0
        for c in range(count):
            contact = contacts[c]
            if contact.spring_compliance > 0.0:
                v = normal_velocity(contact, velocities[contact.a], velocities[contact.b])
                off = touch(contact, v, params)
                if off > missed or off != off:  # a NaN wins and stays
                    missed = off
                speed = max(speed, abs(v), abs(contact.spring_v))
        return missed, speed

    return kernel(linearise, spec)


def make_stored(spec: Spec) -> Any:
    """Return `kernel(contact, depth) -> U` [J]."""
    curved = row_terms(spec).curved

    def stored(contact, depth):
        d = max(depth, 0.0)
        energy = 0.5 * d * d / contact.spring_compliance
        if curved:
            if contact.hertz_stiffness > 0.0:
                energy = 0.4 * contact.hertz_stiffness * d * d * sqrt(d)
        return energy

    return kernel(stored, spec)


def make_stop_pushing(spec: Spec) -> Any:
    """Return `kernel(contact)`: no impulse in place of one that no velocity has a digit of.

    Each tangent of what flies leaves a share FLATTEST of an impulse that it was handed, down to the
    least of all numbers; and what has one is carried by its contact (`integrate.make_classify`).
    """
    terms = row_terms(spec)
    friction, torsional, rolling = terms.frictional, terms.torsional, terms.rolling

    def stop_pushing(contact):
        contact.lambda_n = 0.0
        if friction:
            contact.lambda_1, contact.lambda_2 = 0.0, 0.0
        if torsional:
            contact.psi_n = 0.0
        if rolling:
            contact.psi_1, contact.psi_2 = 0.0, 0.0

    return kernel(stop_pushing, spec)


def make_solve_by_tangents(spec: Spec, solve: Any) -> Any:
    """Return the kernel of a solver whose rows follow their laws; solve: one of linear rows."""
    linearise, forget_history = make_linearise(spec), make_forget_history(spec)
    stop_pushing = make_stop_pushing(spec)

    def solve_by_tangents(system, workspace, params, counters, residual_rows):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        linearise(contacts, count, velocities, params)
        sweeps, last, found = 0, inf, False
        tolerance = max(params.tolerance, 0.0)
        for k in range(SOLVES):
            if k > 0:
                forget_history(counters, residual_rows)
            solve(system, workspace, params, counters, residual_rows)
            sweeps += counters.sweeps
            missed, speed = linearise(contacts, count, velocities, params)
            sharp = missed <= max(SHARP * tolerance, ROUND_OFF * speed)
            if sharp or (missed <= tolerance and missed > 0.5 * last):
                found = True
                break
            if counters.not_converged == 1 and missed > 0.5 * last:
                break  # what solves leave, tangents do not take off
            last = missed
        counters.sweeps = sweeps
        if not found:
            counters.not_converged = 1
        for c in range(count):
            contact = contacts[c]
            if contact.lambda_n > 0.0 and contact.k_n * contact.lambda_n <= NOTHING:
                stop_pushing(contact)

    return kernel(solve_by_tangents, spec)
