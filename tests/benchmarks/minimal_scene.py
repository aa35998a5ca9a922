"""Balls that fall on planes, in one function written by hand, on the engine's arrays.

What the pruned engine is measured against: a person's kernel for just this scene, on the arrays
that the engine has (bodies fixed and movable, pairs, contacts, parameters, counters), with the same
discrete mechanics as `minimal_drop` and the same duty to stop when a state is no longer finite. It
has no plan, no shapes, no warm start, no residual and no log. `minimal_drop` keeps one ball in
registers for all steps, which no kernel can that finds its bodies in memory.
"""

from __future__ import annotations

import numba


@numba.njit(error_model="numpy", nogil=True)
def minimal_scene(bodies, velocities, pairs, contacts, parameters, counter, steps, touching):
    """Advance balls above planes; returns whether the state stayed finite."""
    p, counters = parameters[0], counter[0]
    dt = p.dt
    for _ in range(steps):
        count = 0
        for k in range(pairs.shape[0]):
            pair = pairs[k]
            plane, ball = bodies[pair.a], bodies[pair.b]
            phi = plane.hx * ball.x + plane.hy * ball.y + plane.hz * ball.z
            phi = phi - plane.offset - ball.hx
            if phi <= touching:
                contact = contacts[count]
                contact.pair, contact.a, contact.b, contact.phi = k, pair.a, pair.b, phi
                contact.nx, contact.ny, contact.nz = plane.hx, plane.hy, plane.hz
                count += 1
        for i in range(bodies.shape[0]):
            if bodies[i].inv_m > 0.0:
                v = velocities[i]
                v.vx += p.gx * dt
                v.vy += p.gy * dt
                v.vz += p.gz * dt
        for c in range(count):
            contact = contacts[c]
            v = velocities[contact.b]
            contact.v_n_pre = contact.nx * v.vx + contact.ny * v.vy + contact.nz * v.vz
            contact.k_n = bodies[contact.b].inv_m
            contact.target, contact.lambda_n = 0.0, 0.0
            if -contact.v_n_pre > p.restitution_speed:
                contact.target += pairs[contact.pair].restitution * contact.v_n_pre
            excess = -contact.phi - p.slop
            if excess > 0.0:
                contact.target -= p.stabilisation_gain / dt * excess
        if count > 0:
            for _ in range(p.sweeps):
                for c in range(count):
                    contact = contacts[c]
                    v = velocities[contact.b]
                    v_n = contact.nx * v.vx + contact.ny * v.vy + contact.nz * v.vz
                    new = max(0.0, contact.lambda_n - (v_n + contact.target) / contact.k_n)
                    change = (new - contact.lambda_n) * contact.k_n
                    contact.lambda_n = new
                    v.vx += contact.nx * change
                    v.vy += contact.ny * change
                    v.vz += contact.nz * change
            for c in range(count):
                contact = contacts[c]
                v = velocities[contact.b]
                v_n = contact.nx * v.vx + contact.ny * v.vy + contact.nz * v.vz
                excess = -(contact.phi + v_n * dt) - p.slop
                contact.correction = p.projection * max(excess, 0.0)
                contact.push = 0.0
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            if body.inv_m > 0.0:
                body.x += v.vx * dt
                body.y += v.vy * dt
                body.z += v.vz * dt
                total = body.x + body.y + body.z + v.vx * v.vx + v.vy * v.vy + v.vz * v.vz
                if total - total != 0.0:
                    return False
        if count > 0:
            # One ball a contact: nothing else moves it while its contact is corrected.
            for _ in range(p.projection_sweeps):
                for c in range(count):
                    contact = contacts[c]
                    body = bodies[contact.b]
                    missing = contact.correction - contact.push * contact.k_n
                    new = max(contact.push + missing / contact.k_n, 0.0)
                    change = (new - contact.push) * contact.k_n
                    contact.push = new
                    body.x += contact.nx * change
                    body.y += contact.ny * change
                    body.z += contact.nz * change
        counters.step += 1
        counters.contacts = count
    return True


def arrays(engine):
    """Return the arguments of `minimal_scene` before `steps`: those of an engine at its start."""
    return (
        engine.bodies,
        engine.velocities,
        engine.state.pairs,
        engine.contacts,
        engine.parameters,
        engine.counters,
    )
