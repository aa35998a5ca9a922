"""An interior point method over the bodies, where rounds of no kind end (`alart_curnier`).

    u = w + mu |w_t| e_n,  x o z = 0,  x and z of the circular cone       (`cone_scaling`)
w are the contacts' velocities, which bodies have by momentum: they are consistent with impulses
throughout. A step linearises x o z = m e and the shift, with Nesterov and Todd's scaling H:
    (M + J^T G J) dv = J^T T H^-1 (m sigma x^-1 - z - C^-1 F),    G = T H^-1 C^-1 T
    dz = C^-1 (F + T J dv),    dx = H^-1 (m sigma x^-1 - z - dz),   F = T w + |z_t| e_n - z
T divides normals by mu, and C = I - e_n d^T with the direction d of slip. That is the method of
`problems.interior_point`, factorised over the bodies: contacts in excess do not enlarge the matrix.
Where friction slides steps may jam at the boundary; after such a step one follows with the shift
frozen, C = I. It begins from the cones' axes, whatever sweeps and rounds have found.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Any, NamedTuple

from ...block import make_slip_velocity
from ...compile import inner, kernel
from ...contact import make_frictionless_velocity
from ...residual import make_residual
from ...row_terms import by_friction
from ...spec import Spec
from ...vectors import Vec3, plus_scaled
from .cone_scaling import (
    SOFTNESS,
    TINY,
    determinant,
    impulse_of,
    make_cone_point,
    make_gain,
    make_scale_by_gain,
    make_scale_by_gain_transposed,
    scaling_of,
    to_boundary,
    unscaled,
    velocity_inside,
)
from .envelope import DOF, OF_A, OF_B, T1, T2
from .factor import make_solve_lu
from .kept_velocities import (
    LOST,
    OF_START,
    make_keep_velocities,
    make_put_velocities,
    make_speed,
)
from .matrix import make_assemble_and_factorise
from .method import make_keep, make_restore, make_set_impulse
from .minimise import make_assemble_mass, make_body_of, make_directional_derivative
from .response import make_fill_rows

MOST = 80


class Centring(NamedTuple):
    """How a run is controlled: where friction slides none of them always converges."""

    share: float  # of the way to the boundary that a step may go [-]
    centred: float  # least product x o z of a contact, against the mean [-]
    power: float  # of what a straight step leaves over: by so much a step centres (Mehrotra 1992)


LONG_STEPS, SHORT_STEPS = Centring(0.995, 0.02, 3.0), Centring(0.9, 0.1, 1.0)
LEAST_CENTRING = 1e-6
# A step that leaves a contact too near the boundary is shortened by this, so often.
BACK, TRIALS = 0.8, 12
# A step shorter than this has jammed: centring by at least these shares is tried instead [-].
JAMMED, CENTRING = 0.1, (0.5, 1.0, 2.0)
LONGER = 1.5  # of the longest so far, to be taken instead
# A length below this gets nowhere; so many in all end it.
NOWHERE, PATIENCE = 1e-3, 12
# Below this share of the mean product of the start nothing is left but round-off [-].
NOTHING_LEFT = 1e-20
# Columns of `Envelope.inside`: what a step adds to the shifted velocity [m/s]
RISE_N, RISE_1, RISE_2 = range(3)


def make_contact_velocity(spec: Spec) -> Any:
    """Return `kernel(contact, va, vb) -> (w_n, w_1, w_2)`, targets and moving surfaces included."""

    def make_frictional(spec: Spec) -> Any:
        slip_velocity = make_slip_velocity(spec)

        def velocity_of_block(contact, va, vb):
            n, one, two = slip_velocity(contact, va, vb)
            return n + contact.target, one, two

        return kernel(velocity_of_block, spec)

    def make_frictionless(spec: Spec) -> Any:
        normal_velocity = make_frictionless_velocity(spec)

        def velocity_of_normal(contact, va, vb):
            return normal_velocity(contact, va, vb) + contact.target, 0.0, 0.0

        return kernel(velocity_of_normal, spec)

    return by_friction(spec, make_frictionless, make_frictional)


def make_begin_inside(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities, workspace)`: contacts on their cones' axes.

    From impulses of 0.
    """
    velocity_of, set_impulse = make_contact_velocity(spec), make_set_impulse(spec)
    cone_point = make_cone_point(spec)

    def begin_inside(contacts, count, velocities, workspace):
        unit = 0.0
        for c in range(count):
            contact = contacts[c]
            n, one, two = velocity_of(contact, velocities[contact.a], velocities[contact.b])
            unit = max(unit, sqrt((n * n + one * one + two * two) * contact.inv_k))
        for c in range(count):
            contact = contacts[c]
            root = sqrt(contact.inv_k)
            set_impulse(contact, velocities, unit * root, 0.0, 0.0)
            p = cone_point(contact, Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0))
            contact.velocity_n = p.mu * unit / root
            contact.velocity_1, contact.velocity_2 = 0.0, 0.0
            contact.step_n, contact.step_1, contact.step_2 = 0.0, 0.0, 0.0
            rises = workspace.inside[c]
            rises[RISE_N], rises[RISE_1], rises[RISE_2] = 0.0, 0.0, 0.0

    return kernel(begin_inside, spec)


