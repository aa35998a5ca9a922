"""Springs at the middle of the step, of bodies that move by the mean of their velocities.

With X from a spring's point of A to that of B, l = |X|, at the step's start and its end,
    J = dt F u,   u = (X_0 + X_1)/(l_0 + l_1)
    F = k ((l_0 + l_1)/2 - L) + c (l_1 - l_0)/dt
is the discrete gradient of its energy: F u . (X_1 - X_0) is what the spring stores and its damper
takes, however far it turns in the step, and u passes through both points half way, so that angular
momentum is kept. r_m = (r_0 + r_1)/2 are the levers, for of the Cayley map
    r_1 - r_0 = dt w x r_m,   r_m = (r_0 + a x r_0 + (a . r_0) a)/(1 + a^2),   a = w dt/2
All springs are found together, by steps like Newton's on one after the other; the first takes the
length as linear along d_0, for a stiff spring has a solution on either side of its other point.
What is not found so `spring_newton` tries, from the start and with how bodies turn; what it does
not find either is left to `spring_limit`. How uneven bodies turn: `spring_turn`.

What is damped, and swings faster than steps resolve (k K dt^2 > 4), would ring by the rule's
undamped mode, v_1 = -v_0. Such a spring has more of a damper, which is of order 2 beside c,
    F += beta k dt (v_0 + 3 v_1)/4,   beta = min(1, c K dt/4)
and at beta = 1 leaves no stretch after two steps, whatever k. None is added to what has none.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from .compile import kernel
from .spec import Spec
from .spring_limit import make_limit
from .spring_newton import make_newton_step
from .spring_turn import TWISTED, make_mean_spin
from .step_terms import step_terms
from .vectors import Vec3, cross, dot, length, minus, plus, position, scaled

PASSES = 50
# Change of impulses, of the largest, at which they are found.
FOUND = 1e-14
# The same, at which what is left is as good as round-off, and is left.
NEARLY = 1e-13
# Of places that are of the order of one, in a few operations [-].
ROUND_OFF = 4e-15
# k K dt^2 above which steps do not resolve a swing.
FAST = 4.0


class SpringPose(NamedTuple):
    """A spring between two bodies as they stand, world frame."""

    length: float  # [m]
    d: Vec3  # unit vector from the point of A to that of B
    r_a: Vec3  # lever of A's point [m]
    r_b: Vec3  # lever of B's [m]


class SpringSolve(NamedTuple):
    """Kernels that find the impulses of springs."""

    note_start: Any  # (links, bodies, velocities, motion): before springs act
    find: Any  # (links, bodies, velocities, motion, dt) -> found, safe; of what is `again`


def make_find(spec: Spec, place: Any) -> SpringSolve:
    """Return the kernels; place: kernel of `effects.spring`.

    safe: the impulses are that of the gradient, and so to all digits; what is not may win energy.
    """
    from .rotation import inverse_inertia_times, is_round

    turns, uneven = step_terms(spec).turns, step_terms(spec).uneven
    mean_spin: Any = make_mean_spin(spec) if turns else None

    def mean_lever(body, r, v, m, dt):
        # r: at the start, world.
        if turns:
            late = body.late_turn
            x, y, z = late * (v.wx - m.wx), late * (v.wy - m.wy), late * (v.wz - m.wz)
            a = scaled(0.25 * dt, Vec3(m.wx + v.wx + x, m.wy + v.wy + y, m.wz + v.wz + z))
            if uneven:
                if body.sprung == TWISTED and not is_round(body):
                    body.unturned = 0 if mean_spin(body, v, m, dt) else 1
                    a = scaled(0.5 * dt, Vec3(body.turn_x, body.turn_y, body.turn_z))
            s = 1.0 / (1.0 + dot(a, a))
            return scaled(s, plus(plus(r, cross(a, r)), scaled(dot(a, r), a)))
        return r

    mean_lever = kernel(mean_lever, spec)

    def response_of(body, arm, d):
        k = body.inv_m
        if turns:
            lever = cross(arm, d)
            x, y, z = inverse_inertia_times(body, lever.x, lever.y, lever.z)
            k += lever.x * x + lever.y * y + lever.z * z
        return k

    response_of = kernel(response_of, spec)

    def push(body, v, change, spun):
        v.vx += change.x * body.inv_m
        v.vy += change.y * body.inv_m
        v.vz += change.z * body.inv_m
        if turns:
            x, y, z = inverse_inertia_times(body, spun.x, spun.y, spun.z)
            v.wx, v.wy, v.wz = v.wx + x, v.wy + y, v.wz + z

    push = kernel(push, spec)

    def rate_of(v, arm):
        rate = Vec3(v.vx, v.vy, v.vz)
        if turns:
            rate = plus(rate, cross(Vec3(v.wx, v.wy, v.wz), arm))
        return rate

    rate_of = kernel(rate_of, spec)

    def later(body, v, m):
        # How much more than by the mean a body is carried, by velocities.
        return scaled(body.late, Vec3(v.vx - m.vx, v.vy - m.vy, v.vz - m.vz))

    later = kernel(later, spec)

    def improve(link, bodies, velocities, motion, dt, linear):
        # One Newton step on the impulse of a spring; returns the change of its size and its size.
        body_a, body_b = bodies[link.a], bodies[link.b]
        va, vb, ma, mb = velocities[link.a], velocities[link.b], motion[link.a], motion[link.b]
        start = place(link, body_a, body_b)
        length_0 = start.length
        arm_a = mean_lever(body_a, start.r_a, va, ma, dt)
        arm_b = mean_lever(body_b, start.r_b, vb, mb, dt)
        between = Vec3(body_b.x - body_a.x, body_b.y - body_a.y, body_b.z - body_a.z)
        before = minus(plus(between, start.r_b), start.r_a)
        moved = Vec3(
            mb.vx + vb.vx - ma.vx - va.vx,
            mb.vy + vb.vy - ma.vy - va.vy,
            mb.vz + vb.vz - ma.vz - va.vz,
        )
        if body_a.late != 0.0 or body_b.late != 0.0:
            moved = plus(moved, minus(later(body_b, vb, mb), later(body_a, va, ma)))
        middle = minus(plus(plus(between, scaled(0.25 * dt, moved)), arm_b), arm_a)
        length_1 = length(minus(scaled(2.0, middle), before))
        if linear and length_0 > 0.0:
            length_1 = 2.0 * dot(start.d, middle) - length_0
        sum_of = length_0 + length_1
        size = length(middle)
        if sum_of == 0.0 or size == 0.0:
            return 0.0, 0.0, 0.0
        u, d = scaled(2.0 / sum_of, middle), scaled(1.0 / size, middle)
        if linear and length_0 > 0.0:
            u = d = start.d
        k_a, k_b = response_of(body_a, arm_a, d), response_of(body_b, arm_b, d)
        k = k_a + k_b
        reach = k_a * (1.0 + body_a.late) + k_b * (1.0 + body_b.late)  # of the length's change
        force = link.stiffness * (0.5 * sum_of - link.rest_length)
        force += link.damping * (length_1 - length_0) / dt
        slope = 0.5 * link.stiffness + link.damping / dt
        beta = 0.0
        if link.stiffness * k * dt * dt > FAST:
            beta = min(1.0, 0.25 * link.damping * k * dt)
        if beta > 0.0:
            first = dot(d, minus(rate_of(mb, arm_b), rate_of(ma, arm_a)))
            last = dot(d, minus(rate_of(vb, arm_b), rate_of(va, arm_a)))
            force += 0.25 * beta * link.stiffness * dt * (first + 3.0 * last)
            slope += 1.5 * beta * link.stiffness
        old = Vec3(link.px, link.py, link.pz)
        missing = minus(scaled(dt * force, u), old)
        along = dot(missing, d)
        across = minus(missing, scaled(along, d))
        along /= 1.0 + 0.5 * dt * dt * slope * reach
        stiff = 0.5 * dt * dt * reach * force / max(sum_of, length_0)
        change = plus(scaled(along, d), scaled(1.0 / (1.0 + max(stiff, 0.0)), across))
        new = plus(old, change)
        link.force, link.px, link.py, link.pz = force, new.x, new.y, new.z
        spun_a, spun_b = cross(arm_a, new), cross(arm_b, new)
        push(body_a, va, change, minus(spun_a, Vec3(link.lax, link.lay, link.laz)))
        minus_b = minus(Vec3(link.lbx, link.lby, link.lbz), spun_b)
        push(body_b, vb, scaled(-1.0, change), minus_b)
        link.lax, link.lay, link.laz = spun_a.x, spun_a.y, spun_a.z
        link.lbx, link.lby, link.lbz = spun_b.x, spun_b.y, spun_b.z
        # What round-off of places leaves of the impulse.
        places = length(position(body_a)) + length(position(body_b)) + length_0
        rounded = ROUND_OFF * dt * slope * places / (1.0 + 0.5 * dt * dt * slope * reach)
        return length(change), length(new), rounded

    improve = kernel(improve, spec)

    def forget(links):
        for k in range(links.shape[0]):
            link = links[k]
            if link.again == 0:
                continue
            link.force, link.px, link.py, link.pz = 0.0, 0.0, 0.0, 0.0
            link.lax, link.lay, link.laz = 0.0, 0.0, 0.0
            link.lbx, link.lby, link.lbz = 0.0, 0.0, 0.0
            link.lost = 0

    forget = kernel(forget, spec)

    def law(link, bodies, motion, start, length_1, dt):
        # `improve`'s, with the rate at the end by those of the start and of the step.
        body_a, body_b, ma, mb = bodies[link.a], bodies[link.b], motion[link.a], motion[link.b]
        k = response_of(body_a, start.r_a, start.d) + response_of(body_b, start.r_b, start.d)
        longer = length_1 - start.length
        force = link.stiffness * (0.5 * (start.length + length_1) - link.rest_length)
        force += link.damping * longer / dt
        slope = 0.5 * link.stiffness + link.damping / dt
        if link.stiffness * k * dt * dt > FAST:
            beta = min(1.0, 0.25 * link.damping * k * dt)
            first = dot(start.d, minus(rate_of(mb, start.r_b), rate_of(ma, start.r_a)))
            force += beta * link.stiffness * (1.5 * longer - 0.5 * dt * first)
            slope += 1.5 * beta * link.stiffness
        return force, slope

    law = kernel(law, spec)
    newton_step: Any = make_newton_step(spec, place, law, push) if turns else None

    def begin_anew(links, bodies, velocities, motion):
        for i in range(bodies.shape[0]):
            body, v, m = bodies[i], velocities[i], motion[i]
            if body.again == 0:
                continue
            if body.inv_m > 0.0 and body.joined == 1:
                v.vx, v.vy, v.vz = m.vx + m.dvx, m.vy + m.dvy, m.vz + m.dvz
                v.wx, v.wy, v.wz = body.free_wx, body.free_wy, body.free_wz
            body.turn_x, body.turn_y = 0.5 * (m.wx + v.wx), 0.5 * (m.wy + v.wy)
            body.turn_z = 0.5 * (m.wz + v.wz)
        forget(links)

    begin_anew = kernel(begin_anew, spec)

    def note_start(links, bodies, velocities, motion):
        # What springs twist, and its spin before they do.
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            body.sprung, body.unturned, body.again = 0, 0, 1
            body.late, body.late_turn = 0.0, 0.0
            m = motion[i]
            body.pulled_x, body.pulled_y, body.pulled_z = m.dvx, m.dvy, m.dvz
            if turns:
                body.free_wx, body.free_wy, body.free_wz = v.wx, v.wy, v.wz
                body.spun_x, body.spun_y, body.spun_z = v.wx, v.wy, v.wz
                body.turn_x, body.turn_y, body.turn_z = v.wx, v.wy, v.wz
        for k in range(links.shape[0]):
            links[k].again = 1
        if turns:
            for k in range(links.shape[0]):
                link = links[k]
                if link.active == 1:
                    a, b = bodies[link.a], bodies[link.b]
                    if link.ax != 0.0 or link.ay != 0.0 or link.az != 0.0:
                        a.sprung = TWISTED if a.inv_m > 0.0 else 0
                    if link.bx != 0.0 or link.by != 0.0 or link.bz != 0.0:
                        b.sprung = TWISTED if b.inv_m > 0.0 else 0

    def is_gradient(links, bodies, dt):
        # Whether no spring off a centre has the damper of those that steps do not resolve.
        for k in range(links.shape[0]):
            link = links[k]
            body_a, body_b = bodies[link.a], bodies[link.b]
            if link.damping > 0.0 and link.active == 1 and body_a.sprung + body_b.sprung > 0:
                now = place(link, body_a, body_b)
                response = response_of(body_a, now.r_a, now.d)
                response += response_of(body_b, now.r_b, now.d)
                if link.stiffness * response * dt * dt > FAST:
                    return False
        return True

    is_gradient = kernel(is_gradient, spec)

    def is_turned(bodies, velocities, motion, dt):
        # Mean spins, with all impulses.
        found = True
        for i in range(bodies.shape[0]):
            body, v, m = bodies[i], velocities[i], motion[i]
            if body.sprung == TWISTED and body.again == 1:
                body.unturned = 0 if mean_spin(body, v, m, dt) else 1
                found = found and body.unturned == 0
        return found

    is_turned = kernel(is_turned, spec)

    def improve_all(links, bodies, velocities, motion, dt):
        for _ in range(PASSES):
            changed, largest = 0.0, 0.0
            for k in range(links.shape[0]):
                link = links[k]
                if link.again == 0 or link.active == 0:
                    continue
                if bodies[link.a].inv_m + bodies[link.b].inv_m == 0.0:
                    continue
                change, size = newton_step(link, bodies, velocities, motion, dt)
                changed, largest = max(changed, change), max(largest, size)
                link.lost = 1 if change > 10.0 * FOUND * largest else 0
            if changed <= 10.0 * FOUND * largest:
                return is_turned(bodies, velocities, motion, dt)
        is_turned(bodies, velocities, motion, dt)
        return False

    improve_all = kernel(improve_all, spec)

    def turns_little(bodies, dt):
        for i in range(bodies.shape[0]):
            body = bodies[i]
            if body.sprung == TWISTED:
                if dt * length(Vec3(body.turn_x, body.turn_y, body.turn_z)) > 1.0:
                    return False
        return True

    turns_little = kernel(turns_little, spec)

    def find(links, bodies, velocities, motion, dt):
        # From velocities that all else leads to; whether all are found, and in which digits.
        forget(links)
        safe = is_gradient(links, bodies, dt)
        found = False
        for number in range(PASSES):
            changed, largest = 0.0, 0.0
            for k in range(links.shape[0]):
                link = links[k]
                if link.again == 0 or link.active == 0:
                    continue
                if bodies[link.a].inv_m + bodies[link.b].inv_m == 0.0:
                    continue
                change, size, rounded = improve(link, bodies, velocities, motion, dt, number == 0)
                changed, largest = max(changed, change), max(largest, size)
                link.lost = 1 if change > NEARLY * largest + rounded else 0
            if number > 0 and changed <= FOUND * largest:
                found = True
                break
        if not found:  # but for round-off?
            found = True
            for k in range(links.shape[0]):
                found = found and links[k].lost == 0
        if turns:
            found = is_turned(bodies, velocities, motion, dt) and found
            if not found:
                begin_anew(links, bodies, velocities, motion)
                found = improve_all(links, bodies, velocities, motion, dt)
            # In a turn of radians the digits of the impulses are fewer.
            safe = safe and turns_little(bodies, dt)
        return found, safe

    return SpringSolve(kernel(note_start, spec), kernel(find, spec))


def make_act_midway(spec: Spec, place: Any) -> Any:
    """Return `kernel(links, bodies, velocities, motion, params, counters)`: springs act.

    place: kernel of `effects.spring`. Velocities change; counters.spring_not_converged counts the
    solves that find no impulses, whose bodies `spring_limit` places.
    """
    turns = step_terms(spec).turns
    note_start, find = make_find(spec, place)
    limit: Any = make_limit(spec, place).limit

    def act(links, bodies, velocities, motion, params, counters):
        note_start(links, bodies, velocities, motion)
        found, safe = find(links, bodies, velocities, motion, params.dt)
        if not found:
            counters.spring_not_converged += 1
        if not (found and safe):
            limit(links, bodies, velocities, motion, params.dt)
        for i in range(bodies.shape[0]):
            body, v, m = bodies[i], velocities[i], motion[i]
            body.to_vx, body.to_vy, body.to_vz = v.vx, v.vy, v.vz
            body.sprung_x = v.vx - m.vx - body.pulled_x
            body.sprung_y = v.vy - m.vy - body.pulled_y
            body.sprung_z = v.vz - m.vz - body.pulled_z
            if turns:
                body.to_wx, body.to_wy, body.to_wz = v.wx, v.wy, v.wz

    return kernel(act, spec)
