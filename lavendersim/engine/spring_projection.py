"""The positional projection moves what springs join only as far as it does no work on them.

Pseudo-velocities move bodies apart without velocity; against a spring that is stretched or pressed
they would store energy that nothing gives, and a body that spins they turn to another energy. Of
bodies that springs join they are halved until what all these gain by them is no more than what the
part of the step has lost (`spring_contacts`).
"""

from __future__ import annotations

from typing import Any

from .compile import kernel
from .integrate import make_displace
from .spec import Spec
from .step_terms import step_terms

HALVINGS = 8


def make_limit_projection(spec: Spec, place: Any) -> Any:
    """Return `kernel(state, workspace, params)`, once pseudo-velocities are found.

    place: kernel of `effects.spring`. Bodies stand where the step begins.
    """
    from .rotation import inertia_times, turn

    turns = step_terms(spec).turns
    displace = make_displace(spec)

    def energy_of(links, bodies, velocities):
        # Of springs, and of the spins that turning changes.
        energy = 0.0
        if turns:
            for i in range(bodies.shape[0]):
                body, v = bodies[i], velocities[i]
                if body.inv_m > 0.0 and body.joined == 1:
                    x, y, z = inertia_times(body, v.wx, v.wy, v.wz)
                    energy += 0.5 * (x * v.wx + y * v.wy + z * v.wz)
        for k in range(links.shape[0]):
            link = links[k]
            if link.active == 1:
                stretch = place(link, bodies[link.a], bodies[link.b]).length - link.rest_length
                energy += 0.5 * link.stiffness * stretch * stretch
        return energy

    energy_of = kernel(energy_of, spec)

    def lead(state, moved, moving, dt, share):
        # Where a step leads, with this share of the projection.
        for i in range(moved.shape[0]):
            body = state.bodies[i]
            moved[i] = body
            if body.inv_m > 0.0 and body.joined == 1:
                moving[i] = state.velocities[i]
                displace(moved[i], moving[i], state.motion[i], dt)
                u, one = state.pseudo[i], moved[i]
                one.x += share * u.vx
                one.y += share * u.vy
                one.z += share * u.vz
                if turns:
                    turn(one, share * u.wx, share * u.wy, share * u.wz)

    lead = kernel(lead, spec)

    def limit_projection(state, workspace, params):
        moved, moving = workspace.beside.bodies, workspace.beside.velocities
        bodies, links = state.bodies, state.links
        lead(state, moved, moving, params.dt, 0.0)
        most = energy_of(links, moved, moving) + workspace.beside.lost[0]
        share = 1.0
        for number in range(HALVINGS + 1):
            if number == HALVINGS:
                share = 0.0
                break
            lead(state, moved, moving, params.dt, share)
            if energy_of(links, moved, moving) <= most:
                break
            share *= 0.5
        if share < 1.0:
            for i in range(bodies.shape[0]):
                if bodies[i].inv_m > 0.0 and bodies[i].joined == 1:
                    u = state.pseudo[i]
                    u.vx, u.vy, u.vz = share * u.vx, share * u.vy, share * u.vz
                    if turns:
                        u.wx, u.wy, u.wz = share * u.wx, share * u.wy, share * u.wz

    return kernel(limit_projection, spec)
