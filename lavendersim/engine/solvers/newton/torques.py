"""Torques in Newton's method: projected, their derivative, and what a round ends with.

A contact that resists turning (`spin_block`) has, at the relative angular velocity omega, around
the psi^k that a round begins with, and within limits that stand still in a round:
    psi = proj(x),   x = psi^k - e omega,   |psi_n| <= c lambda_n^k,   |psi_t| <= c lambda_n^k,
e = E = 1/(softness k) of either part. The round over, psi is brought within what the new lambda_n
allows, and velocities follow: the residual judges impulses and torques that are in their cones.
"""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

from ...compile import inner, kernel
from ...effects import made_once
from ...row_terms import row_terms
from ...spec import Spec
from ...spin_block import make_apply_spin, resists_turning
from .envelope import DOF, WX, WY, WZ
from .factor import entry, make_block_at


def make_start_torques(spec: Spec) -> Any:
    """Return `kernel(contact, va, vb, softness)`: what a round begins with."""
    terms = row_terms(spec)
    torsional, rolling = terms.torsional, terms.rolling

    def start_torques(contact, va, vb, softness):
        x, y, z = vb.wx - va.wx, vb.wy - va.wy, vb.wz - va.wz
        if torsional:
            contact.start_psi_n = contact.psi_n
            contact.spin_n = contact.nx * x + contact.ny * y + contact.nz * z
            contact.step_spin_n = 0.0
            contact.stiff_torsion = 1.0 / (softness * contact.k_torsion)
            contact.limit_torsion = contact.torsional * contact.lambda_n
        if rolling:
            contact.start_psi_1, contact.start_psi_2 = contact.psi_1, contact.psi_2
            contact.spin_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
            contact.spin_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
            contact.step_spin_1, contact.step_spin_2 = 0.0, 0.0
            contact.stiff_roll = 1.0 / (softness * contact.k_roll)
            contact.limit_roll = contact.rolling * contact.lambda_n

    return kernel(start_torques, spec) if resists_turning(spec) else None


def make_limits_torque(spec: Spec) -> Any:
    """Return `kernel(contact) -> bool`: whether it resists turning at all."""
    terms = row_terms(spec)
    torsional, rolling = terms.torsional, terms.rolling

    def limits_torque(contact):
        limited = False
        if torsional:
            limited = contact.torsional > 0.0
        if rolling:
            limited = limited or contact.rolling > 0.0
        return limited

    return kernel(limits_torque, spec) if resists_turning(spec) else None


def make_projected_torque(spec: Spec) -> Any:
    """Return `kernel(contact, length) -> (n, one, two)`: psi - psi^k so far along the step."""
    terms = row_terms(spec)
    torsional, rolling = terms.torsional, terms.rolling

    def projected_torque(contact, length):
        n, one, two = 0.0, 0.0, 0.0
        if torsional:
            if contact.torsional > 0.0:
                most = contact.limit_torsion
                x = contact.spin_n + length * contact.step_spin_n
                x = contact.start_psi_n - contact.stiff_torsion * x
                n = min(max(x, -most), most) - contact.start_psi_n
        if rolling:
            if contact.rolling > 0.0:
                most, e = contact.limit_roll, contact.stiff_roll
                one = contact.start_psi_1 - e * (contact.spin_1 + length * contact.step_spin_1)
                two = contact.start_psi_2 - e * (contact.spin_2 + length * contact.step_spin_2)
                r = sqrt(one * one + two * two)
                if r > most:
                    one, two = one * (most / r), two * (most / r)
                one, two = one - contact.start_psi_1, two - contact.start_psi_2
        return n, one, two

    return kernel(projected_torque, spec) if resists_turning(spec) else None


def make_gather_torque(spec: Spec) -> Any:
    """Return `kernel(contact, a, b, gradient)`: -= S^T (psi - psi^k); a, b: positions, -1: none."""
    projected_torque = make_projected_torque(spec)

    def gather_torque(contact, a, b, gradient):
        n, one, two = projected_torque(contact, 0.0)
        if n != 0.0 or one != 0.0 or two != 0.0:
            x = contact.nx * n + contact.t1x * one + contact.t2x * two
            y = contact.ny * n + contact.t1y * one + contact.t2y * two
            z = contact.nz * n + contact.t1z * one + contact.t2z * two
            if a >= 0:
                gradient[DOF * a + WX] += x
                gradient[DOF * a + WY] += y
                gradient[DOF * a + WZ] += z
            if b >= 0:
                gradient[DOF * b + WX] -= x
                gradient[DOF * b + WY] -= y
                gradient[DOF * b + WZ] -= z

    return kernel(gather_torque, spec) if resists_turning(spec) else None


