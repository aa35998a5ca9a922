"""Turns of bodies that no contact carries: by Cayley's map, exactly, or by the mean of two spins.

turn           by the spin at its start: of uneven bodies as `effects.gyroscopic` has it
free_turn      the same of what keeps its spin, exactly in substeps of round bodies
turn_in_halves under torques, of order 2
"""

from __future__ import annotations

from typing import Any

from .compile import kernel
from .effects import made_once
from .rotation import inertia_times, inverse_inertia_times, is_round, orient, turn_exactly
from .spec import Spec
from .step_terms import step_terms

# A spin whose square shrinks by this in a step is all but stopped: 64 times slower [-].
STOPPED = 4096.0
# Where a turn changes the spin that a body gains by more than this, the step is too long for what
# is stiff in it (a needle about its long axis), and halves are no nearer than the whole [-].
LIKE = 0.1


def make_turn(spec: Spec) -> Any:
    """Return `kernel(body, velocity, dt) -> solved`: the body's turn; None where nothing turns."""
    uneven, turn_uneven = made_once(spec, "turn_uneven")
    return turn_uneven if uneven else made_once(spec, "turn")[1]


def make_free_turn(spec: Spec) -> Any:
    """Return `kernel(body, velocity, dt) -> solved`, of what keeps its spin through a part.

    By Cayley's map. In substeps a round body turns exactly, or what is without any other error
    would take as many as its turn asks for, and a kinematic body, which has no estimate, would lag.
    Springs give the energy that Cayley's map has.
    """
    integrate_rotation: Any = make_turn(spec)
    if not (step_terms(spec).turns and step_terms(spec).substeps):
        return integrate_rotation
    uneven, springs = step_terms(spec).uneven, step_terms(spec).sprung

    def free_turn(body, v, dt):
        exactly = True
        if uneven:
            exactly = is_round(body)
        if springs:
            exactly = exactly and body.sprung == 0
        if not exactly:
            return integrate_rotation(body, v, dt)
        # What does not turn keeps its quaternion to the bit.
        if v.wx != 0.0 or v.wy != 0.0 or v.wz != 0.0:
            turn_exactly(body, v.wx * dt, v.wy * dt, v.wz * dt)
        return True

    return kernel(free_turn, spec)


def make_turn_in_halves(spec: Spec) -> Any:
    """Return `kernel(body, v, m, dt) -> solved`: the body's turn under torques, of order 2.

    Half of the spin that the step gives is given before the turn, half after it; all of it before,
    where the body turns so far that the halves would be unlike: with moments of inertia a million
    to one the second would drive it about the axis that resists least.
    """
    integrate_rotation, free_turn = make_turn(spec), make_free_turn(spec)
    sprung = step_terms(spec).sprung and step_terms(spec).mean_flight

    def turn_in_halves(body, v, m, dt):
        stops = True
        if sprung:
            stops = body.sprung == 0  # what springs turn back turns by the mean as well
        gained_x, gained_y, gained_z = v.wx - m.wx, v.wy - m.wy, v.wz - m.wz
        twisted = gained_x != 0.0 or gained_y != 0.0 or gained_z != 0.0
        # A spin that a step all but stops would cancel to its last digits, and turns nothing.
        last = v.wx * v.wx + v.wy * v.wy + v.wz * v.wz
        before = m.wx * m.wx + m.wy * m.wy + m.wz * m.wz
        if not twisted:
            return free_turn(body, v, dt)
        if not (STOPPED * last >= before or not stops):
            return integrate_rotation(body, v, dt)
        whole_x, whole_y, whole_z = v.wx, v.wy, v.wz
        w, i, j, k = body.qw, body.qx, body.qy, body.qz
        x, y, z = inertia_times(body, gained_x, gained_y, gained_z)
        v.wx, v.wy, v.wz = m.wx + 0.5 * gained_x, m.wy + 0.5 * gained_y, m.wz + 0.5 * gained_z
        solved = integrate_rotation(body, v, dt)
        x, y, z = inverse_inertia_times(body, x, y, z)
        off_x, off_y, off_z = x - gained_x, y - gained_y, z - gained_z
        off = off_x * off_x + off_y * off_y + off_z * off_z
        gained = gained_x * gained_x + gained_y * gained_y + gained_z * gained_z
        if off > LIKE * LIKE * gained:
            body.qw, body.qx, body.qy, body.qz = w, i, j, k
            orient(body)
            v.wx, v.wy, v.wz = whole_x, whole_y, whole_z
            return integrate_rotation(body, v, dt)
        v.wx, v.wy, v.wz = v.wx + 0.5 * x, v.wy + 0.5 * y, v.wz + 0.5 * z
        return solved

    return kernel(turn_in_halves, spec)