@inner
def step_of(contact):
    """Return what a step adds to the impulse of a contact."""
    return Vec3(contact.step_n, contact.step_1, contact.step_2)


@inner
def rise_of(rises):
    """Return what a step adds to the velocity of a contact, from its row of `inside`."""
    return Vec3(rises[RISE_N], rises[RISE_1], rises[RISE_2])


def make_find_direction(spec: Spec) -> Any:
    """Return `kernel(contacts, count, size, velocities, workspace, aim)`, of a factorised matrix.

    aim: m sigma. What the step adds is left as `step` of the impulses and `RISE` of velocities.
    """
    velocity_of, cone_point = make_contact_velocity(spec), make_cone_point(spec)
    fill_rows, body_of = make_fill_rows(spec), make_body_of(spec)
    directional_derivative = make_directional_derivative(spec, torques=False)
    solve_lu = make_solve_lu(spec)

    def direction(contact, velocities, aim):
        # Those of x and z, where the contact's velocity changes by `step` and more by slip.
        p = cone_point(contact, impulse_of(contact), velocity_inside(contact))
        x, z = p.x, p.z
        n, one, two = velocity_of(contact, velocities[contact.a], velocities[contact.b])
        change_1, change_2 = 0.0, 0.0
        side, along = 0.0, 0.0
        if p.frictional:
            change_1 = one - z.y + contact.step_1
            change_2 = two - z.z + contact.step_2
            side = sqrt(z.y * z.y + z.z * z.z)
            if side > 0.0:
                along = contact.scale * (z.y * change_1 + z.z * change_2) / side
        rise = (n + contact.step_n) / p.mu + side - z.x + along
        inverse = aim / max(determinant(x), TINY)
        left = Vec3(
            inverse * x.x - z.x - rise,
            -inverse * x.y - z.y - change_1,
            -inverse * x.z - z.z - change_2,
        )
        softness = SOFTNESS / contact.inv_k
        dx = unscaled(scaling_of(x, z), softness, left)
        dz = Vec3(rise, change_1, change_2)
        return p, dx, plus_scaled(dz, softness, dx)

    direction = kernel(direction, spec)

    def find_direction(contacts, count, size, velocities, workspace, aim):
        rows, step = workspace.rows, workspace.step
        for r in range(DOF * size):
            step[r] = 0.0
        for c in range(count):
            contact = contacts[c]
            contact.step_n, contact.step_1, contact.step_2 = 0.0, 0.0, 0.0
            p, dx, _ = direction(contact, velocities, aim)
            fill_rows(contact, rows)
            for own in (OF_A, OF_B):
                at = body_of(contact, workspace, own)
                if at >= 0:
                    for i in range(DOF):
                        total = dx.x / p.mu * rows[own, i]
                        if p.frictional:
                            total += dx.y * rows[own + T1, i] + dx.z * rows[own + T2, i]
                        step[DOF * at + i] += total
        solve_lu(size, workspace, step)
        directional_derivative(contacts, count, workspace)
        for c in range(count):
            contact, rises = contacts[c], workspace.inside[c]
            p, dx, dz = direction(contact, velocities, aim)
            contact.step_n, contact.step_1, contact.step_2 = dx.x / p.mu, dx.y, dx.z
            rises[RISE_N], rises[RISE_1], rises[RISE_2] = dz.x * p.mu, dz.y, dz.z

    return kernel(find_direction, spec)


