"""Springs and contacts that act on each other within a step, at its middle.

A spring's impulse is that of the discrete gradient (`spring_midpoint`) for the motion of the step,
contacts included: only then is its work the change of its energy. So bodies that springs join and
contacts push, the union, are solved in turns: springs with what contacts gave as given, contacts
with the springs' impulses as given. That converges by itself, slowly where steps do not resolve a
spring, and in a few passes by Anderson's acceleration (`anderson`). Where it does not, or where the
union would have more energy at the end of the step than it began with and forces gave it, it is
placed: springs act by s times the implicit Euler rule along where they stand, s = 1, 1/4, 1/16,
..., 0, contacts after them, and bodies move by
    x_1 = x_0 + dt (V_c + t (v - V_c)),   turned by dt t omega;   t = 1, 1/2, 1/4, ...
V_c: the centre's, 0 of what touches or is tied to what does not move. Forces act s times, too, but
for what they change of V_c: else they would drive what does not move on. The first pair (s, t) is
taken for which the energy is enough, first with the rebounds of impacts without order, which may
themselves give energy, then without; at s = t = 0 it is, and what stays in place there slows down.
Of unions whose surfaces work on them (`spring_surfaces`) energy tells nothing: s = t = 1 is taken
where they are not found.
"""

from __future__ import annotations

from typing import Any

from .anderson import NO_ROUND, make_bring_on
from .compile import kernel
from .effects import made_once
from .foreseen_impacts import make_rebounds
from .integrate import make_classify, make_finish
from .midpoint_passes import make_go_back
from .parts import make_forget_history
from .spec import Spec
from .spring_limit import make_limit
from .spring_midpoint import make_find
from .spring_surfaces import make_note_working
from .spring_turn import TWISTED
from .spring_unions import make_unions
from .step_terms import step_terms
from .vectors import Vec3, cross, length

PASSES = 40
# Steps of Newton's method in the solves of one part, after which it is placed. Each of the passes
# may solve contacts at 32 middles, with some 500 steps at each that sweeps do not solve: of eight
# bodies 350,000 were seen in a step, for 4 s and more.
MOST_STEPS = 30_000
# Change of velocity by springs, of the solver's tolerance, at which they are found [-].
FOUND = 0.01
# The same of impulses, of the largest [-].
ROUND_OFF = 1e-13
# Sizes of the springs' impulses, each a quarter of the last, and of what bodies move by, a half.
SIZES, SHARES = 8, 12
# Solves of one size: another where contacts no longer join what was placed with a union.
SOLVES = 3
# How often what does not move is made slower, by a half, where contacts give way.
SLOWER = 30


