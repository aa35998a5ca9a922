"""Springs along the surface of contacts, each in series with Coulomb's friction: rows, stretch.

    v_t = s' + w,    p = -k_t s dt,    |p| <= mu lambda_n,    w against p where p is at its most
s is the stretch, w the slip that is left to friction. Of bodies that move by the mean of the
velocities at both ends of a step (`contact_midpoint`), by the trapezoidal rule,
    p = -k_t dt (s_0 + s_1)/2,    s_1 = s_0 + dt (v_m - w_m),    v_m = (v_0 + v_1)/2
so that p . (v_m - w_m) is what 1/2 k_t s^2 loses, to the last digit; of others p = -k_t dt s_1,
s_1 = s_0 + dt (v_1 - w), the implicit Euler rule. The row is Coulomb's with a shift and a gamma,
    2 w_m = v_1 + (v_0 + 4 s_0/dt) + gamma p,  gamma = 4/(k_t dt^2)   or   s_0/dt,  1/(k_t dt^2)
so that solvers know of gamma alone. dt is the time for which surfaces touch in the step, by the
velocities that it begins with.

A damper k_d = 2 zeta_t sqrt(m k_t) beside the spring, m = 1/K_t the mass at the contact along its
surface, adds -k_d (s_1 - s_0) to p. With h = 2 k_d/(k_t dt), of Euler's rule k_d/(k_t dt), both
terms of the row, s_0 and gamma, are divided by 1 + h, and the step ends with
    s_1 = s_0 - 2 (p/(k_t dt) + s_0)/(1 + h)      or      s_1 = s_0 - (p/(k_t dt) + s_0)/(1 + h)
so that p takes k_d (s_1 - s_0)^2/dt of the energy.

Where a step ends s is no longer than mu F_n/k_t: the spring gives way, which takes from the energy.
Of Hertz's contact k_t is that of the depth there where it is less than the step's, for what is let
out keeps its stretch: with the step's, impacts that stick as they are let out are of order 1.
As a contact is pressed further in, k_t grows and the force is kept; as it is let out, the stretch
is (Walton and Braun 1986, as cited by Thornton; background, not opened): neither gives energy.
The stretch turns with the normal, by the least turn, and about it with the mean of both spins.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from .block import make_relative_velocity
from .compile import inner, kernel
from .contact import make_normal_velocity
from .records import INSTANT
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms
from .vectors import Vec3, dot, plus_scaled

# Least share of a step for which a contact that meets or leaves in it is taken to touch [-].
BRIEFEST = 1e-3
# A contact of Hertz's law that is pressed in by less has no stiffness along its surface [m].
SHALLOW = 1e-15
# Cosine of a turn of the normal, less than which from the opposite nothing of a stretch is left.
OPPOSITE = 1e-6


@inner
def turned(s, old, new):
    """Return a vector across the unit vector `old`, turned by the least turn from it to `new`."""
    beside = 1.0 + dot(old, new)
    if beside < OPPOSITE:
        return Vec3(0.0, 0.0, 0.0)
    share = -dot(s, new) / beside
    return plus_scaled(plus_scaled(s, share, old), share, new)


@inner
def touching_share(begin, end):
    """Return the share of a step in which a contact touches; depths at both its ends [m]."""
    if begin >= 0.0 and end >= 0.0:
        return 1.0
    if end > 0.0:
        return max(end / (end - begin), BRIEFEST)
    if begin > 0.0:
        return max(begin / (begin - end), BRIEFEST)
    return 0.0


def make_recall(spec: Spec) -> Any:
    """Return `kernel(contacts, count, bodies, cache, counters, params)`: stretches kept so far.

    By the same pair and feature, of several the nearest; else the nearest that is left within
    `cache_distance`. Rows of both lists are ordered by pair.
    """

    def recall(contacts, count, bodies, cache, counters, params):
        for k in range(counters.cached):
            cache[k].recalled = 0
        for c in range(count):
            contact = contacts[c]
            contact.recalled, contact.stretch_k = 0, 0.0
            contact.stretch_x, contact.stretch_y, contact.stretch_z = 0.0, 0.0, 0.0
        for by_feature in (True, False):
            first = 0
            for c in range(count):
                contact = contacts[c]
                while first < counters.cached and cache[first].key < contact.key:
                    first += 1
                if contact.recalled == 1:
                    continue
                body = bodies[contact.a]
                rx, ry, rz = contact.x - body.x, contact.y - body.y, contact.z - body.z
                best, chosen = params.cache_distance * params.cache_distance, -1
                k = first
                while k < counters.cached and cache[k].key == contact.key:
                    old = cache[k]
                    same = old.feature == contact.feature
                    if old.recalled == 0 and old.stretch_k > 0.0 and (same or not by_feature):
                        dx, dy, dz = old.rx - rx, old.ry - ry, old.rz - rz
                        distance = dx * dx + dy * dy + dz * dz
                        if distance <= best or (by_feature and chosen < 0):
                            best, chosen = distance, k
                    k += 1
                if chosen >= 0:
                    old = cache[chosen]
                    old.recalled, contact.recalled = 1, 1
                    contact.stretch_x, contact.stretch_y = old.stretch_x, old.stretch_y
                    contact.stretch_z, contact.stretch_k = old.stretch_z, old.stretch_k
                    contact.stretch_nx, contact.stretch_ny = old.stretch_nx, old.stretch_ny
                    contact.stretch_nz = old.stretch_nz

    return kernel(recall, spec)


def make_yield_row(spec: Spec) -> Any:
    """Return `kernel(contact, pair, ma, mb, params)`, of a completed frictional row.

    ma, mb: velocities of its bodies as the step begins.
    """
    mean, curved = step_terms(spec).centred, row_terms(spec).curved
    relative_velocity = make_relative_velocity(spec)

    def stiffness(contact, pair, begin, end):
        if curved:
            if contact.hertz_stiffness > 0.0:
                depth = 0.5 * (max(begin, 0.0) + max(end, 0.0))
                if depth < SHALLOW:
                    return 0.0
                return 1.5 * pair.tangential_stiffness * contact.hertz_stiffness * sqrt(depth)
        return pair.tangential_stiffness / contact.spring_compliance

    stiffness = kernel(stiffness, spec)

    def recalled_along(contact, k):
        # Along its tangents; a stiffer spring has the force that it had.
        s = Vec3(contact.stretch_x, contact.stretch_y, contact.stretch_z)
        n = Vec3(contact.nx, contact.ny, contact.nz)
        s = turned(s, Vec3(contact.stretch_nx, contact.stretch_ny, contact.stretch_nz), n)
        share = 1.0
        if k > contact.stretch_k:
            share = contact.stretch_k / k
        one = dot(s, Vec3(contact.t1x, contact.t1y, contact.t1z))
        return share * one, share * dot(s, Vec3(contact.t2x, contact.t2y, contact.t2z))

    recalled_along = kernel(recalled_along, spec)

    def soften(contact):
        scale = 1.0 / (contact.i_11 * contact.i_22 - contact.i_12 * contact.i_12)
        k_11 = contact.i_22 * scale + contact.gamma_t
        k_22 = contact.i_11 * scale + contact.gamma_t
        k_12 = -contact.i_12 * scale
        scale = 1.0 / (k_11 * k_22 - k_12 * k_12)
        contact.i_11, contact.i_12, contact.i_22 = k_22 * scale, -k_12 * scale, k_11 * scale
        contact.k_t += contact.gamma_t

    soften = kernel(soften, spec)

    def yield_row(contact, pair, ma, mb, params):
        contact.gamma_t, contact.yield_k = 0.0, 0.0
        if pair.tangential_stiffness == 0.0 or pair.friction == 0.0:
            return
        if contact.spring_compliance == 0.0 or params.dt <= INSTANT:
            return
        v = contact.spring_v
        if mean:
            v += 0.5 * contact.dv_n
        begin = -contact.phi
        end = begin - params.dt * v
        k, share = stiffness(contact, pair, begin, end), touching_share(begin, end)
        if k == 0.0 or share == 0.0:  # it does not touch yet, or no more
            contact.mu = 0.0
            return
        dt = share * params.dt
        one, two = 0.0, 0.0
        if contact.stretch_k > 0.0:
            one, two = recalled_along(contact, k)
        contact.yield_k, contact.yield_dt = k, dt
        contact.yield_ratio = pair.tangential_stiffness
        contact.yield_1, contact.yield_2 = one, two
        damping = 2.0 * pair.tangential_damping_ratio / (dt * sqrt(k * contact.k_t))
        if mean:
            damping *= 2.0
        contact.yield_damping = damping
        follows = 1.0 / (1.0 + damping)
        contact.gamma_t = follows / (k * dt * dt)
        one, two = follows * one / dt, follows * two / dt
        if mean:
            contact.gamma_t *= 4.0
            x, y, z = relative_velocity(contact, ma, mb)
            one, two = 4.0 * one + contact.surface_1, 4.0 * two + contact.surface_2
            one += contact.t1x * x + contact.t1y * y + contact.t1z * z
            two += contact.t2x * x + contact.t2y * y + contact.t2z * z
        contact.surface_1 += one
        contact.surface_2 += two
        soften(contact)

    return kernel(yield_row, spec)


def make_normal_force(spec: Spec) -> Any:
    """Return `kernel(contact, depth, v) -> F_n` of its spring and damper [N]; v: v_n [m/s]."""
    curved = row_terms(spec).curved

    def normal_force(contact, depth, v):
        d = max(depth, 0.0)
        if curved:
            if contact.hertz_stiffness > 0.0:
                damped = max(1.0 - contact.dissipation * v, 0.0)
                return contact.hertz_stiffness * d * sqrt(d) * damped
        if d == 0.0:
            return 0.0
        c = contact.spring_compliance
        damper = 2.0 * contact.damping_ratio / sqrt(contact.k_n * c)
        return max(d / c - damper * v, 0.0)

    return kernel(normal_force, spec)


def make_keep_stretch(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities, motion, params)`: stretches as the step ends."""
    mean, curved = step_terms(spec).centred, row_terms(spec).curved
    normal_velocity, normal_force = make_normal_velocity(spec), make_normal_force(spec)

    def stretched(contact, va, vb, params):
        # Along its tangents.
        k = contact.yield_k
        one = -contact.lambda_1 / (k * contact.yield_dt)
        two = -contact.lambda_2 / (k * contact.yield_dt)
        force = contact.lambda_n / contact.yield_dt
        followed = 1.0 / (1.0 + contact.yield_damping)
        if mean:
            followed *= 2.0
        kept = 1.0 - followed
        one = followed * one + kept * contact.yield_1
        two = followed * two + kept * contact.yield_2
        if mean:
            v = normal_velocity(contact, va, vb)
            depth = -(contact.phi + 0.5 * params.dt * (v + contact.spring_v))
            force = normal_force(contact, depth, v)
            if curved:
                if contact.hertz_stiffness > 0.0:  # let out, its stretch is that of its end
                    ends = 1.5 * contact.hertz_stiffness * sqrt(max(depth, 0.0))
                    k = min(k, max(contact.yield_ratio * ends, SHALLOW * k))
        most, length = contact.mu * force / k, sqrt(one * one + two * two)
        if length > most:
            one, two = one * (most / length), two * (most / length)
        return one, two

    stretched = kernel(stretched, spec)

    def spin_about(contact, v, m):
        x, y, z = v.wx, v.wy, v.wz
        if mean:
            x, y, z = 0.5 * (x + m.wx), 0.5 * (y + m.wy), 0.5 * (z + m.wz)
        return contact.nx * x + contact.ny * y + contact.nz * z

    spin_about = kernel(spin_about, spec)

    def keep_stretch(contacts, count, velocities, motion, params):
        for c in range(count):
            contact = contacts[c]
            contact.stretch_k = contact.yield_k
            if contact.yield_k == 0.0:
                contact.stretch_x, contact.stretch_y, contact.stretch_z = 0.0, 0.0, 0.0
                continue
            a, b = contact.a, contact.b
            va, vb = velocities[a], velocities[b]
            one, two = stretched(contact, va, vb, params)
            spin = 0.5 * (spin_about(contact, va, motion[a]) + spin_about(contact, vb, motion[b]))
            # By Cayley's turn, as bodies do.
            t = 0.5 * params.dt * spin
            cosine, sine = (1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t)
            one, two = cosine * one - sine * two, sine * one + cosine * two
            contact.stretch_x = contact.t1x * one + contact.t2x * two
            contact.stretch_y = contact.t1y * one + contact.t2y * two
            contact.stretch_z = contact.t1z * one + contact.t2z * two
            contact.stretch_nx, contact.stretch_ny = contact.nx, contact.ny
            contact.stretch_nz = contact.nz

    return kernel(keep_stretch, spec)


def make_damper_work(spec: Spec) -> Any:
    """Return `kernel(contact) -> W` that the damper along the surface does in the step [J].

    W = -k_d (s_1 - s_0)^2/dt of a row that gives way, solved: 0 without a damper, never above 0.
    """
    mean = step_terms(spec).centred

    def damper_work(contact):
        h, k, dt = contact.yield_damping, contact.yield_k, contact.yield_dt
        followed, damping = 1.0 / (1.0 + h), h * k  # k_d/dt
        if mean:
            followed, damping = 2.0 * followed, 0.5 * damping
        one = followed * (contact.lambda_1 / (k * dt) + contact.yield_1)
        two = followed * (contact.lambda_2 / (k * dt) + contact.yield_2)
        return -damping * (one * one + two * two)

    return kernel(damper_work, spec)


@inner
def stretch_energy(contact):
    """Return what the spring along the surface stores [J]."""
    x, y, z = contact.stretch_x, contact.stretch_y, contact.stretch_z
    return 0.5 * contact.stretch_k * (x * x + y * y + z * z)
