"""State and contacts of one step enter, trace rows leave: all that is logged, computed once."""

from __future__ import annotations

from .block import make_relative_velocity
from .compile import kernel
from .impact_energy import watches
from .records import TOUCHING
from .residual import make_row_residual
from .rotation import inertia_times
from .spec import Spec


def make(spec: Spec):
    """Return two kernels that write the row of a step, `record_contacts` first.

    record_contacts(contacts, count, velocities, params, counters, rows): right after the solve, for
    v_n and the residual belong to the velocities and levers of the solve; turning changes both.
    record_state(bodies, velocities, bits, params, counters, rows): at the end of the step.
    bits: (body bytes, velocity bytes) as uint64 views of the same memory, for the state hash.
    rows: (step rows, pose rows (n, bodies, 7), contact rows); the caller guarantees room.
    """
    rotation = spec.has("rotation")
    friction = spec.has("friction")
    ahead = spec.has("speculative")
    tolerance = spec.tolerance
    sleeps = spec.has("sleeping")
    watched = watches(spec)
    torsional, rolling = spec.has("torsional_friction"), spec.has("rolling_friction")
    row_residual = make_row_residual(spec)
    relative_velocity = make_relative_velocity(spec)

    def hash_into(state_hash, bits):
        # FNV-1a over 64-bit words; -0.0 counts as 0.0, because no result may depend on it.
        for i in range(bits.shape[0]):
            word = bits[i]
            if word == 0x8000000000000000:
                word = word ^ word
            state_hash = (state_hash ^ word) * 0x100000001B3
        return state_hash

    hash_into = kernel(hash_into, spec)

    def record_bodies(bodies, velocities, row, pose, params):
        kinetic, potential = 0.0, 0.0
        px, py, pz = 0.0, 0.0, 0.0
        ax, ay, az = 0.0, 0.0, 0.0
        if sleeps:
            row.awake = 0
        for i in range(pose.shape[0]):
            body, v = bodies[i], velocities[i]
            pose[i, 0], pose[i, 1], pose[i, 2] = body.x, body.y, body.z
            if rotation:
                pose[i, 3], pose[i, 4] = body.qw, body.qx
                pose[i, 5], pose[i, 6] = body.qy, body.qz
            inv_m = body.inv_m
            if sleeps:
                if inv_m > 0.0:
                    row.awake += 1
                if body.asleep == 1:
                    inv_m = body.own_inv_m
            if inv_m > 0.0:
                m = 1.0 / inv_m
                kinetic += 0.5 * m * (v.vx * v.vx + v.vy * v.vy + v.vz * v.vz)
                potential -= m * (params.gx * body.x + params.gy * body.y + params.gz * body.z)
                mx, my, mz = m * v.vx, m * v.vy, m * v.vz
                px, py, pz = px + mx, py + my, pz + mz
                ax += body.y * mz - body.z * my
                ay += body.z * mx - body.x * mz
                az += body.x * my - body.y * mx
                if rotation:
                    lx, ly, lz = inertia_times(body, v.wx, v.wy, v.wz)
                    kinetic += 0.5 * (lx * v.wx + ly * v.wy + lz * v.wz)
                    ax, ay, az = ax + lx, ay + ly, az + lz
        row.kinetic_energy, row.potential_energy = kinetic, potential
        row.momentum_x, row.momentum_y, row.momentum_z = px, py, pz
        row.angular_momentum_x, row.angular_momentum_y, row.angular_momentum_z = ax, ay, az

    record_bodies = kernel(record_bodies, spec)

    def record_contacts(contacts, count, velocities, params, counters, rows):
        steps, _, contact_rows = rows
        row = steps[counters.step_rows]
        force, deepest = 0.0, 0.0
        written = 0
        counters.residual_row = -1
        for c in range(count):
            contact, out = contacts[c], contact_rows[counters.contact_rows + written]
            if ahead:
                # Rows made ahead that neither touch nor push are the solver's, not the scene's.
                if contact.phi > TOUCHING and contact.lambda_n == 0.0:
                    continue
            if c == counters.residual_contact:
                counters.residual_row = written
            written += 1
            va, vb = velocities[contact.a], velocities[contact.b]
            residual, v_n = row_residual(contact, va, vb)
            out.step = counters.step + 1
            out.body_a, out.body_b, out.feature = contact.a, contact.b, contact.feature
            out.x, out.y, out.z = contact.x, contact.y, contact.z
            out.nx, out.ny, out.nz = contact.nx, contact.ny, contact.nz
            out.separation = contact.phi
            out.penetration = max(0.0 - contact.phi, 0.0)
            out.approach_velocity = contact.v_n_pre
            out.normal_velocity = v_n
            out.impulse_n = contact.lambda_n
            out.force_n = contact.lambda_n / params.dt
            out.inverse_effective_mass = contact.k_n
            out.target = contact.target
            out.residual = residual
            if friction:
                x, y, z = relative_velocity(contact, va, vb)
                out.impulse_t1, out.impulse_t2 = contact.lambda_1, contact.lambda_2
                out.slip_t1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
                out.slip_t2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
                out.t1x, out.t1y, out.t1z = contact.t1x, contact.t1y, contact.t1z
                out.friction = contact.mu
            if torsional:
                x, y, z = vb.wx - va.wx, vb.wy - va.wy, vb.wz - va.wz
                out.spin_n = contact.nx * x + contact.ny * y + contact.nz * z
                out.angular_impulse_n = contact.psi_n
                out.torsional_friction = contact.torsional
            if rolling:
                x, y, z = vb.wx - va.wx, vb.wy - va.wy, vb.wz - va.wz
                out.spin_t1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
                out.spin_t2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
                out.angular_impulse_t1, out.angular_impulse_t2 = contact.psi_1, contact.psi_2
                out.rolling_friction = contact.rolling
            force += out.force_n
            # A NaN is deeper than anything, or it would not be seen.
            if out.penetration > deepest or out.penetration != out.penetration:
                deepest = out.penetration
        row.contact_count = written
        counters.rows = written
        row.total_normal_force = force
        row.max_penetration = deepest

    record_contacts = kernel(record_contacts, spec)

    def record_state(bodies, velocities, bits, params, counters, rows):
        steps, poses, _ = rows
        row = steps[counters.step_rows]
        row.step = counters.step
        row.sweeps = counters.sweeps
        row.residual_contact = counters.residual_row
        if watched:
            row.stronge = counters.stronge
        if tolerance:
            row.unsolved = counters.unsolved
        row.residual = counters.residual
        record_bodies(bodies, velocities, row, poses[counters.step_rows], params)
        state_hash = hash_into(0xCBF29CE484222325 ^ row.step, bits[0])
        row.state_hash = hash_into(state_hash, bits[1])
        counters.step_rows += 1
        counters.contact_rows += row.contact_count

    return record_contacts, kernel(record_state, spec)