def make_choose_length(spec: Spec) -> Any:
    """Return `kernel(contacts, count, workspace, straight) -> (length, mean)`, x o z behind a step.

    straight: up to the boundary, and no less for what is left in the middle of the cones.
    """
    cone_point = make_cone_point(spec)

    def moved(contact, rises, length):
        impulse = plus_scaled(impulse_of(contact), length, step_of(contact))
        velocity = plus_scaled(velocity_inside(contact), length, rise_of(rises))
        return cone_point(contact, impulse, velocity)

    moved = kernel(moved, spec)

    def mean_and_least(contacts, count, workspace, length):
        total, least = 0.0, inf
        for c in range(count):
            p = moved(contacts[c], workspace.inside[c], length)
            total += p.x.x * p.z.x + p.x.y * p.z.y + p.x.z * p.z.z
            product = max(determinant(p.x) * determinant(p.z), 0.0)
            least = min(least, product)
        return 0.5 * total / count, sqrt(least)

    mean_and_least = kernel(mean_and_least, spec)

    def longest(contacts, count, workspace):
        length = inf
        for c in range(count):
            contact, rises = contacts[c], workspace.inside[c]
            here = moved(contact, rises, 0.0)
            step = cone_point(contact, step_of(contact), rise_of(rises))
            length = min(length, to_boundary(here.x, step.x), to_boundary(here.z, step.z))
        return length

    longest = kernel(longest, spec)

    def choose_length(contacts, count, workspace, strategy, straight):
        length = longest(contacts, count, workspace)
        if straight:
            length = min(1.0, length)
            mean, _ = mean_and_least(contacts, count, workspace, length)
            return length, mean
        length = min(1.0, strategy.share * length)
        mean = 0.0
        for _ in range(TRIALS):
            mean, least = mean_and_least(contacts, count, workspace, length)
            if least >= strategy.centred * mean:
                break
            length *= BACK
        return length, mean

    return kernel(choose_length, spec), mean_and_least


def make_factorise_inside(spec: Spec) -> Any:
    """Return `kernel(contacts, count, size, workspace, share) -> whether` there is a factor.

    share: of the shift's change with slip that the step knows of, 1 or 0.
    """
    scales = make_scale_by_gain(spec), make_scale_by_gain_transposed(spec)
    assemble_and_factorise = make_assemble_and_factorise(spec, make_gain(spec), scales, False)

    def factorise_inside(contacts, count, size, workspace, share):
        for c in range(count):
            contacts[c].scale = share
        return assemble_and_factorise(contacts, count, size, workspace)

    return kernel(factorise_inside, spec)


