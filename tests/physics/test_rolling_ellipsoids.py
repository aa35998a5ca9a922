"""An ellipsoid on a plane: it rocks in the time of its curvature, to order 2, and keeps its energy.

Rocking about y by the angle q, without slip, it has one degree of freedom. With its support
h(q)^2 = a^2 sin^2 q + c^2 cos^2 q its centre is h high and h' beside its contact:
    I q'' + I' q'^2 / 2 + m g h' = 0,    I(q) = m (a^2 + c^2)/5 + m (h^2 + h'^2)
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from shared_runs import GRAVITY, States, config, flow, orders, run_scenes

A, B, C = 0.2, 0.15, 0.1  # semi-axes [m]
ROCKING, TUMBLING = (120, 240, 480), (240, 480, 960)  # steps a second
START = 0.4  # [rad]
AXES = (A, B, C)
FLOOR = {"floor": "{shape: {kind: plane}, surface: one}"}


def height(q: float) -> tuple[float, float, float]:
    """Return h, h', h'' [m]."""
    h = math.hypot(A * math.sin(q), C * math.cos(q))
    slope = (A * A - C * C) * math.sin(q) * math.cos(q) / h
    return h, slope, ((A * A - C * C) * math.cos(2.0 * q) - slope * slope) / h


def rocked(times: np.ndarray) -> np.ndarray:
    """Return the angle by time, from rest at START."""

    def rates(_, state):
        q, w = state
        h, slope, bend = height(q)
        inertia = (A * A + C * C) / 5.0 + h * h + slope * slope
        turned = h * slope + slope * bend
        return [w, -(turned * w * w + GRAVITY * slope) / inertia]

    span = (0.0, float(times[-1]))
    found = solve_ivp(rates, span, [START, 0.0], "DOP853", times, rtol=1e-12, atol=1e-13)
    return found.y[0]


def body(
    shape: str,
    centre: float,
    q: float = 0.0,
    spin: tuple[float, ...] = (),
    way: tuple[float, ...] = (),
) -> str:
    turn = flow((math.cos(0.5 * q), 0, math.sin(0.5 * q), 0))
    text = (
        f"{{shape: {shape}, mass: 1.0, surface: one, position: {flow((0, 0, centre))}, "
        f"orientation: {turn}"
    )
    text += f", angular_velocity: {flow(spin)}" if spin else ""
    return f"{text}, velocity: {flow(way)}}}" if way else f"{text}}}"


def ellipsoid(axes: tuple[float, float, float]) -> str:
    return f"{{kind: ellipsoid, semi_axes: {flow(axes)}}}"


HURLED = (3.0, -2.0, 5.0)  # [rad/s]
TURNING = (0.0, 0.0, 6.0)  # about the vertical: the contact moves aside, and it rolls
UPRIGHT = (0.0, 0.0, 20.0)
WAY = (0.3, 0.2, 0.0)


def scene(it: str, rate: int, duration: float, friction: float = 2.0) -> str:
    text = config(FLOOR | {"it": it}, rate, duration, f"friction: {friction}", repr(GRAVITY))
    return text.replace("timestep:", "integrator: midpoint_contact, timestep:")


def rolling(q: float, spin: tuple[float, ...]) -> tuple[float, ...]:
    """Return the velocity of the centre by which the lowest point is at rest [m/s]."""
    turn = np.array([[math.cos(q), 0, math.sin(q)], [0, 1, 0], [-math.sin(q), 0, math.cos(q)]])
    lowest = turn @ np.diag(np.square(AXES)) @ turn.T @ (0.0, 0.0, -1.0) / height(q)[0]
    return tuple(-np.cross(spin, lowest))


def scenes() -> dict[str, str]:
    it, found = ellipsoid(AXES), {}
    for rate in ROCKING:
        found[f"rocks {rate}"] = scene(body(it, height(START)[0], START), rate, 1.0)
    for rate in TUMBLING:
        found[f"tumbles {rate}"] = scene(
            body(it, height(0.3)[0], 0.3, TURNING, rolling(0.3, TURNING)), rate, 0.5
        )
    found["spins"] = scene(body(ellipsoid((A, A, C)), C, 0.0, UPRIGHT), 480, 0.5)
    ball = "{kind: sphere, radius: 0.1}"
    found["ball"] = scene(body(ball, 0.3, 0.0, HURLED, WAY), 480, 1.0)
    found["round"] = scene(body(ellipsoid((0.1, 0.1, 0.1)), 0.3, 0.0, HURLED, WAY), 480, 1.0)
    return found


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    return run_scenes(scenes())


def angle(states: States) -> np.ndarray:
    turn = states.turn[:, states.names.index("it")]
    return 2.0 * np.arctan2(turn[:, 2], turn[:, 0])


def test_it_rocks_as_its_curvature_says_to_order_2(ran: dict[str, States]) -> None:
    errors = [
        float(abs(angle(states) - rocked(states.time)).max())
        for states in (ran[f"rocks {rate}"] for rate in ROCKING)
    ]
    # A series in (w dt)^2, (12/120)^2 = 0.01: a next term of up to ten times its share, as swings
    # so wide have, changes a ratio by 1.1/1.025: log2 of it is 0.10.
    assert orders(errors) == pytest.approx([2.0, 2.0], abs=0.1)
    assert errors[-1] < 1e-3 * START


def test_small_rocking_has_the_frequency_of_its_curvature() -> None:
    """The reference against the closed form: w^2 = g (a^2 - c^2)/c / ((a^2 + c^2)/5 + c^2)."""
    h, slope, bend = height(0.0)
    assert (h, slope) == (C, 0.0)
    assert bend == pytest.approx((A * A - C * C) / C, rel=1e-15)


@pytest.mark.parametrize(("motion", "rates"), [("rocks", ROCKING), ("tumbles", TUMBLING)])
def test_energy_is_kept_to_order_2(
    ran: dict[str, States], motion: str, rates: tuple[int, ...]
) -> None:
    """At least: contacts that hold on the mean of a step's velocities do no work themselves."""
    errors = []
    for rate in rates:
        energy = ran[f"{motion} {rate}"].energy()
        errors.append(float(abs(energy - energy[0]).max()))
    assert min(orders(errors)) >= 1.9
    assert errors[-1] < 1e-3 * GRAVITY * (A - C)


def test_without_torsional_friction_a_spin_about_the_normal_never_decays(
    ran: dict[str, States],
) -> None:
    _, _, spin = ran["spins"].of("it")
    # Round-off of 240 steps.
    np.testing.assert_allclose(spin, np.tile(UPRIGHT, (len(spin), 1)), atol=240 * 4e-15 * 20.0)


def test_equal_axes_move_as_a_sphere(ran: dict[str, States]) -> None:
    """Falling, bouncing off, slipping and rolling: supports differ by round-off."""
    ball, found = ran["ball"], ran["round"]
    # Solves end at 1e-9 m/s; over a second a difference of that grows to 1e-9 m.
    np.testing.assert_allclose(found.of("it")[0], ball.of("it")[0], atol=1e-9)
    np.testing.assert_allclose(found.of("it")[2], ball.of("it")[2], atol=1e-7)