def make_directional_spin(spec: Spec) -> Any:
    """Return `kernel(contact, a, b, step)`: what the step adds to the turning that it sees."""
    terms = row_terms(spec)
    torsional, rolling = terms.torsional, terms.rolling

    def directional_spin(contact, a, b, step):
        x, y, z = 0.0, 0.0, 0.0
        if a >= 0:
            x, y, z = -step[DOF * a + WX], -step[DOF * a + WY], -step[DOF * a + WZ]
        if b >= 0:
            x, y, z = x + step[DOF * b + WX], y + step[DOF * b + WY], z + step[DOF * b + WZ]
        if torsional:
            contact.step_spin_n = contact.nx * x + contact.ny * y + contact.nz * z
        if rolling:
            contact.step_spin_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
            contact.step_spin_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z

    return kernel(directional_spin, spec) if resists_turning(spec) else None


def make_torque_slope(spec: Spec) -> Any:
    """Return `kernel(contact, length) -> the torques' part of the derivative along the step`."""
    terms = row_terms(spec)
    torsional, rolling = terms.torsional, terms.rolling
    projected_torque = make_projected_torque(spec)

    def torque_slope(contact, length):
        n, one, two = projected_torque(contact, length)
        total = 0.0
        if torsional:
            total -= contact.step_spin_n * n
        if rolling:
            total -= contact.step_spin_1 * one + contact.step_spin_2 * two
        return total

    return kernel(torque_slope, spec) if resists_turning(spec) else None


def make_advance_spin(spec: Spec) -> Any:
    """Return `kernel(contact, length)`: the step, so much of it, is taken."""
    terms = row_terms(spec)
    torsional, rolling = terms.torsional, terms.rolling

    def advance_spin(contact, length):
        if torsional:
            contact.spin_n += length * contact.step_spin_n
            contact.step_spin_n = 0.0
        if rolling:
            contact.spin_1 += length * contact.step_spin_1
            contact.spin_2 += length * contact.step_spin_2
            contact.step_spin_1, contact.step_spin_2 = 0.0, 0.0

    return kernel(advance_spin, spec) if resists_turning(spec) else None


class Symmetric(NamedTuple):
    """A symmetric 3x3 matrix, world axes."""

    xx: float
    xy: float
    xz: float
    yy: float
    yz: float
    zz: float


@inner
def _add(values, block, diagonal, scale, t):
    # += scale T on the turning of a block; diagonal: its lower half alone.
    values[entry(block, WX, WX)] += scale * t.xx
    values[entry(block, WY, WX)] += scale * t.xy
    values[entry(block, WY, WY)] += scale * t.yy
    values[entry(block, WZ, WX)] += scale * t.xz
    values[entry(block, WZ, WY)] += scale * t.yz
    values[entry(block, WZ, WZ)] += scale * t.zz
    if not diagonal:
        values[entry(block, WX, WY)] += scale * t.xy
        values[entry(block, WX, WZ)] += scale * t.xz
        values[entry(block, WY, WZ)] += scale * t.yz