def make_from_inside(spec: Spec) -> Any:
    """Return `kernel(system, workspace, size, most, tolerance) -> steps`.

    size: of `step_cost`; most: steps; tolerance: residual to be reached [m/s]. What is left has the
    least residual of the way; impulses and velocities are consistent with each other.
    """
    residual, assemble_mass = make_residual(spec), make_assemble_mass(spec)
    factorise_inside = make_factorise_inside(spec)
    begin_inside, find_direction = make_begin_inside(spec), make_find_direction(spec)
    choose_length, mean_and_least = make_choose_length(spec)
    set_impulse, keep = make_set_impulse(spec), make_keep(spec)
    restore_best = make_restore(spec, "best", set_impulse)
    keep_velocities, put_velocities = make_keep_velocities(spec), make_put_velocities(spec)
    speed = make_speed(spec)

    def let_go(contacts, count, velocities):
        for c in range(count):
            set_impulse(contacts[c], velocities, 0.0, 0.0, 0.0)

    let_go = kernel(let_go, spec)

    def add_impulses(contacts, count, velocities):
        # To velocities without any.
        for c in range(count):
            contact = contacts[c]
            n, one, two = contact.lambda_n, contact.lambda_1, contact.lambda_2
            contact.lambda_n, contact.lambda_1, contact.lambda_2 = 0.0, 0.0, 0.0
            set_impulse(contact, velocities, n, one, two)

    add_impulses = kernel(add_impulses, spec)

    def take(contacts, count, velocities, workspace, length):
        for c in range(count):
            contact, rises = contacts[c], workspace.inside[c]
            n, one = length * contact.step_n, length * contact.step_1
            two = length * contact.step_2
            n, one, two = contact.lambda_n + n, contact.lambda_1 + one, contact.lambda_2 + two
            set_impulse(contact, velocities, n, one, two)
            contact.velocity_n += length * rises[RISE_N]
            contact.velocity_1 += length * rises[RISE_1]
            contact.velocity_2 += length * rises[RISE_2]

    take = kernel(take, spec)

    def from_inside(system, workspace, size, most, strategy, tolerance):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        assemble_mass(system.bodies, size, workspace)
        let_go(contacts, count, velocities)
        keep_velocities(velocities, workspace, size, OF_START)
        begin_inside(contacts, count, velocities, workspace)
        usual, peak = speed(contacts, count, velocities), 0.0
        now, least, steps, stuck, share = inf, inf, 0, 0, 1.0
        first, _ = mean_and_least(contacts, count, workspace, 0.0)
        while steps < most:
            now, _ = residual(contacts, count, velocities)
            if now < least:
                least = now
                keep(contacts, count)
            if not now < inf or least <= tolerance or stuck > PATIENCE:
                break
            mean, _ = mean_and_least(contacts, count, workspace, 0.0)
            if not mean > NOTHING_LEFT * first:
                break
            if not factorise_inside(contacts, count, size, workspace, share):
                break
            steps += 1
            find_direction(contacts, count, size, velocities, workspace, 0.0)
            _, left = choose_length(contacts, count, workspace, strategy, True)
            centring = min(1.0, max((left / mean) ** strategy.power, LEAST_CENTRING))
            longest, best, length = -1.0, centring, 0.0
            for trial in range(1 + len(CENTRING)):
                if trial > 0:
                    centring = max(centring, CENTRING[trial - 1])
                find_direction(contacts, count, size, velocities, workspace, centring * mean)
                length, left = choose_length(contacts, count, workspace, strategy, False)
                if length > LONGER * longest:
                    longest, best = length, centring
                if length > JAMMED:
                    break
            if best != centring:
                find_direction(contacts, count, size, velocities, workspace, best * mean)
                length = longest
            if left != left:
                break
            take(contacts, count, velocities, workspace, length)
            peak = max(peak, speed(contacts, count, velocities))
            share = 0.0 if share > 0.0 and length < JAMMED else 1.0
            stuck += length < NOWHERE
        if now > least or now != now:
            restore_best(contacts, count, velocities)
        if peak > LOST * usual or not now < inf:
            put_velocities(velocities, workspace, size, OF_START)
            add_impulses(contacts, count, velocities)
        return steps

    return kernel(from_inside, spec)
