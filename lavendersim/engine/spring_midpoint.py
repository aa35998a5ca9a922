"""Springs at the middle of the step, of bodies that move by the mean of their velocities.

With X from a spring's point of A to that of B, l = |X|, at the step's start and its end,
    J = dt F u,   u = (X_0 + X_1)/(l_0 + l_1)
    F = k ((l_0 + l_1)/2 - L) + c (l_1 - l_0)/dt
is the discrete gradient of its energy: F u . (X_1 - X_0) is what the spring stores and its damper
takes, however far it turns in the step, and u passes through both points half way, so that angular
momentum is kept. r_m = (r_0 + r_1)/2 are the levers, for of the Cayley map
    r_1 - r_0 = dt w x r_m,   r_m = (r_0 + a x r_0 + (a . r_0) a)/(1 + a^2),   a = w dt/2
All springs are found together, by Newton's steps on one after the other; the first takes the length
as linear along d_0, for a stiff spring has a solution on either side of its other point.

What is damped, and swings faster than steps resolve (k K dt^2 > 4), would ring by the rule's
undamped mode, v_1 = -v_0. Such a spring has more of a damper, which is of order 2 beside c,
    F += beta k dt (v_0 + 3 v_1)/4,   beta = min(1, c K dt/4)
and at beta = 1 leaves no stretch after two steps, whatever k. None is added to what has none.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from .compile import kernel
from .spec import Spec
from .vectors import Vec3, cross, dot, length, minus, plus, scaled

PASSES = 50
# Change of impulses, of the largest, at which they are found.
FOUND = 1e-14
# And at which the last pass may leave them: what passes of many springs round off stays below.
LEFT = 1e-10
# k K dt^2 above which steps do not resolve a swing.
FAST = 4.0


class SpringPose(NamedTuple):
    """A spring between two bodies as they stand, world frame."""

    length: float  # [m]
    d: Vec3  # unit vector from the point of A to that of B
    r_a: Vec3  # lever of A's point [m]
    r_b: Vec3  # lever of B's [m]


def make_act_midway(spec: Spec, place: Any) -> Any:
    """Return `kernel(links, bodies, velocities, motion, params, counters)`: springs act.

    place: kernel of `effects.spring`. Velocities change; impulses that change by more than LEFT in
    the last of PASSES are counted in counters.spring_not_converged.
    """
    from .rotation import inverse_inertia_times

    turns = spec.has("rotation")

    def mean_lever(r, v, m, dt):
        # r: at the start, world.
        if turns:
            a = scaled(0.25 * dt, Vec3(m.wx + v.wx, m.wy + v.wy, m.wz + v.wz))
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

    def improve(link, bodies, velocities, motion, dt, linear):
        # One Newton step on the impulse of a spring; returns the change of its size and its size.
        body_a, body_b = bodies[link.a], bodies[link.b]
        va, vb, ma, mb = velocities[link.a], velocities[link.b], motion[link.a], motion[link.b]
        start = place(link, body_a, body_b)
        length_0 = start.length
        arm_a, arm_b = mean_lever(start.r_a, va, ma, dt), mean_lever(start.r_b, vb, mb, dt)
        between = Vec3(body_b.x - body_a.x, body_b.y - body_a.y, body_b.z - body_a.z)
        before = minus(plus(between, start.r_b), start.r_a)
        moved = Vec3(
            mb.vx + vb.vx - ma.vx - va.vx,
            mb.vy + vb.vy - ma.vy - va.vy,
            mb.vz + vb.vz - ma.vz - va.vz,
        )
        middle = minus(plus(plus(between, scaled(0.25 * dt, moved)), arm_b), arm_a)
        length_1 = length(minus(scaled(2.0, middle), before))
        if linear and length_0 > 0.0:
            length_1 = 2.0 * dot(start.d, middle) - length_0
        sum_of = length_0 + length_1
        size = length(middle)
        if sum_of == 0.0 or size == 0.0:
            return 0.0, 0.0
        u, d = scaled(2.0 / sum_of, middle), scaled(1.0 / size, middle)
        if linear and length_0 > 0.0:
            u = d = start.d
        k = response_of(body_a, arm_a, d) + response_of(body_b, arm_b, d)
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
        along /= 1.0 + 0.5 * dt * dt * slope * k
        stiff = 0.5 * dt * dt * k * force / max(sum_of, length_0)
        change = plus(scaled(along, d), scaled(1.0 / (1.0 + max(stiff, 0.0)), across))
        new = plus(old, change)
        link.force, link.px, link.py, link.pz = force, new.x, new.y, new.z
        spun_a, spun_b = cross(arm_a, new), cross(arm_b, new)
        push(body_a, va, change, minus(spun_a, Vec3(link.lax, link.lay, link.laz)))
        minus_b = minus(Vec3(link.lbx, link.lby, link.lbz), spun_b)
        push(body_b, vb, scaled(-1.0, change), minus_b)
        link.lax, link.lay, link.laz = spun_a.x, spun_a.y, spun_a.z
        link.lbx, link.lby, link.lbz = spun_b.x, spun_b.y, spun_b.z
        return length(change), length(new)

    improve = kernel(improve, spec)

    def act(links, bodies, velocities, motion, params, counters):
        changed, largest = 0.0, 0.0
        for k in range(links.shape[0]):
            link = links[k]
            link.force, link.px, link.py, link.pz = 0.0, 0.0, 0.0, 0.0
            link.lax, link.lay, link.laz = 0.0, 0.0, 0.0
            link.lbx, link.lby, link.lbz = 0.0, 0.0, 0.0
        for number in range(PASSES):
            changed, largest = 0.0, 0.0
            for k in range(links.shape[0]):
                link = links[k]
                if link.active == 0 or bodies[link.a].inv_m + bodies[link.b].inv_m == 0.0:
                    continue
                change, size = improve(link, bodies, velocities, motion, params.dt, number == 0)
                changed, largest = max(changed, change), max(largest, size)
            if number > 0 and changed <= FOUND * largest:
                break
        if not changed <= LEFT * largest:
            counters.spring_not_converged += 1

    return kernel(act, spec)
