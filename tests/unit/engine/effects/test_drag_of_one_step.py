"""One step of drag on a body that stands anyhow, along and about every axis; no engine compiled."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from drawn_contacts import random_frame
from interpreted import interpreted
from plain_facts import matrix_fields, one_row, vector_fields

from lavendersim.engine.effects.drag import make, make_start_step
from lavendersim.engine.spec import Spec

INVERSE_MASS, INVERSE_INERTIA = 0.7, np.array([0.5, 1.1, 2.3])
ANGULAR = 0.6  # [N m s]
EACH = pytest.mark.parametrize(("linear", "quadratic"), [(0.4, 0.3), (0.4, 0.0), (0.0, 0.3)])
START, SPIN = np.array([1.0, -2.0, 0.5]), np.array([0.4, -0.3, 0.9])
PUSH, TWIST = np.array([-0.6, 0.8, 1.2]), np.array([0.5, 0.7, -0.4])  # [m/s^2], [rad/s^2]
EULER, MIDPOINT = Spec(("drag", "rotation")), Spec(("drag", "midpoint", "rotation"))


def ended(
    spec: Spec, dt: float, matrix: np.ndarray, linear: float = 0.4, quadratic: float = 0.3
) -> tuple[np.ndarray, np.ndarray]:
    """Return velocity and spin after a step from START and SPIN under other forces."""
    body = one_row(
        inv_m=INVERSE_MASS,
        drag_linear=linear,
        drag_quadratic=quadratic,
        drag_angular=ANGULAR,
        **vector_fields("drag_v", START),
        **vector_fields("drag_w", SPIN),
        **vector_fields("inv_i", INVERSE_INERTIA),
        **matrix_fields(matrix),
    )
    velocity = one_row(
        **vector_fields("v", START + PUSH * dt), **vector_fields("w", SPIN + TWIST * dt)
    )
    interpreted(make(spec))(body, velocity, one_row(dt=dt))
    return tuple(np.array([velocity[p + axis] for axis in "xyz"]) for p in "vw")  # type: ignore[return-value]


@EACH
def test_by_euler_drag_is_that_of_the_velocity_it_ends_with(linear, quadratic, rng) -> None:
    """(v_1 - v)/dt = -(c1 + c2 |v_1|) v_1/m and I (w_1 - w)/dt = -c w_1, to some ten roundings."""
    dt, matrix = 0.2, random_frame(rng)
    speed, spin = ended(EULER, dt, matrix, linear, quadratic)
    pull = (linear + quadratic * np.linalg.norm(speed)) * INVERSE_MASS * speed
    np.testing.assert_allclose(speed + dt * pull, START + PUSH * dt, atol=1e-14)
    slowed = matrix @ (INVERSE_INERTIA * (matrix.T @ spin))
    np.testing.assert_allclose(spin + dt * ANGULAR * slowed, SPIN + TWIST * dt, atol=1e-14)


def marched(rate: Callable[[np.ndarray], np.ndarray], start: np.ndarray, time: float) -> np.ndarray:
    """Return what y' = rate(y) comes to, by 64 steps of Runge and Kutta's rule: 1e-12 of it."""
    y, h = start, time / 64
    for _ in range(64):
        a = rate(y)
        b = rate(y + 0.5 * h * a)
        c = rate(y + 0.5 * h * b)
        d = rate(y + h * c)
        y = y + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
    return y


@EACH
@pytest.mark.parametrize("which", [0, 1], ids=["velocity", "spin"])
def test_by_the_midpoint_rule_a_step_errs_by_the_third_order(
    which: int, linear: float, quadratic: float, rng
) -> None:
    matrix = random_frame(rng)
    inverse = matrix @ np.diag(INVERSE_INERTIA) @ matrix.T

    def fall(v: Any) -> Any:
        return PUSH - (linear + quadratic * np.linalg.norm(v)) * INVERSE_MASS * v

    def turn(w: Any) -> Any:
        return TWIST - ANGULAR * inverse @ w

    rate, start = (fall, turn)[which], (START, SPIN)[which]

    def truth(dt: float) -> np.ndarray:
        return marched(rate, start, dt)

    errors = [
        np.linalg.norm(
            ended(MIDPOINT, dt, matrix, linear, quadratic)[which] - marched(rate, start, dt)
        )
        for dt in (0.02, 0.01, 0.005)
    ]
    # The next term is dt/tau of it: 0.02 s of some 1 s.
    for one, other in pairwise(errors):
        assert np.log2(one / other) == pytest.approx(3.0, abs=0.1)


def test_velocities_are_kept_as_the_step_begins() -> None:
    fields = {name: float(k) for k, name in enumerate(("vx", "vy", "vz", "wx", "wy", "wz"), 1)}
    bodies = [one_row(**{f"drag_{name}": 0.0 for name in fields}) for _ in range(2)]
    velocities = [one_row(**{name: sign * v for name, v in fields.items()}) for sign in (1.0, -1.0)]
    interpreted(make_start_step(MIDPOINT))(Listed(bodies), velocities)
    for body, velocity in zip(bodies, velocities, strict=True):
        assert [body[f"drag_{n}"] for n in fields] == [velocity[n] for n in fields]


class Listed(list):
    """Rows that are asked for their number as an array is."""

    @property
    def shape(self) -> tuple[int]:
        return (len(self),)
