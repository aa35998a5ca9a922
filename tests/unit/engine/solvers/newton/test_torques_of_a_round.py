"""The torques of a round of Newton's method: their projection, its derivatives, what a round keeps.

The projection by its variational inequality; gradient, slope and matrix by a function whose
derivatives they are, differenced here.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drawn_contacts import random_frame
from interpreted import interpreted
from plain_facts import one_row, vector_fields

from lavendersim.engine.solvers.newton.envelope import DOF, WX
from lavendersim.engine.solvers.newton.torques import (
    make_accept_torques,
    make_add_torque_block,
    make_directional_spin,
    make_gather_torque,
    make_projected_torque,
    make_torque_slope,
)
from lavendersim.engine.spec import Spec

SPEC = Spec(("friction", "rolling_friction", "rotation", "torsional_friction"))
TORSIONAL, ROLLING, LAMBDA = 0.03, 0.02, 5.0
LIMITS = TORSIONAL * LAMBDA, ROLLING * LAMBDA  # [N m s]
STIFF = 2.5, 1.25  # e of torsion and of rolling [N m s^2]
# Turning [rad/s] with which the projection stays inside of its limits, and leaves them.
INSIDE, OUTSIDE = 0.3, 3.0
REGIMES = [(n, t) for n in (INSIDE, OUTSIDE) for t in (INSIDE, OUTSIDE)]


def contact_in(frame: np.ndarray, psi: np.ndarray, spin: np.ndarray, **more: float) -> Any:
    """Return the row of a contact in a round that began with these torques."""
    triples = {"start_psi": psi, "psi": psi, "spin": spin, "step_spin": np.zeros(3)}
    return one_row(
        **{
            f"{name}_{axis}": float(v[k])
            for name, v in triples.items()
            for k, axis in enumerate("n12")
        },
        **{"torsional": TORSIONAL, "rolling": ROLLING, "lambda_n": LAMBDA, **more},
        **dict(zip(("limit_torsion", "limit_roll"), LIMITS, strict=True)),
        **dict(zip(("stiff_torsion", "stiff_roll"), STIFF, strict=True)),
        **vector_fields("n", frame[0]),
        **vector_fields("t1", frame[1]),
        **vector_fields("t2", frame[2]),
    )


def drawn_round(rng: Any, regime: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Return torques well within their limits, and a turning that leads where `regime` says."""
    psi = 0.05 * rng.uniform(-1, 1, 3) * np.array([LIMITS[0], LIMITS[1], LIMITS[1]])
    scale = np.array([LIMITS[0] / STIFF[0], *2 * [LIMITS[1] / STIFF[1]]])
    angle = rng.uniform(0, 2 * np.pi)
    of = np.array(
        [regime[0] * rng.choice([-1, 1]), *regime[1] * np.array([np.cos(angle), np.sin(angle)])]
    )
    return psi, of * scale


@pytest.mark.parametrize("regime", REGIMES)
def test_the_projection_is_the_nearest_torque_within_the_limits(regime, rng) -> None:
    """(x - psi) . (y - psi) <= 0 for every y within them: a half-line and a disc, so that it is
    enough to look at their ends. Beyond the limits, and only there, psi is on them. To rounding.
    """
    start, spin = drawn_round(rng, regime)
    contact = contact_in(np.eye(3), start, spin)
    psi = start + interpreted(make_projected_torque(SPEC))(contact, 0.0)
    x = start - np.array([STIFF[0], STIFF[1], STIFF[1]]) * spin
    around = np.linspace(0, 2 * np.pi, 100)
    for n in (-LIMITS[0], LIMITS[0]):
        assert (x[0] - psi[0]) * (n - psi[0]) <= 1e-15
    for y in LIMITS[1] * np.stack([np.cos(around), np.sin(around)], axis=1):
        assert (x[1:] - psi[1:]) @ (y - psi[1:]) <= 1e-15
    for size, limit, how in zip((abs(psi[0]), np.hypot(*psi[1:])), LIMITS, regime, strict=True):
        assert size <= limit * (1 + 1e-15)
        assert (size == pytest.approx(limit, rel=1e-15)) == (how == OUTSIDE)


def potential(frame: np.ndarray, start: np.ndarray, spin: np.ndarray, turns: np.ndarray) -> float:
    """Return the function of the bodies' turning (a, b) whose gradient is -S^T (psi - psi^k).

    Of each part, with x = psi^k - e omega: (|x|^2 - |x - proj(x)|^2) / (2 e) + psi^k . omega. The
    derivative by omega of the first term is -proj(x) (Moreau), of the second psi^k.
    """
    omega, total = spin + frame @ (turns[1] - turns[0]), 0.0
    for part, e, limit in ((slice(0, 1), STIFF[0], LIMITS[0]), (slice(1, 3), STIFF[1], LIMITS[1])):
        size = np.linalg.norm(start[part] - e * omega[part])
        beyond = max(size - limit, 0.0)
        total += (size**2 - beyond**2) / (2 * e) + start[part] @ omega[part]
    return float(total)


