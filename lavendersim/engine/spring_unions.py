"""Unions: bodies that springs join and contacts push, their energy, and where a step moves them.

Joints hold with an impulse of either sign, and join as contacts that push do.

A union is solved as one where springs and contacts act on each other (`spring_contacts`). Its first
body has its number, BODY.group, and tells of all, BODY.again.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from .compile import kernel
from .integrate import make_displace
from .row_terms import make_acts, row_terms
from .spec import Spec
from .spring_surfaces import make_stored_in_contacts
from .spring_turn import BOTH
from .step_terms import step_terms
from .vectors import Vec3, minus, plus_scaled, scaled

# Energy won in a step, of what there is, that solves and round-off leave [-].
GAINED = 1e-10
# The same of unions with a contact spring, whose lever changes as it turns [-].
YIELDED = 1e-6
# Share of its velocities that what is not moved at all keeps: else it would stand for ever [-].
SLOWED = 0.5
# BODY.again while unions are looked for: a contact pushes it.
PUSHED = 2


class Unions(NamedTuple):
    """Kernels of the unions of a part of a step."""

    join: Any  # (links, rows, contacts, count, first) -> how many springs unions have
    gains: Any  # (state, rows, count, beside, params) -> whether they win energy
    pull: Any  # (links, contacts, bodies, count): notes what forces change of their centres
    put: Any  # (state, rows, count, t, dt): where they are moved to
    part: Any  # (links, rows, motion) -> whether bodies are in none any more


def make_unions(spec: Spec, place: Any) -> Unions:
    """Return the kernels; place: kernel of `effects.spring`. rows: bodies where the step begins."""
    from .rotation import inertia_times

    turns, acts = step_terms(spec).turns, make_acts(spec)
    displace = make_displace(spec)
    yields, holds = row_terms(spec).elastic, row_terms(spec).bilateral
    stored_in_contacts: Any = make_stored_in_contacts(spec) if yields else None

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
                if acts(contacts[c]):
                    changed = unite(rows[contacts[c].a], rows[contacts[c].b]) or changed
        for c in range(count):
            if acts(contacts[c]):
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

    def note_shift(shift, before, after):
        # How far a body gets, and how far it turns [rad], as `turn` takes it.
        shift.vx, shift.vy, shift.vz = after.x - before.x, after.y - before.y, after.z - before.z
        if turns:
            w, x, y, z = before.qw, -before.qx, -before.qy, -before.qz
            real = after.qw * w - after.qx * x - after.qy * y - after.qz * z
            share = 2.0 / real if real != 0.0 else 0.0
            shift.wx = share * (after.qw * x + after.qx * w + after.qy * z - after.qz * y)
            shift.wy = share * (after.qw * y - after.qx * z + after.qy * w + after.qz * x)
            shift.wz = share * (after.qw * z + after.qx * y - after.qy * x + after.qz * w)

    note_shift = kernel(note_shift, spec)

    def left_by_joints(state, count, params):
        # Work of rows whose ends part by what solves leave, on either side [J].
        work = 0.0
        for c in range(count):
            if state.contacts[c].bilateral == 1:
                work += abs(state.contacts[c].lambda_n)
        return work * max(params.tolerance, 0.0)

    left_by_joints = kernel(left_by_joints, spec)

    def gains(state, rows, count, beside, params):
        # Whether unions that nothing works on (`spring_surfaces`) have more energy where the step
        # leads to, or it leads nowhere. rows: where it begins.
        moved, moving, dt = beside.bodies, beside.velocities, params.dt
        links, velocities, motion = state.links, state.velocities, state.motion
        won, had = 0.0, 0.0
        for i in range(rows.shape[0]):
            moved[i] = rows[i]
            row, m = rows[i], motion[i]
            if row.again == 0 or rows[row.group - 1].worked == 1:
                continue
            moving[i] = velocities[i]
            if not displace(moved[i], moving[i], m, dt):
                return True  # it turns by more than a step can turn it
            before, after = inner_energy(row, m), inner_energy(moved[i], moving[i])
            x, y, z = moved[i].x - row.x, moved[i].y - row.y, moved[i].z - row.z
            # Of the forces as they are, whatever share of them changed its velocity.
            fx, fy, fz = row.pulled_x, row.pulled_y, row.pulled_z
            work = (fx * x + fy * y + fz * z) / (row.inv_m * dt)
            if turns:
                v = velocities[i]
                fx, fy, fz = row.spun_x - m.wx, row.spun_y - m.wy, row.spun_z - m.wz
                fx, fy, fz = inertia_times(row, fx, fy, fz)
                if row.sprung == BOTH:
                    work += fx * row.turn_x + fy * row.turn_y + fz * row.turn_z
                else:
                    work += 0.5 * (fx * (v.wx + m.wx) + fy * (v.wy + m.wy) + fz * (v.wz + m.wz))
            won, had = won + (after - before - work), had + before + after
        for k in range(links.shape[0]):
            group = max(rows[links[k].a].group, rows[links[k].b].group)
            if links[k].again == 1 and rows[group - 1].worked == 0:
                before, after = stored(links[k], rows), stored(links[k], moved)
                won, had = won + (after - before), had + before + after
        if yields:
            for i in range(rows.shape[0]):
                shift = moving[i]
                shift.vx, shift.vy, shift.vz = 0.0, 0.0, 0.0
                if turns:
                    shift.wx, shift.wy, shift.wz = 0.0, 0.0, 0.0
                if rows[i].again == 1 and rows[rows[i].group - 1].worked == 0:
                    note_shift(shift, rows[i], moved[i])
            stored_more, stored_had = stored_in_contacts(state.contacts, count, rows, moving)
            if stored_had > 0.0:
                beside.lost[0] = max(-won - stored_more, 0.0)
                most = YIELDED * (had + stored_had)
                if holds:
                    most += left_by_joints(state, count, params)
                return not won + stored_more <= most
        beside.lost[0] = max(-won, 0.0)
        most = GAINED * had
        if holds:
            most += left_by_joints(state, count, params)
        return not won <= most

    gains = kernel(gains, spec)

    def is_anchored(links, contacts, rows, count, group):
        # Whether a union touches or is tied to what does not move.
        anchored = False
        for k in range(links.shape[0]):
            a, b = rows[links[k].a], rows[links[k].b]
            if links[k].again == 1 and max(a.group, b.group) == group:
                anchored = anchored or a.inv_m == 0.0 or b.inv_m == 0.0
        for c in range(count):
            a, b = rows[contacts[c].a], rows[contacts[c].b]
            if acts(contacts[c]) and max(a.group, b.group) == group:
                anchored = anchored or a.inv_m == 0.0 or b.inv_m == 0.0
        return anchored

    is_anchored = kernel(is_anchored, spec)

    def part(links, rows, motion):
        # What contacts no longer join to a spring is placed with no union: it has all that forces
        # give it. Contacts come and go while impulses are looked for.
        parted = False
        for i in range(rows.shape[0]):
            row, m = rows[i], motion[i]
            sprung = False
            for k in range(links.shape[0]):
                if links[k].again == 1:
                    a, b = rows[links[k].a], rows[links[k].b]
                    sprung = sprung or max(a.group, b.group) == row.group
            if row.placed == 1 and not sprung:
                row.placed, row.again, row.sprung, parted = 0, 0, 0, True
                row.to_vx, row.to_vy = m.vx + row.pulled_x, m.vy + row.pulled_y
                row.to_vz = m.vz + row.pulled_z
                if turns:
                    row.to_wx, row.to_wy, row.to_wz = row.spun_x, row.spun_y, row.spun_z
        return parted

    part = kernel(part, spec)

    def pull(links, contacts, rows, count):
        # What forces change of the velocity of a union's centre; 0 where something holds it.
        for i in range(rows.shape[0]):
            if rows[i].group != i + 1 or rows[i].again == 0:
                continue
            mass, mean = 0.0, Vec3(0.0, 0.0, 0.0)
            if not is_anchored(links, contacts, rows, count, i + 1):
                for j in range(rows.shape[0]):
                    row = rows[j]
                    if row.group == i + 1:
                        one = 1.0 / row.inv_m
                        mass += one
                        pulled = Vec3(row.pulled_x, row.pulled_y, row.pulled_z)
                        mean = plus_scaled(mean, one, pulled)
                mean = scaled(1.0 / mass, mean)
            for j in range(rows.shape[0]):
                row = rows[j]
                if row.group == i + 1:
                    row.push_x, row.push_y, row.push_z = mean.x, mean.y, mean.z

    pull = kernel(pull, spec)

    def put(state, rows, count, t, dt):
        links, contacts = state.links, state.contacts
        velocities, motion = state.velocities, state.motion
        # Where unions are moved to.
        for i in range(rows.shape[0]):
            if rows[i].group != i + 1 or rows[i].again == 0:
                continue
            group = i + 1
            anchored = is_anchored(links, contacts, rows, count, group)
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
                    if t == 0.0 and anchored:
                        v.vx, v.vy, v.vz = SLOWED * v.vx, SLOWED * v.vy, SLOWED * v.vz
                        if turns:
                            v.wx, v.wy, v.wz = SLOWED * v.wx, SLOWED * v.wy, SLOWED * v.wz

    return Unions(join, gains, pull, kernel(put, spec), part)
