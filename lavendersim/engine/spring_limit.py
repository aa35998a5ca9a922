"""Springs that a step does not resolve: where their impulses are not found, they give no energy.

Whatever a spring's stiffness, the equations of `spring_midpoint` have a solution, and it keeps the
energy; where a body turns by more than a few radians in a step, Newton's method may not find it.
The group of bodies that springs join (`spring_group`) is then placed by the first of these poses
for which its energy is enough:
    what the impulses so far lead to
    x_0 + dt (V_c + t (v - V_c)), turned by dt t omega;    t = 1, 1/2, 1/4, ..., 0
Of a group that something holds it is what it had as the step began and the work of forces over the
displacement to that pose: it hangs from its springs, and gains only what it falls.
v, omega: with the impulses J = dt (k (l_0 - L) + s v_l)/(1 + dt s K), s = k dt + c, of the implicit
Euler rule along d_0, all springs at once, which change no omega by more than a radian in a step;
V_c: of the group's centre. In a pose springs store V_1 and the angular momentum h takes
h . omega_c/2; other velocities are scaled to what is left of the energy that the group began with.
At t = 0 it is enough. Groups that end at what does not move have V_c = 0 and no h to keep. Momentum
and angular momentum are kept. What is lost is most of the energy of the swing, in a step or a few.
"""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

from .compile import kernel
from .spec import Spec
from .spring_group import make_group
from .spring_turn import PLACED, make_twist
from .step_terms import step_terms
from .vectors import Vec3, cross, dot, length, minus, plus, plus_scaled, position, scaled

SWEEPS = 20
HALVINGS = 30
# The most that a body turns, where it is placed [rad].
TURN = 1.0
# Of impulses that are not found the pose is taken that leaves this share of what is left [-].
LIKE = 0.5
# Energy of a group, of what it has, that is round-off [-].
ROUND_OFF = 1e-12


class LimitKernels(NamedTuple):
    """What is done with springs whose impulses are not found."""

    limit: Any  # (links, bodies, velocities, motion, dt): no group of bodies gains energy
    settle: Any  # (links, bodies, velocities, motion, group, dt): implicit Euler, of one group