def make_act_beside_contacts(spec: Spec, place: Any, solve: Any) -> Any:
    """Return `kernel(state, count, workspace, params, counters, log) -> midway`.

    place: kernel of `effects.spring`; solve: kernel of the same arguments that solves contacts from
    velocities without their impulses. midway: whether bodies stand at the middle of the step.
    """
    from .rotation import inertia_times, inverse_inertia_times

    turns = step_terms(spec).turns
    find = make_find(spec, place).find
    settle = make_limit(spec, place).settle
    join, gains, pull, put, part = make_unions(spec, place)
    classify, bring_on = make_classify(spec), make_bring_on(spec)
    finish, go_back = make_finish(spec), make_go_back(spec)
    forget_history = make_forget_history(spec)
    carries_inertia, refresh_inertia = made_once(spec, "refresh_inertia")
    warms, store_contacts = made_once(spec, "store")
    rebounds: Any = make_rebounds(spec) if step_terms(spec).ordered_impacts else None
    may_rebound = rebounds is not None
    note_working = make_note_working(spec)

    def read(links, x):
        for k in range(links.shape[0]):
            link, i = links[k], 9 * k
            x[i], x[i + 1], x[i + 2] = link.px, link.py, link.pz
            x[i + 3], x[i + 4], x[i + 5] = link.lax, link.lay, link.laz
            x[i + 6], x[i + 7], x[i + 8] = link.lbx, link.lby, link.lbz

    read = kernel(read, spec)

    def note_push(bodies, rows, velocities, motion, midway):
        # What contacts gave each body; rows: where the step begins.
        for i in range(bodies.shape[0]):
            row, v, m = rows[i], velocities[i], motion[i]
            if row.again == 0:
                continue
            row.push_x, row.push_y, row.push_z = (
                v.vx - row.to_vx,
                v.vy - row.to_vy,
                v.vz - row.to_vz,
            )
            if turns:
                x, y, z = v.wx - row.to_wx, v.wy - row.to_wy, v.wz - row.to_wz
                if midway:
                    body = bodies[i]
                    x, y, z = v.wx - body.solved_x, v.wy - body.solved_y, v.wz - body.solved_z
                    if m.midway == 0:
                        x, y, z = 0.0, 0.0, 0.0
                row.twist_x, row.twist_y, row.twist_z = inertia_times(bodies[i], x, y, z)
            row.late, row.late_turn = 0.0, 0.0

    note_push = kernel(note_push, spec)

    def begin_again(links, bodies, velocities, motion, dt):
        # Velocities without springs, contacts as they were.
        for i in range(bodies.shape[0]):
            body, v, m = bodies[i], velocities[i], motion[i]
            if body.again == 0:
                continue
            m.dvx, m.dvy = body.pulled_x + body.push_x, body.pulled_y + body.push_y
            m.dvz = body.pulled_z + body.push_z
            v.vx, v.vy, v.vz = m.vx + m.dvx, m.vy + m.dvy, m.vz + m.dvz
            body.sprung, body.late = 0, 0.0
            if m.tau < dt:
                body.late = 1.0 - 2.0 * m.tau / dt
            elif m.carried == 1 or m.carried == 2:
                body.late = 1.0
            body.late_turn = body.late
            if turns:
                x, y, z = inverse_inertia_times(body, body.twist_x, body.twist_y, body.twist_z)
                v.wx, v.wy, v.wz = body.spun_x + x, body.spun_y + y, body.spun_z + z
                body.free_wx, body.free_wy, body.free_wz = v.wx, v.wy, v.wz
                body.turn_x, body.turn_y = 0.5 * (m.wx + v.wx), 0.5 * (m.wy + v.wy)
                body.turn_z = 0.5 * (m.wz + v.wz)
        if turns:
            for k in range(links.shape[0]):
                link = links[k]
                if link.again == 1:
                    a, b = bodies[link.a], bodies[link.b]
                    if link.ax != 0.0 or link.ay != 0.0 or link.az != 0.0:
                        a.sprung = TWISTED if a.inv_m > 0.0 else 0
                    if link.bx != 0.0 or link.by != 0.0 or link.bz != 0.0:
                        b.sprung = TWISTED if b.inv_m > 0.0 else 0

    begin_again = kernel(begin_again, spec)

    def compare(links, bodies, x, f):
        # What springs lead to, less what was used: the largest change of velocity, of impulses.
        changed, moved, largest = 0.0, 0.0, 0.0
        for k in range(links.shape[0]):
            link, i = links[k], 9 * k
            f[i], f[i + 1], f[i + 2] = link.px - x[i], link.py - x[i + 1], link.pz - x[i + 2]
            f[i + 3], f[i + 4] = link.lax - x[i + 3], link.lay - x[i + 4]
            f[i + 5], f[i + 6] = link.laz - x[i + 5], link.lbx - x[i + 6]
            f[i + 7], f[i + 8] = link.lby - x[i + 7], link.lbz - x[i + 8]
            size = length(Vec3(f[i], f[i + 1], f[i + 2]))
            changed = max(changed, size)
            moved = max(moved, size * (bodies[link.a].inv_m + bodies[link.b].inv_m))
            largest = max(largest, length(Vec3(link.px, link.py, link.pz)))
        return moved, changed <= ROUND_OFF * largest

    compare = kernel(compare, spec)

    def impose(links, bodies, velocities, motion, x, size):
        # Velocities before contacts, with these impulses of springs and this share of the forces.
        for i in range(bodies.shape[0]):
            body, v, m = bodies[i], velocities[i], motion[i]
            if body.again == 1:
                body.sprung_x, body.sprung_y, body.sprung_z = 0.0, 0.0, 0.0
                body.twist_x, body.twist_y, body.twist_z = 0.0, 0.0, 0.0
        for k in range(links.shape[0]):
            link, i = links[k], 9 * k
            if link.again == 0:
                continue
            link.px, link.py, link.pz = x[i], x[i + 1], x[i + 2]
            link.lax, link.lay, link.laz = x[i + 3], x[i + 4], x[i + 5]
            link.lbx, link.lby, link.lbz = x[i + 6], x[i + 7], x[i + 8]
            a, b = bodies[link.a], bodies[link.b]
            a.sprung_x += link.px * a.inv_m
            a.sprung_y += link.py * a.inv_m
            a.sprung_z += link.pz * a.inv_m
            b.sprung_x -= link.px * b.inv_m
            b.sprung_y -= link.py * b.inv_m
            b.sprung_z -= link.pz * b.inv_m
            a.twist_x, a.twist_y = a.twist_x + link.lax, a.twist_y + link.lay
            a.twist_z += link.laz
            b.twist_x, b.twist_y = b.twist_x - link.lbx, b.twist_y - link.lby
            b.twist_z -= link.lbz
        for i in range(bodies.shape[0]):
            body, v, m = bodies[i], velocities[i], motion[i]
            if body.inv_m == 0.0:
                continue
            body.placed = body.again
            if body.again == 1:
                body.to_vx = m.vx + body.pulled_x + body.sprung_x
                body.to_vy = m.vy + body.pulled_y + body.sprung_y
                body.to_vz = m.vz + body.pulled_z + body.sprung_z
                if turns:
                    x_, y, z = inverse_inertia_times(body, body.twist_x, body.twist_y, body.twist_z)
                    body.to_wx, body.to_wy = body.spun_x + x_, body.spun_y + y
                    body.to_wz = body.spun_z + z
                if size < 1.0:
                    rest = 1.0 - size
                    body.to_vx -= rest * (body.pulled_x - body.push_x)
                    body.to_vy -= rest * (body.pulled_y - body.push_y)
                    body.to_vz -= rest * (body.pulled_z - body.push_z)
                    if turns:
                        body.to_wx -= rest * (body.spun_x - m.wx)
                        body.to_wy -= rest * (body.spun_y - m.wy)
                        body.to_wz -= rest * (body.spun_z - m.wz)
            v.vx, v.vy, v.vz = body.to_vx, body.to_vy, body.to_vz
            if turns:
                v.wx, v.wy, v.wz = body.to_wx, body.to_wy, body.to_wz

    impose = kernel(impose, spec)

    def take_settled(links, bodies, velocities, motion, x, dt):
        for i in range(bodies.shape[0]):
            body, m = bodies[i], motion[i]
            if body.again == 1:
                m.dvx, m.dvy, m.dvz = body.pulled_x, body.pulled_y, body.pulled_z
                if turns:
                    body.free_wx, body.free_wy = body.spun_x, body.spun_y
                    body.free_wz = body.spun_z
        for i in range(bodies.shape[0]):
            if bodies[i].group == i + 1 and bodies[i].again == 1:
                settle(links, bodies, velocities, motion, i + 1, dt)
        for k in range(links.shape[0]):
            link = links[k]
            if link.again == 1:
                start = place(link, bodies[link.a], bodies[link.b])
                p = Vec3(link.px, link.py, link.pz)
                on_a, on_b = cross(start.r_a, p), cross(start.r_b, p)
                link.lax, link.lay, link.laz = on_a.x, on_a.y, on_a.z
                link.lbx, link.lby, link.lbz = on_b.x, on_b.y, on_b.z
        read(links, x)

    take_settled = kernel(take_settled, spec)

    def act_beside(state, count, workspace, params, counters, log):
        links, bodies, contacts = state.links, state.bodies, state.contacts
        velocities, motion, cache = state.velocities, state.motion, state.cache
        poses, dt = workspace.middle.poses, params.dt
        beside = workspace.beside
        rounds, before, midway = beside.rounds, beside.before, beside.midway[0] == 1
        x, f = rounds.point, rounds.defect
        beside.lost[0] = 0.0
        joined = join(links, poses if midway else bodies, contacts, count, True)
        if joined == 0:
            return midway
        read(links, x)
        columns, done, misses = NO_ROUND, False, 0
        most = counters.newton_steps + MOST_STEPS
        for _ in range(PASSES):
            classify(contacts, count, motion, params)
            note_push(bodies, poses if midway else bodies, velocities, motion, midway)
            if midway:
                go_back(state, count, poses)
            begin_again(links, bodies, velocities, motion, dt)
            if carries_inertia:
                refresh_inertia(bodies, velocities)
            found, _ = find(links, bodies, velocities, motion, dt)
            misses += 0 if found else 1
            moved, same = compare(links, bodies, x, f)
            done = found and (same or moved <= FOUND * params.tolerance)
            columns = bring_on(rounds, x.shape[0], columns)
            impose(links, bodies, velocities, motion, x, 1.0)
            finish(bodies, velocities, motion, params)
            if warms:
                store_contacts(contacts, count, bodies, cache, counters, params)
            forget_history(counters, log.residual)
            sweeps = counters.sweeps
            counters.midpoint_not_converged = before[0]
            counters.gyroscopic_not_converged = before[1]
            midway = solve(state, count, workspace, params, counters, log)
            counters.sweeps += sweeps
            if done or misses > 2 or counters.newton_steps > most:
                break
            again = join(links, poses if midway else bodies, contacts, count, False)
            if again != joined:
                joined, columns = again, NO_ROUND
                read(links, x)
        rows = poses if midway else bodies
        join(links, rows, contacts, count, False)
        classify(contacts, count, motion, params)
        working = note_working(state, rows, count)
        if done or not working:
            if not gains(state, rows, count, beside, params):
                return midway
        counters.spring_not_converged += 1
        if midway:
            go_back(state, count, poses)
        part(links, bodies, motion)
        take_settled(links, bodies, velocities, motion, x, dt)
        pull(links, contacts, bodies, count)
        beside.passes[0] = 0
        size, rebounding = 1.0, False
        if may_rebound:
            rebounding = counters.unordered == 1 and rebounds(state, count)
        for number in range(-SIZES if rebounding else 0, SIZES):
            if number == 0:
                size, beside.impacts[0] = 1.0, 0
            if number == SIZES - 1:
                size = 0.0
            for i in range(x.shape[0]):
                f[i] = size * x[i]
            for _ in range(SOLVES if size < 1.0 else 1):
                if carries_inertia:
                    refresh_inertia(bodies, velocities)
                impose(links, bodies, velocities, motion, f, size)
                finish(bodies, velocities, motion, params)
                forget_history(counters, log.residual)
                sweeps = counters.sweeps
                counters.midpoint_not_converged = before[0]
                counters.gyroscopic_not_converged = before[1]
                solve(state, count, workspace, params, counters, log)
                counters.sweeps += sweeps
                join(links, bodies, contacts, count, False)
                if not part(links, bodies, motion):
                    break
            note_working(state, bodies, count)
            pull(links, contacts, bodies, count)  # of what has joined
            classify(contacts, count, motion, params)
            share = 1.0
            for last in range(SHARES):
                if number == SIZES - 1 and last == SHARES - 1:
                    share = 0.0
                put(state, bodies, count, share, dt)
                if not gains(state, bodies, count, beside, params):
                    return False
                share *= 0.5
            size *= 0.25
        # What contact springs give where nothing moves is taken from what stands.
        for _ in range(SLOWER):
            put(state, bodies, count, 0.0, dt)
            if not gains(state, bodies, count, beside, params):
                return False
        return False

    return kernel(act_beside, spec)
