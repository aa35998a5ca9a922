"""The turn under a spring's torque: its work is the energy, its impulse the momentum, exactly."""

from __future__ import annotations

import convex
import numpy as np
import pytest

from lavendersim.engine.compile import inner
from lavendersim.engine.record_layout import allocate_bodies, allocate_velocities
from lavendersim.engine.records import MOTION, dtype
from lavendersim.engine.rotation import orient
from lavendersim.engine.spec import Spec
from lavendersim.engine.spring_turn import make_mean_spin, make_twist

SPEC = Spec(("gyroscopic", "midpoint", "rotation", "spring"), ("box_plane",))
MEAN_SPIN, TWIST = make_mean_spin(SPEC), make_twist(SPEC)


@inner
def twisted(bodies, velocities, motion, dt):
    orient(bodies[0])
    found = MEAN_SPIN(bodies[0], velocities[0], motion[0], dt)
    TWIST(bodies[0], velocities[0], dt)
    return found


def put(row: np.ndarray, names: tuple[str, ...], values: np.ndarray) -> None:
    for name, value in zip(names, values, strict=True):
        row[name] = value


SPIN = ("wx", "wy", "wz")


@pytest.mark.parametrize("principal", [(1.0, 1.0, 1.0), (1.0, 1.0, 3.0), (0.5, 2.0, 2.2)])
@pytest.mark.parametrize("angle", [0.01, 0.4])
def test_energy_is_work_and_momentum_is_impulse(
    principal: tuple[float, ...], angle: float, rng: np.random.Generator
) -> None:
    dt = 0.01
    for _ in range(20):
        bodies, velocities = allocate_bodies(SPEC, 1), allocate_velocities(SPEC, 1)
        motion = np.zeros(1, dtype(MOTION))
        turn = rng.normal(size=4)
        turn /= np.linalg.norm(turn)
        before, gained = rng.normal(size=(2, 3)) * angle / dt / 3.0
        put(bodies, ("qw", "qx", "qy", "qz"), turn)
        put(bodies, ("inv_ix", "inv_iy", "inv_iz"), 1.0 / np.array(principal))
        put(bodies, ("turn_x", "turn_y", "turn_z"), before)
        put(motion, SPIN, before)
        put(velocities, SPIN, before + gained)
        assert twisted(bodies, velocities, motion, dt)
        start = convex.matrix_of(turn)
        inertia = start @ np.diag(principal) @ start.T
        end = convex.matrix_of(np.array([bodies[name][0] for name in ("qw", "qx", "qy", "qz")]))
        inertia_1 = end @ np.diag(principal) @ end.T
        after = np.array([velocities[name][0] for name in SPIN])
        mean = np.array([bodies[f"turn_{axis}"][0] for axis in "xyz"])
        impulse = inertia @ gained
        # A few dozen roundings of numbers of the size of the largest term.
        size = np.linalg.norm(inertia @ before) + np.linalg.norm(impulse)
        bound = 1e-14 * size
        np.testing.assert_allclose(inertia_1 @ after, inertia @ before + impulse, atol=bound)
        energy = 0.5 * (after @ inertia_1 @ after - before @ inertia @ before)
        speed = np.linalg.norm(before) + np.linalg.norm(gained)
        assert energy == pytest.approx(impulse @ mean, abs=1e-13 * size * speed)
        # The rate of the turn is the mean spin: R_1 R_0^T leaves it as it is.
        np.testing.assert_allclose(end @ start.T @ mean, mean, atol=1e-14 * speed)