def make_limit(spec: Spec, place: Any) -> LimitKernels:
    """Return the kernels.

    place: kernel of `effects.spring`. Velocities: with the impulses of springs as far as found.
    """
    from .rotation import inverse_inertia_times, orient, turn

    turns = step_terms(spec).turns
    twist: Any = make_twist(spec) if turns else None

    group_of = make_group(spec, place)
    label, within, stored = group_of.label, group_of.within, group_of.stored
    spin_of, set_velocity = group_of.spin_of, group_of.set_velocity
    centre_of, momentum_of = group_of.centre_of, group_of.momentum_of
    rigid_spin, angular = group_of.rigid_spin, group_of.angular

    def fit(links, bodies, velocities, group, kept):
        # Velocities of bodies that stand in their pose: what they may have. Returns the share of
        # what they had that is left, negative where the pose needs more energy than there is.
        anchored, h, budget = kept
        left = budget - stored(links, bodies, group)
        if anchored:
            zero = Vec3(0.0, 0.0, 0.0)
            _, energy = momentum_of(bodies, velocities, group, zero, zero)
            share = 1.0 if energy <= left else sqrt(max(left, 0.0) / energy)
            for i in range(bodies.shape[0]):
                v = velocities[i]
                if bodies[i].group == group:
                    u = scaled(share, Vec3(v.vx, v.vy, v.vz))
                    set_velocity(v, u, scaled(share, spin_of(v)))
            return share if left >= 0.0 else -1.0
        _, centre, speed = centre_of(bodies, velocities, group)
        had, energy = momentum_of(bodies, velocities, group, centre, speed)
        old, new = rigid_spin(bodies, group, centre, had), rigid_spin(bodies, group, centre, h)
        inner = max(energy - 0.5 * dot(had, old), 0.0)
        left -= 0.5 * dot(h, new)
        share = 1.0 if inner <= left else sqrt(max(left, 0.0) / inner)
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            if body.group == group:
                r = minus(position(body), centre)
                u = minus(minus(Vec3(v.vx, v.vy, v.vz), speed), cross(old, r))
                u = plus(plus(scaled(share, u), cross(new, r)), speed)
                set_velocity(v, u, plus(scaled(share, minus(spin_of(v), old)), new))
        return share if left >= 0.0 else -1.0

    fit = kernel(fit, spec)

    def restore(bodies, group):
        for i in range(bodies.shape[0]):
            body = bodies[i]
            if body.group == group:
                body.x, body.y, body.z = body.from_x, body.from_y, body.from_z
                if turns:
                    body.qw, body.qx = body.from_qw, body.from_qx
                    body.qy, body.qz = body.from_qy, body.from_qz
                    orient(body)

    restore = kernel(restore, spec)

    def move(bodies, group, dt):
        for i in range(bodies.shape[0]):
            body = bodies[i]
            if body.group == group:
                body.x += body.shift_x
                body.y += body.shift_y
                body.z += body.shift_z
                if turns:
                    turn(body, dt * body.turn_x, dt * body.turn_y, dt * body.turn_z)

    move = kernel(move, spec)

    def freed(body, m):
        # Velocity and spin once forces but no springs have acted.
        u = Vec3(m.vx + m.dvx, m.vy + m.dvy, m.vz + m.dvz)
        return u, Vec3(body.free_wx, body.free_wy, body.free_wz)

    freed = kernel(freed, spec)

    def work_on(body, m, dt):
        # Of forces and torques, over the displacement in the step; body: where it begins.
        pulled, shift = Vec3(m.dvx, m.dvy, m.dvz), Vec3(body.shift_x, body.shift_y, body.shift_z)
        work = dot(pulled, shift) / (body.inv_m * dt)
        if turns:
            x, y, z = body.free_wx - m.wx, body.free_wy - m.wy, body.free_wz - m.wz
            gained = angular(body, Vec3(x, y, z))
            work += dot(gained, Vec3(body.turn_x, body.turn_y, body.turn_z))
        return work

    work_on = kernel(work_on, spec)

    def as_found(bodies, velocities, motion, group, dt):
        # The pose that impulses lead to, with the velocities there; the work of forces.
        found, work = True, 0.0
        for i in range(bodies.shape[0]):
            body, v, m = bodies[i], velocities[i], motion[i]
            if body.group == group:
                half = 0.5 * dt
                body.shift_x, body.shift_y = half * (m.vx + v.vx), half * (m.vy + v.vy)
                body.shift_z = half * (m.vz + v.vz)
                if turns:
                    found = found and body.unturned == 0
                    if body.sprung == 0:
                        body.turn_x, body.turn_y, body.turn_z = v.wx, v.wy, v.wz
                work += work_on(body, m, dt)
                if turns:
                    twist(body, v, dt)
                body.x += body.shift_x
                body.y += body.shift_y
                body.z += body.shift_z
        return found, work

    as_found = kernel(as_found, spec)

    def settle(links, bodies, velocities, motion, group, dt):
        # Velocities by the implicit Euler rule along the springs as they stand.
        for i in range(bodies.shape[0]):
            if bodies[i].group == group:
                u, w = freed(bodies[i], motion[i])
                set_velocity(velocities[i], u, w)
        for k in range(links.shape[0]):
            if within(links[k], bodies, group):
                links[k].force = 0.0
        for _ in range(SWEEPS):
            for k in range(links.shape[0]):
                link = links[k]
                if not within(link, bodies, group):
                    continue
                body_a, body_b = bodies[link.a], bodies[link.b]
                va, vb = velocities[link.a], velocities[link.b]
                now = place(link, body_a, body_b)
                la, lb = cross(now.r_a, now.d), cross(now.r_b, now.d)
                u = minus(Vec3(vb.vx, vb.vy, vb.vz), Vec3(va.vx, va.vy, va.vz))
                response, rate = body_a.inv_m + body_b.inv_m, dot(now.d, u)
                ta, tb = la, lb
                if turns:
                    x, y, z = inverse_inertia_times(body_a, la.x, la.y, la.z)
                    ta = Vec3(x, y, z)
                    x, y, z = inverse_inertia_times(body_b, lb.x, lb.y, lb.z)
                    tb = Vec3(x, y, z)
                    response += dot(la, ta) + dot(lb, tb)
                    rate += dot(lb, spin_of(vb)) - dot(la, spin_of(va))
                s = link.stiffness * dt + link.damping
                force = link.stiffness * (now.length - link.rest_length) + s * rate
                change = (force - link.force) / (1.0 + dt * s * response)
                link.force += change
                impulse = scaled(dt * change, now.d)
                va.vx, va.vy = va.vx + impulse.x * body_a.inv_m, va.vy + impulse.y * body_a.inv_m
                va.vz += impulse.z * body_a.inv_m
                vb.vx, vb.vy = vb.vx - impulse.x * body_b.inv_m, vb.vy - impulse.y * body_b.inv_m
                vb.vz -= impulse.z * body_b.inv_m
                if turns:
                    j = dt * change
                    va.wx, va.wy, va.wz = va.wx + j * ta.x, va.wy + j * ta.y, va.wz + j * ta.z
                    vb.wx, vb.wy, vb.wz = vb.wx - j * tb.x, vb.wy - j * tb.y, vb.wz - j * tb.z
        for k in range(links.shape[0]):
            link = links[k]
            if within(link, bodies, group):
                d = place(link, bodies[link.a], bodies[link.b]).d
                j = dt * link.force
                link.px, link.py, link.pz = j * d.x, j * d.y, j * d.z

    settle = kernel(settle, spec)

    def keep(bodies, velocities, group):
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            if body.group == group:
                body.to_vx, body.to_vy, body.to_vz = v.vx, v.vy, v.vz
                if turns:
                    body.to_wx, body.to_wy, body.to_wz = v.wx, v.wy, v.wz

    keep = kernel(keep, spec)

    def take(body, v):
        # What `keep` kept.
        v.vx, v.vy, v.vz = body.to_vx, body.to_vy, body.to_vz
        if turns:
            v.wx, v.wy, v.wz = body.to_wx, body.to_wy, body.to_wz

    take = kernel(take, spec)

    def aim(bodies, velocities, motion, group, centre, part):
        # centre: its mean velocity in the step, and that at its end; part: the share,
        # and the timestep. Returns the work of forces.
        centred, ended, work = centre[0], centre[1], 0.0
        t, dt = part
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            if body.group == group:
                u = Vec3(body.to_vx, body.to_vy, body.to_vz)
                w = Vec3(body.to_wx, body.to_wy, body.to_wz)
                shift = scaled(dt, plus_scaled(centred, t, minus(u, ended)))
                body.shift_x, body.shift_y, body.shift_z = shift.x, shift.y, shift.z
                free = Vec3(body.free_wx, body.free_wy, body.free_wz)
                gained = minus(w, free)
                angle = dt * length(gained)
                if angle > TURN:
                    w = plus_scaled(free, TURN / angle, gained)
                set_velocity(v, u, w)
                body.turn_x, body.turn_y, body.turn_z = t * w.x, t * w.y, t * w.z
                work += work_on(body, motion[i], dt)
        return work

    aim = kernel(aim, spec)

    def balance_momentum(links, bodies, velocities, motion, group):
        # What the group's momentum has gained came by its springs to bodies that do not move.
        gained, outer = Vec3(0.0, 0.0, 0.0), -1
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            if body.group == group:
                u, _ = freed(body, motion[i])
                change = minus(Vec3(v.vx, v.vy, v.vz), u)
                gained = plus_scaled(gained, 1.0 / body.inv_m, change)
        for k in range(links.shape[0]):
            link = links[k]
            if within(link, bodies, group):
                sign = 0.0
                if bodies[link.b].inv_m == 0.0:
                    sign = 1.0
                elif bodies[link.a].inv_m == 0.0:
                    sign = -1.0
                if sign != 0.0:
                    outer = k
                    gained = plus_scaled(gained, -sign, Vec3(link.px, link.py, link.pz))
        if outer >= 0:
            link = links[outer]
            sign = 1.0 if bodies[link.b].inv_m == 0.0 else -1.0
            link.px += sign * gained.x
            link.py += sign * gained.y
            link.pz += sign * gained.z

    balance_momentum = kernel(balance_momentum, spec)

    def limit_group(links, bodies, velocities, motion, group, dt):
        anchored, found, zero = False, True, Vec3(0.0, 0.0, 0.0)
        for k in range(links.shape[0]):
            link = links[k]
            if within(link, bodies, group):
                found = found and link.lost == 0
                if bodies[link.a].inv_m == 0.0 or bodies[link.b].inv_m == 0.0:
                    anchored = True
        keep(bodies, velocities, group)
        for i in range(bodies.shape[0]):
            body = bodies[i]
            if body.group == group:
                m = motion[i]
                u, w = freed(body, m)
                if anchored:  # what forces add is their work over the displacement that is found
                    u = Vec3(m.vx, m.vy, m.vz)
                    if turns:
                        w = Vec3(m.wx, m.wy, m.wz)
                set_velocity(velocities[i], u, w)
                body.from_x, body.from_y, body.from_z = body.x, body.y, body.z
                if turns:
                    body.from_qw, body.from_qx = body.qw, body.qx
                    body.from_qy, body.from_qz = body.qy, body.qz
        centre, ended, centred = zero, zero, zero
        if not anchored:
            mass, centre, ended = centre_of(bodies, velocities, group)
            for i in range(bodies.shape[0]):
                body, m = bodies[i], motion[i]
                if body.group == group:
                    share = 1.0 / (body.inv_m * mass)
                    mean = Vec3(m.vx + 0.5 * m.dvx, m.vy + 0.5 * m.dvy, m.vz + 0.5 * m.dvz)
                    centred = plus_scaled(centred, share, mean)
        h, energy = momentum_of(bodies, velocities, group, centre, ended)
        budget = energy + stored(links, bodies, group)
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            if body.group == group:
                take(body, v)
        turned, work = as_found(bodies, velocities, motion, group, dt)
        had = budget + work if anchored else budget
        if turned and found:
            after_centre, after_speed = zero, zero
            if not anchored:
                _, after_centre, after_speed = centre_of(bodies, velocities, group)
            _, energy = momentum_of(bodies, velocities, group, after_centre, after_speed)
            if energy + stored(links, bodies, group) <= had * (1.0 + ROUND_OFF):
                restore(bodies, group)
                for i in range(bodies.shape[0]):
                    body, v = bodies[i], velocities[i]
                    if body.group == group:
                        take(body, v)
                return
        share = -1.0
        if turned:
            share = fit(links, bodies, velocities, group, (anchored, h, had))
        restore(bodies, group)
        if not share >= LIKE:
            settle(links, bodies, velocities, motion, group, dt)
            keep(bodies, velocities, group)
            t = 1.0
            for number in range(HALVINGS + 1):
                if number == HALVINGS:
                    t = 0.0
                work = aim(bodies, velocities, motion, group, (centred, ended), (t, dt))
                had = budget + work if anchored else budget
                move(bodies, group, dt)
                share = fit(links, bodies, velocities, group, (anchored, h, had))
                restore(bodies, group)
                if share >= 0.0:
                    break
                t *= 0.5
        for i in range(bodies.shape[0]):
            if bodies[i].group == group:
                bodies[i].sprung = PLACED
        balance_momentum(links, bodies, velocities, motion, group)

    limit_group = kernel(limit_group, spec)

    def limit(links, bodies, velocities, motion, dt):
        label(links, bodies)
        for i in range(bodies.shape[0]):
            if bodies[i].group == i + 1:
                limit_group(links, bodies, velocities, motion, i + 1, dt)

    return LimitKernels(kernel(limit, spec), settle)
