"""Springs and contacts that act on each other within a step, at its middle.

A spring's impulse is that of the discrete gradient (`spring_midpoint`) for the motion of the step,
contacts included: only then is its work the change of its energy. So bodies that springs join and
contacts push, the union, are solved in turns: springs with what contacts gave as given, contacts
with the springs' impulses as given. That converges by itself, slowly where steps do not resolve a
spring, and in a few passes by Anderson's acceleration. Where it does not, or where the union would
have more energy at the end of the step than it began with and forces gave it, it is placed: springs
act by s times the implicit Euler rule along where they stand, s = 1, 1/4, 1/16, ..., 0, contacts
after them, and bodies move by
    x_1 = x_0 + dt (V_c + t (v - V_c)),   turned by dt t omega;   t = 1, 1/2, 1/4, ...
V_c: the centre's, 0 of what touches or is tied to what does not move. The first pair (s, t) is
taken for which the energy is enough; at s = t = 0 it is.
"""

from __future__ import annotations

from typing import Any

from .acceleration import COLUMNS, advance_by, note_change
from .compile import kernel
from .effects import made_once
from .integrate import make_classify, make_displace, make_finish
from .midpoint_passes import make_stand_up
from .parts import make_forget_history
from .spec import Spec
from .spring_limit import make_limit
from .spring_midpoint import make_find
from .spring_turn import BOTH, TWISTED
from .vectors import Vec3, cross, length, minus, plus_scaled, scaled

PASSES = 40
# Change of velocity by springs, of the solver's tolerance, at which they are found [-].
FOUND = 0.01
# The same of impulses, of the largest [-].
ROUND_OFF = 1e-13
# Energy won in a step, of what there is, that solves and round-off leave [-].
GAINED = 1e-10
# BODY.again while unions are looked for: a contact pushes it.
PUSHED = 2
# Sizes of the springs' impulses, each a quarter of the last, and of what bodies move by, a half.
SIZES, SHARES = 8, 12