def make_add_torque_block(spec: Spec) -> Any:
    """Return `kernel(contact, a, b, workspace)`: matrix += S^T E' S, E' = -d psi / d omega."""
    terms = row_terms(spec)
    torsional, rolling = terms.torsional, terms.rolling
    block_at = make_block_at(spec)

    def add_torque_block(contact, a, b, workspace):
        h_nn, h_11, h_12, h_22 = 0.0, 0.0, 0.0, 0.0
        if torsional:
            if contact.torsional > 0.0:  # without, not even what turns at no rate is kept
                x = contact.start_psi_n - contact.stiff_torsion * contact.spin_n
                if abs(x) <= contact.limit_torsion:
                    h_nn = contact.stiff_torsion
        if rolling:
            if contact.rolling > 0.0:
                e, most = contact.stiff_roll, contact.limit_roll
                one = contact.start_psi_1 - e * contact.spin_1
                two = contact.start_psi_2 - e * contact.spin_2
                r = sqrt(one * one + two * two)
                if r <= most:
                    h_11, h_22 = e, e
                else:  # around the disc only
                    around = e * (most / r)
                    u, v = one / r, two / r
                    h_11, h_12, h_22 = around * v * v, -around * u * v, around * u * u
        if h_nn > 0.0 or h_11 > 0.0 or h_22 > 0.0:
            nx, ny, nz = contact.nx, contact.ny, contact.nz
            ax, ay, az = contact.t1x, contact.t1y, contact.t1z
            bx, by, bz = contact.t2x, contact.t2y, contact.t2z
            # T = h_nn n n^T + t1 (h_11 t1 + h_12 t2)^T + t2 (h_12 t1 + h_22 t2)^T
            px, py, pz = h_11 * ax + h_12 * bx, h_11 * ay + h_12 * by, h_11 * az + h_12 * bz
            qx, qy, qz = h_12 * ax + h_22 * bx, h_12 * ay + h_22 * by, h_12 * az + h_22 * bz
            t = Symmetric(
                h_nn * nx * nx + ax * px + bx * qx,
                h_nn * nx * ny + ax * py + bx * qy,
                h_nn * nx * nz + ax * pz + bx * qz,
                h_nn * ny * ny + ay * py + by * qy,
                h_nn * ny * nz + ay * pz + by * qz,
                h_nn * nz * nz + az * pz + bz * qz,
            )
            values = workspace.values
            if a >= 0:
                _add(values, block_at(workspace, a, a), True, 1.0, t)
            if b >= 0:
                _add(values, block_at(workspace, b, b), True, 1.0, t)
            if a >= 0 and b >= 0:
                _add(values, block_at(workspace, max(a, b), min(a, b)), False, -1.0, t)

    return kernel(add_torque_block, spec) if resists_turning(spec) else None


def make_accept_torques(spec: Spec) -> Any:
    """Return `kernel(contact, va, vb)`: the projected psi, within what the new lambda_n allows."""
    if not resists_turning(spec):
        return None
    projected_torque, apply_spin = make_projected_torque(spec), make_apply_spin(spec)
    # An update without turning is the projection alone.
    torsional, project_torsion = made_once(spec, "solve_torsion")
    rolling, project_rolling = made_once(spec, "solve_rolling")

    def accept_torques(contact, va, vb):
        n, one, two = projected_torque(contact, 0.0)
        if torsional:
            contact.psi_n += n
            n += project_torsion(contact, 0.0)
        if rolling:
            contact.psi_1 += one
            contact.psi_2 += two
            more_1, more_2 = project_rolling(contact, 0.0, 0.0)
            one, two = one + more_1, two + more_2
        apply_spin(contact, va, vb, n, one, two)

    return kernel(accept_torques, spec)


def make_keep_torques(spec: Spec) -> Any:
    """Return `kernel(contact)`: psi is the best so far."""
    terms = row_terms(spec)
    torsional, rolling = terms.torsional, terms.rolling

    def keep_torques(contact):
        if torsional:
            contact.best_psi_n = contact.psi_n
        if rolling:
            contact.best_psi_1, contact.best_psi_2 = contact.psi_1, contact.psi_2

    return kernel(keep_torques, spec) if resists_turning(spec) else None


def make_restore_torques(spec: Spec, which: str) -> Any:
    """Return `kernel(contact, va, vb)`: psi as at the `start` of the round, or the `best` so far.

    Velocities follow.
    """
    if not resists_turning(spec):
        return None
    terms = row_terms(spec)
    torsional, rolling = terms.torsional, terms.rolling
    apply_spin = make_apply_spin(spec)
    kept_n, kept_1, kept_2 = (f"{which}_psi_{axis}" for axis in "n12")

    def restore(contact, va, vb):
        n, one, two = 0.0, 0.0, 0.0
        if torsional:
            psi = contact[kept_n]
            n, contact.psi_n = psi - contact.psi_n, psi
        if rolling:
            psi_1, psi_2 = contact[kept_1], contact[kept_2]
            one, two = psi_1 - contact.psi_1, psi_2 - contact.psi_2
            contact.psi_1, contact.psi_2 = psi_1, psi_2
        apply_spin(contact, va, vb, n, one, two)

    restore.__name__ = f"restore_torques_{which}"  # as `lavender plan` lists them
    restore.__qualname__ += f"_{which}"
    return kernel(restore, spec)