def gradient_at(frame, start, spin, turns) -> np.ndarray:
    contact = contact_in(frame, start, spin + frame @ (turns[1] - turns[0]))
    gradient = np.zeros(2 * DOF)
    interpreted(make_gather_torque(SPEC))(contact, 0, 1, gradient)
    assert not gradient.reshape(2, DOF)[:, :WX].any()
    return gradient


def differenced(function: Any, direction: np.ndarray, h: float) -> Any:
    """Central difference of what is quadratic or smooth: h^2, and the rounding of values over h."""
    return (function(h * direction) - function(-h * direction)) / (2 * h)


@pytest.mark.parametrize("regime", REGIMES)
def test_gradient_and_slope_are_derivatives_of_one_potential(regime, rng) -> None:
    """Values of some 0.3 are rounded by 1e-16 over h = 1e-5 to 1e-11; third derivatives of a norm
    beyond its limit, e^2 limit / |x|^2 of some 1, times h^2 / 6 are as much.
    """
    frame, (start, spin) = random_frame(rng), drawn_round(rng, regime)
    direction = rng.normal(size=(2, 3))
    expected = differenced(lambda turns: potential(frame, start, spin, turns), direction, 1e-5)
    gradient = gradient_at(frame, start, spin, np.zeros((2, 3)))
    step = np.hstack([np.zeros((2, 3)), direction]).ravel()
    assert gradient @ step == pytest.approx(expected, abs=5e-10)
    contact = contact_in(frame, start, spin)
    interpreted(make_directional_spin(SPEC))(contact, 0, 1, step)
    assert interpreted(make_torque_slope(SPEC))(contact, 0.0) == pytest.approx(expected, abs=5e-10)
    ahead = gradient_at(frame, start, spin, 0.1 * direction) @ step
    assert interpreted(make_torque_slope(SPEC))(contact, 0.1) == pytest.approx(ahead, rel=1e-13)


@pytest.mark.parametrize("regime", REGIMES)
def test_the_matrix_is_the_derivative_of_the_gradient(regime, rng) -> None:
    """Tolerance as above, with a gradient of some 0.1 and its own third derivatives."""
    frame, (start, spin) = random_frame(rng), drawn_round(rng, regime)
    rows = 2 * DOF
    first, lengths = np.zeros(2, np.int64), np.arange(1, rows + 1)
    begin = np.concatenate([[0], np.cumsum(lengths)[:-1]])
    workspace = SimpleNamespace(values=np.zeros(lengths.sum()), start=begin, first=first)
    interpreted(make_add_torque_block(SPEC))(contact_in(frame, start, spin), 0, 1, workspace)
    matrix = np.zeros((rows, rows))
    for row, (at, length) in enumerate(zip(begin, lengths, strict=True)):
        matrix[row, :length] = workspace.values[at : at + length]
    matrix += np.tril(matrix, -1).T
    direction = rng.normal(size=(2, 3))
    expected = differenced(lambda turns: gradient_at(frame, start, spin, turns), direction, 1e-5)
    step = np.hstack([np.zeros((2, 3)), direction]).ravel()
    np.testing.assert_allclose(matrix @ step, expected, atol=5e-9)


@pytest.mark.parametrize("regime", REGIMES)
def test_a_round_ends_with_the_projected_torques_within_what_the_new_impulse_allows(
    regime, rng
) -> None:
    """Half the impulse, half the limits: what was beyond the old ones is on the new ones, and both
    bodies have turned by what the torques changed.
    """
    frame, (start, spin) = random_frame(rng), drawn_round(rng, regime)
    # What an update without turning reads besides, and multiplies by 0 rad/s.
    unused = dict.fromkeys(("k_torsion", "k_roll", "h_11", "h_12", "h_22"), 1.0)
    contact = contact_in(frame, start, spin, **unused)
    expected = start + interpreted(make_projected_torque(SPEC))(contact, 0.0)
    contact.lambda_n = 0.5 * LAMBDA
    for part, limit in ((slice(0, 1), LIMITS[0]), (slice(1, 3), LIMITS[1])):
        size = np.linalg.norm(expected[part])
        expected[part] *= min(1.0, 0.5 * limit / size)
    inverse = dict.fromkeys(("jxx", "jyy", "jzz"), 1.0) | dict.fromkeys(("jxy", "jxz", "jyz"), 0.0)
    bodies = [one_row(**vector_fields("w", np.zeros(3)), **inverse) for _ in range(2)]
    interpreted(make_accept_torques(SPEC))(contact, *bodies)
    found = np.array([contact.psi_n, contact.psi_1, contact.psi_2])
    np.testing.assert_allclose(found, expected, rtol=1e-14)
    turned = frame.T @ (found - start)
    for body, sign in zip(bodies, (-1.0, 1.0), strict=True):
        np.testing.assert_allclose([body.wx, body.wy, body.wz], sign * turned, atol=1e-15)
