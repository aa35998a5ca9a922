"""Bodies that springs join, as a group: its energy, its momentum, and its spin as if it were rigid.

BODY.group is 1 + the number of the group's first body; bodies that do not move are in none.
    P = sum m v,  h = sum (r x m (v - V) + I omega),  r: from the group's centre, V: its velocity
    I_c omega_c = h,  I_c = sum (I + m (r.r 1 - r r^T))
h . omega_c/2 is the least energy that a group with h has in its pose.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from .compile import kernel
from .spec import Spec
from .step_terms import step_terms
from .vectors import Vec3, cross, dot, length, minus, plus, plus_scaled, position, scaled


class GroupKernels(NamedTuple):
    """Kernels of groups of bodies."""

    label: Any  # (links, bodies): every body its group
    within: Any  # (link, bodies, group) -> whether a spring acts on one of its bodies
    stored: Any  # (links, bodies, group) -> energy of its springs [J]
    spin_of: Any  # (v) -> omega; 0 where nothing turns
    set_velocity: Any  # (v, u, omega)
    centre_of: Any  # (bodies, velocities, group) -> mass, centre, V
    momentum_of: Any  # (bodies, velocities, group, centre, V) -> h, energy beside the centre's
    rigid_spin: Any  # (bodies, group, centre, h) -> omega_c; 0 for a line that has no spin about it
    angular: Any  # (body, omega) -> angular momentum; omega where nothing turns


def make_group(spec: Spec, place: Any) -> GroupKernels:
    """Return the kernels; place: that of `effects.spring`."""
    from .rotation import inertia_times

    turns = step_terms(spec).turns

    def label(links, bodies):
        # Every movable body has the group of the lowest of those that springs join it to.
        for i in range(bodies.shape[0]):
            bodies[i].group = i + 1 if bodies[i].inv_m > 0.0 and bodies[i].joined == 1 else 0
        changed = True
        while changed:
            changed = False
            for k in range(links.shape[0]):
                link = links[k]
                a, b = bodies[link.a], bodies[link.b]
                if link.active == 1 and a.group > 0 and b.group > 0 and a.group != b.group:
                    a.group, b.group = min(a.group, b.group), min(a.group, b.group)
                    changed = True

    label = kernel(label, spec)

    def within(link, bodies, group):
        if link.active == 0:
            return False
        return bodies[link.a].group == group or bodies[link.b].group == group

    within = kernel(within, spec)

    def stored(links, bodies, group):
        energy = 0.0
        for k in range(links.shape[0]):
            link = links[k]
            if within(link, bodies, group):
                stretch = place(link, bodies[link.a], bodies[link.b]).length - link.rest_length
                energy += 0.5 * link.stiffness * stretch * stretch
        return energy

    stored = kernel(stored, spec)

    def spin_of(v):
        if turns:
            return Vec3(v.wx, v.wy, v.wz)
        return Vec3(0.0, 0.0, 0.0)

    spin_of = kernel(spin_of, spec)

    def angular(body, w):
        if turns:
            x, y, z = inertia_times(body, w.x, w.y, w.z)
            return Vec3(x, y, z)
        return w

    angular = kernel(angular, spec)

    def set_velocity(v, u, w):
        v.vx, v.vy, v.vz = u.x, u.y, u.z
        if turns:
            v.wx, v.wy, v.wz = w.x, w.y, w.z

    set_velocity = kernel(set_velocity, spec)

    def centre_of(bodies, velocities, group):
        # Mass, place and velocity.
        mass, place_of, speed = 0.0, Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0)
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            if body.group == group:
                one = 1.0 / body.inv_m
                mass += one
                place_of = plus_scaled(place_of, one, position(body))
                speed = plus_scaled(speed, one, Vec3(v.vx, v.vy, v.vz))
        return mass, scaled(1.0 / mass, place_of), scaled(1.0 / mass, speed)

    centre_of = kernel(centre_of, spec)

    def momentum_of(bodies, velocities, group, centre, speed):
        # Angular momentum about a centre that moves, and the energy beside the centre's.
        total, energy = Vec3(0.0, 0.0, 0.0), 0.0
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            if body.group == group:
                p = scaled(1.0 / body.inv_m, minus(Vec3(v.vx, v.vy, v.vz), speed))
                total = plus(total, cross(minus(position(body), centre), p))
                energy += 0.5 * body.inv_m * dot(p, p)
                if turns:
                    w = spin_of(v)
                    spun = angular(body, w)
                    total, energy = plus(total, spun), energy + 0.5 * dot(spun, w)
        return total, energy

    momentum_of = kernel(momentum_of, spec)

    def rigid_spin(bodies, group, centre, h):
        # omega of a rigid group with the angular momentum h: I omega = h by Cramer's rule.
        x, y, z = Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0)
        ex, ey, ez = Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0), Vec3(0.0, 0.0, 1.0)
        for i in range(bodies.shape[0]):
            body = bodies[i]
            if body.group == group:
                r, m = minus(position(body), centre), 1.0 / body.inv_m
                x = plus_scaled(x, m, cross(r, cross(ex, r)))
                y = plus_scaled(y, m, cross(r, cross(ey, r)))
                z = plus_scaled(z, m, cross(r, cross(ez, r)))
                if turns:
                    x, y = plus(x, angular(body, ex)), plus(y, angular(body, ey))
                    z = plus(z, angular(body, ez))
        yz = cross(y, z)
        scale = dot(x, yz)
        if scale <= 1e-12 * length(x) * length(yz):  # a line of bodies that do not turn
            return Vec3(0.0, 0.0, 0.0)
        scale = 1.0 / scale
        return Vec3(scale * dot(h, yz), scale * dot(h, cross(z, x)), scale * dot(h, cross(x, y)))

    rigid_spin = kernel(rigid_spin, spec)

    return GroupKernels(
        label, within, stored, spin_of, set_velocity, centre_of, momentum_of, rigid_spin, angular
    )