def make_act_beside_contacts(spec: Spec, place: Any, solve: Any) -> Any:
    """Return `kernel(state, count, workspace, params, counters, log, midway, before) ->
    midway`.

    place: kernel of `effects.spring`; solve: kernel `(state, count, workspace, params, counters,
    log, passes) -> midway` that solves contacts from velocities without their impulses. midway:
    whether bodies stand at the middle of the step.
    before: counts of what was not found (`midpoint_passes`) before contacts were solved.
    """
    from .rotation import inertia_times, inverse_inertia_times

    turns = spec.has("rotation")
    kinematic = spec.has("kinematic")
    find = make_find(spec, place).find
    settle = make_limit(spec, place).settle
    classify, displace = make_classify(spec), make_displace(spec)
    finish, stand_up = make_finish(spec), make_stand_up(spec)
    forget_history = make_forget_history(spec)
    carries_inertia, refresh_inertia = made_once(spec, "refresh_inertia")
    warms, store_contacts = made_once(spec, "store")
    # What surfaces that move or give way do is no loss.
    gives = spec.has("surface_velocity") or spec.has("contact_spring") or spec.has("compliance")

    def unite(a, b):
        if a.group > 0 and b.group > 0 and a.group != b.group:
            a.group = b.group = min(a.group, b.group)
            return True
        return False

    unite = kernel(unite, spec)

    def join(links, rows, contacts, count, first):
        # Unions of bodies, with a spring and a contact that pushes or did; how many springs they
        # have. first: nothing was joined before in this part.
        for i in range(rows.shape[0]):
            rows[i].group = i + 1 if rows[i].inv_m > 0.0 else 0
            if first:
                rows[i].again = 0
        changed = True
        while changed:
            changed = False
            for k in range(links.shape[0]):
                if links[k].active == 1:
                    changed = unite(rows[links[k].a], rows[links[k].b]) or changed
            for c in range(count):
                if contacts[c].lambda_n > 0.0:
                    changed = unite(rows[contacts[c].a], rows[contacts[c].b]) or changed
        for c in range(count):
            if contacts[c].lambda_n > 0.0:
                for i in (contacts[c].a, contacts[c].b):
                    if rows[i].inv_m > 0.0:
                        rows[i].again = max(rows[i].again, PUSHED)
        # Their first bodies tell of all: what is pushed and has a spring, or was joined before.
        for i in range(rows.shape[0]):
            if rows[i].group > 0:
                head = rows[rows[i].group - 1]
                if head.again != 1 and rows[i].again > 0:
                    head.again = rows[i].again
        found = 0
        for k in range(links.shape[0]):
            link = links[k]
            group = max(rows[link.a].group, rows[link.b].group)
            link.again = 0
            if link.active == 1 and group > 0 and rows[group - 1].again > 0:
                rows[group - 1].again = link.again = 1
                found += 1
        for i in range(rows.shape[0]):
            group = rows[i].group
            if group > 0:
                rows[i].again = 1 if rows[group - 1].again == 1 else 0
        return found

    join = kernel(join, spec)

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

    def impose(links, bodies, velocities, motion, x):
        # Velocities before contacts, with these impulses of springs.
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
            if body.again == 1:
                body.to_vx = m.vx + body.pulled_x + body.sprung_x
                body.to_vy = m.vy + body.pulled_y + body.sprung_y
                body.to_vz = m.vz + body.pulled_z + body.sprung_z
                if turns:
                    x_, y, z = inverse_inertia_times(body, body.twist_x, body.twist_y, body.twist_z)
                    body.to_wx, body.to_wy = body.spun_x + x_, body.spun_y + y
                    body.to_wz = body.spun_z + z
            v.vx, v.vy, v.vz = body.to_vx, body.to_vy, body.to_vz
            if turns:
                v.wx, v.wy, v.wz = body.to_wx, body.to_wy, body.to_wz

    impose = kernel(impose, spec)

    def inner_energy(body, v):
        energy = 0.5 * (v.vx * v.vx + v.vy * v.vy + v.vz * v.vz) / body.inv_m
        if turns:
            x, y, z = inertia_times(body, v.wx, v.wy, v.wz)
            energy += 0.5 * (x * v.wx + y * v.wy + z * v.wz)
        return energy

    inner_energy = kernel(inner_energy, spec)

    def stored(link, bodies):
        stretch = place(link, bodies[link.a], bodies[link.b]).length - link.rest_length
        return 0.5 * link.stiffness * stretch * stretch

    stored = kernel(stored, spec)

    def gains(links, rows, velocities, motion, beside, dt):
        # Whether unions have more energy where the step leads to. rows: where it begins.
        moved, moving = beside.bodies, beside.velocities
        won, had = 0.0, 0.0
        for i in range(rows.shape[0]):
            moved[i] = rows[i]
            row, m = rows[i], motion[i]
            if kinematic:
                if row.again == 0 and row.kinematic == 1:
                    for k in range(links.shape[0]):
                        if links[k].again == 1 and (links[k].a == i or links[k].b == i):
                            return False
            if row.again == 0:
                continue
            moving[i] = velocities[i]
            displace(moved[i], moving[i], m, dt)
            before, after = inner_energy(row, m), inner_energy(moved[i], moving[i])
            x, y, z = moved[i].x - row.x, moved[i].y - row.y, moved[i].z - row.z
            fx, fy, fz = m.dvx - row.sprung_x, m.dvy - row.sprung_y, m.dvz - row.sprung_z
            work = (fx * x + fy * y + fz * z) / (row.inv_m * dt)
            if turns:
                v = velocities[i]
                fx, fy, fz = row.spun_x - m.wx, row.spun_y - m.wy, row.spun_z - m.wz
                fx, fy, fz = inertia_times(row, fx, fy, fz)
                work += 0.5 * (fx * (v.wx + m.wx) + fy * (v.wy + m.wy) + fz * (v.wz + m.wz))
            won, had = won + (after - before - work), had + before + after
        for k in range(links.shape[0]):
            if links[k].again == 1:
                before, after = stored(links[k], rows), stored(links[k], moved)
                won, had = won + (after - before), had + before + after
        beside.lost[0] = max(-won, 0.0)
        return not won <= GAINED * had

    gains = kernel(gains, spec)

    def put(links, rows, contacts, count, velocities, motion, t, dt):
        # Where unions are moved to.
        for i in range(rows.shape[0]):
            if rows[i].group != i + 1 or rows[i].again == 0:
                continue
            group, anchored = i + 1, False
            for k in range(links.shape[0]):
                a, b = rows[links[k].a], rows[links[k].b]
                if links[k].again == 1 and max(a.group, b.group) == group:
                    anchored = anchored or a.inv_m == 0.0 or b.inv_m == 0.0
            for c in range(count):
                a, b = rows[contacts[c].a], rows[contacts[c].b]
                if contacts[c].lambda_n > 0.0 and max(a.group, b.group) == group:
                    anchored = anchored or a.inv_m == 0.0 or b.inv_m == 0.0
            mass, centre, mean = 0.0, Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0)
            if not anchored:
                for j in range(rows.shape[0]):
                    v, m = velocities[j], motion[j]
                    if rows[j].group == group:
                        one = 1.0 / rows[j].inv_m
                        mass += one
                        centre = plus_scaled(centre, one, Vec3(v.vx, v.vy, v.vz))
                        both = Vec3(m.vx + v.vx, m.vy + v.vy, m.vz + v.vz)
                        mean = plus_scaled(mean, 0.5 * one, both)
                centre, mean = scaled(1.0 / mass, centre), scaled(1.0 / mass, mean)
            for j in range(rows.shape[0]):
                row, v = rows[j], velocities[j]
                if row.group == group:
                    u = minus(Vec3(v.vx, v.vy, v.vz), centre)
                    shift = scaled(dt, plus_scaled(mean, t, u))
                    row.shift_x, row.shift_y, row.shift_z = shift.x, shift.y, shift.z
                    if turns:
                        row.turn_x, row.turn_y, row.turn_z = t * v.wx, t * v.wy, t * v.wz
                    row.sprung = BOTH

    put = kernel(put, spec)

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

    def act_beside(state, count, workspace, params, counters, log, midway, before):
        links, bodies, contacts = state.links, state.bodies, state.contacts
        velocities, motion, cache = state.velocities, state.motion, state.cache
        poses, dt = workspace.middle.poses, params.dt
        x, f = workspace.beside.impulses[0], workspace.beside.impulses[1]
        last_x, last_f = workspace.beside.impulses[2], workspace.beside.impulses[3]
        dx, df = workspace.beside.changes[0], workspace.beside.changes[1]
        workspace.beside.lost[0] = 0.0
        joined = join(links, poses if midway else bodies, contacts, count, True)
        if joined == 0:
            return midway
        read(links, x)
        columns, fresh, done, misses = 0, True, False, 0
        for _ in range(PASSES):
            classify(contacts, count, motion, params)
            note_push(bodies, poses if midway else bodies, velocities, motion, midway)
            if midway:
                stand_up(bodies, poses)
            begin_again(links, bodies, velocities, motion, dt)
            if carries_inertia:
                refresh_inertia(bodies, velocities)
            found, _ = find(links, bodies, velocities, motion, dt)
            misses += 0 if found else 1
            moved, same = compare(links, bodies, x, f)
            done = found and (same or moved <= FOUND * params.tolerance)
            if not fresh and not done:
                for i in range(x.shape[0]):
                    dx[columns, i], df[columns, i] = x[i] - last_x[i], f[i] - last_f[i]
                columns = note_change(dx, df, columns)
            for i in range(x.shape[0]):
                last_x[i], last_f[i] = x[i], f[i]
            advance_by(x, f, dx, df, columns)
            fresh = False
            if columns == COLUMNS - 1:
                columns, fresh = 0, True
            impose(links, bodies, velocities, motion, x)
            finish(bodies, velocities, motion, params)
            if warms:
                store_contacts(contacts, count, bodies, cache, counters, params)
            forget_history(counters, log.residual)
            sweeps = counters.sweeps
            counters.midpoint_not_converged, counters.gyroscopic_not_converged = before
            midway = solve(state, count, workspace, params, counters, log, True)
            counters.sweeps += sweeps
            if done or misses > 2:
                break
            again = join(links, poses if midway else bodies, contacts, count, False)
            if again != joined:
                joined, columns, fresh = again, 0, True
                read(links, x)
        rows = poses if midway else bodies
        join(links, rows, contacts, count, False)
        classify(contacts, count, motion, params)
        if gives:
            return midway
        if not gains(links, rows, velocities, motion, workspace.beside, dt):
            return midway
        counters.spring_not_converged += 1
        if midway:
            stand_up(bodies, poses)
        take_settled(links, bodies, velocities, motion, x, dt)
        size = 1.0
        for number in range(SIZES):
            if number == SIZES - 1:
                size = 0.0
            for i in range(x.shape[0]):
                f[i] = size * x[i]
            if carries_inertia:
                refresh_inertia(bodies, velocities)
            impose(links, bodies, velocities, motion, f)
            finish(bodies, velocities, motion, params)
            forget_history(counters, log.residual)
            sweeps = counters.sweeps
            counters.midpoint_not_converged, counters.gyroscopic_not_converged = before
            solve(state, count, workspace, params, counters, log, False)
            counters.sweeps += sweeps
            join(links, bodies, contacts, count, False)
            classify(contacts, count, motion, params)
            share = 1.0
            for last in range(SHARES):
                if number == SIZES - 1 and last == SHARES - 1:
                    share = 0.0
                put(links, bodies, contacts, count, velocities, motion, share, dt)
                if not gains(links, bodies, velocities, motion, workspace.beside, dt):
                    return False
                share *= 0.5
            size *= 0.25
        return False

    return kernel(act_beside, spec)
