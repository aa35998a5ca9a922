"""Springs on what joints hold: a pendulum by its equation of motion; momentum, energy, and work.

A rod of length L hangs from a hinge; a spring pulls its lower end from a post at a distance:
    I q'' = -m g L/2 sin q + r x F,   F = k (l - l_0),   w^2 = (m g L/2 + k L^2)/I of small angles
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from shared_runs import GRAVITY, States, orders, run_scenes

LENGTH, WIDTH, MASS, STIFFNESS, POST = 0.5, 0.02, 1.0, 50.0, 2.0  # [m], [kg], [N/m], [m]
INERTIA = MASS * ((LENGTH**2 + WIDTH**2) / 12.0 + LENGTH**2 / 4.0)  # about the hinge [kg m^2]
ANGLE, RATES, DURATION = 0.1, (120, 240, 480), 2.0  # [rad], steps a second, [s]
SMALL = 1e-3  # [rad]
SPEED, MOST = 3.0, 5.0  # of the motor [rad/s], [N m]
STIFF = 1e6  # w dt = 7 at 1/240 s: no step resolves it [N/m]
SPRING = "{a: rod, b: post, point_a: [0, 0, -0.25], stiffness: STIFFNESS, rest_length: 2.0}"


def pendulum(rate: int, angle: float, stiffness: float = STIFFNESS) -> str:
    x, z = -0.5 * LENGTH * math.sin(angle), -0.5 * LENGTH * math.cos(angle)
    return f"""
scene:
  bodies:
    ceiling: {{shape: {{kind: sphere, radius: 0.01}}, fixed: true, position: [0, 0, 0]}}
    post: {{shape: {{kind: sphere, radius: 0.01}}, fixed: true, position: [{POST}, 0, -{LENGTH}]}}
    rod:
      shape: {{kind: box, size: [{WIDTH}, {WIDTH}, {LENGTH}]}}
      mass: {MASS}
      position: [{x!r}, 0, {z!r}]
      orientation: [{math.cos(0.5 * angle)!r}, 0, {math.sin(0.5 * angle)!r}, 0]
  connections:
    hinge: {{kind: hinge, between: [ceiling, rod], at: [0, 0, 0], axis: [0, 1, 0]}}
  springs: [{SPRING.replace("STIFFNESS", repr(stiffness))}]
numerics: {{timestep: 1/{rate}}}
duration: {DURATION}
"""


def flying(stiffness: float) -> str:
    """Return two balls on a ball joint, a third on a spring to the second; nothing else acts."""
    return f"""
scene:
  gravity: 0
  bodies:
    one: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, position: [0, 0, 0], velocity: [0, 1, 0]}}
    two: {{shape: {{kind: sphere, radius: 0.1}}, mass: 2, position: [0.5, 0, 0]}}
    three:
      shape: {{kind: sphere, radius: 0.1}}
      mass: 3
      position: [1, 0.2, 0]
      velocity: [0, 0, 0.5]
  connections:
    joint: {{kind: ball, between: [one, two], at: [0.25, 0, 0]}}
  springs:
    - {{a: two, b: three, point_a: [0.1, 0, 0], stiffness: {stiffness!r}, rest_length: 0.4}}
numerics: {{timestep: 1/240}}
duration: {DURATION}
"""


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    scenes = {f"at {rate}": pendulum(rate, ANGLE) for rate in RATES}
    scenes |= {"small": pendulum(RATES[-1], SMALL), "stiff": pendulum(240, ANGLE, STIFF)}
    motor = f"axis: [0, 1, 0], motor: {{speed: {SPEED}, max_torque: {MOST}}}}}"
    scenes["driven"] = scenes[f"at {RATES[1]}"].replace("axis: [0, 1, 0]}", motor)
    return run_scenes(scenes | {"flying": flying(STIFFNESS), "flying stiff": flying(STIFF)})


def angle(states: States) -> np.ndarray:
    turn = states.turn[:, states.names.index("rod")]
    return 2.0 * np.arctan2(turn[:, 2], turn[:, 0])


def swung(times: np.ndarray) -> np.ndarray:
    """Return the angle by time, from rest."""

    def rates(_: float, state: np.ndarray) -> list[float]:
        q, w = state
        x, z = -LENGTH * math.sin(q), -LENGTH * math.cos(q)
        length = math.hypot(POST - x, -LENGTH - z)
        pull = STIFFNESS * (length - 2.0) / length
        torque = z * pull * (POST - x) - x * pull * (-LENGTH - z)
        return [w, (torque - 0.5 * MASS * GRAVITY * LENGTH * math.sin(q)) / INERTIA]

    span = (0.0, float(times[-1]))
    return solve_ivp(rates, span, [ANGLE, 0.0], "DOP853", times, rtol=1e-11, atol=1e-12).y[0]


def energy(states: States) -> np.ndarray:
    return states.energy() + states.step["spring_energy"]


def test_a_rod_on_a_hinge_and_a_spring_swings_by_its_equation_to_order_2(
    ran: dict[str, States],
) -> None:
    errors, changes = [], []
    for rate in RATES:
        states = ran[f"at {rate}"]
        errors.append(float(abs(angle(states) - swung(states.time)).max()))
        changes.append(float(abs(energy(states) - energy(states)[0]).max()))
        assert states.step["spring_not_converged"].sum() == 0
    # A series in (w dt)^2, (13.3/120)^2 = 0.012: ten times its share in the next term changes a
    # ratio by 1.12/1.03: log2 of it is 0.12.
    assert orders(errors) == pytest.approx([2.0, 2.0], abs=0.12)
    # Springs give back what they take, and joints do no work: what is left is of levers that turn
    # in a step, of at least the order of the motion, and less than its share of what swings.
    swing = 0.5 * (0.5 * MASS * GRAVITY * LENGTH + STIFFNESS * LENGTH**2) * ANGLE**2
    assert min(orders(changes)) >= 1.9
    assert changes[-1] < (13.3 / RATES[-1]) ** 2 / 12.0 * swing


def test_small_swings_have_the_frequency_of_gravity_and_spring(ran: dict[str, States]) -> None:
    states = ran["small"]
    w = math.sqrt((0.5 * MASS * GRAVITY * LENGTH + STIFFNESS * LENGTH**2) / INERTIA)
    # Late by (w dt)^2/12 = 6e-5 of w t = 13; and the first step, in which it is released, by w dt/2
    # of itself. Solves leave 1e-9 m/s.
    late = (w / RATES[-1]) ** 2 / 12.0 * w * DURATION + (w / RATES[-1]) ** 2
    law = SMALL * np.cos(w * states.time)
    np.testing.assert_allclose(angle(states), law, atol=2.0 * SMALL * late)


def test_the_hinge_holds(ran: dict[str, States]) -> None:
    for rate in RATES:
        states = ran[f"at {rate}"]
        place, turned = states.of("rod")[0], angle(states)
        end = place + 0.5 * LENGTH * np.stack([np.sin(turned), 0.0 * turned, np.cos(turned)], 1)
        # Solves leave 1e-9 m/s in a step, and projection takes a fifth of what is torn.
        assert abs(end).max() < 5e-9 / rate * 10.0


def test_momentum_of_what_flies_stays(ran: dict[str, States]) -> None:
    for name in ("flying", "flying stiff"):
        states = ran[name]
        momentum = np.zeros(3)
        for body, mass in (("one", 1.0), ("two", 2.0), ("three", 3.0)):
            momentum = momentum + mass * states.of(body)[1]
        # Impulses act on both ends: round-off of 240 steps.
        np.testing.assert_allclose(momentum, np.tile(momentum[0], (len(momentum), 1)), atol=1e-12)


def test_energy_of_what_flies_stays(ran: dict[str, States]) -> None:
    states = ran["flying"]
    assert states.step["spring_not_converged"].sum() == 0
    change = abs(energy(states) - energy(states)[0]).max()
    # Solves leave 1e-9 m/s of momenta of up to 3 kg m/s, in each of 240 steps: 7e-7 J if all of it
    # went one way; and the rule's own, of the spring's lever, w dt = 0.04: (w dt)^2/12 of 1e-2.
    assert change < 1e-5


def test_a_spring_that_no_step_resolves_gives_no_energy(ran: dict[str, States]) -> None:
    """Steps that are not found are placed and lose energy; projection closes the torn hinge."""
    for name in ("stiff", "flying stiff"):
        states = ran[name]
        course = energy(states)
        assert states.step["spring_not_converged"].sum() > 0
        # As `always` bounds every step: 1e-6 of what there is, here as it begins.
        assert np.diff(course).max() <= 1e-6 * course[0]
        assert course[-1] < 0.5 * course[0]


def test_a_motor_pays_for_what_the_spring_stores(ran: dict[str, States]) -> None:
    """What motion, gravity and spring have more is its work."""
    states = ran["driven"]
    course, work = energy(states), states.step["motor_work"]
    # Of the levers' order, (w dt)^2/12 of what there is of it at 1/240 s, 5 N m * 0.5 rad.
    gained = course[1:] - course[0]
    paid = np.cumsum(work)[-len(gained) :]
    assert paid.max() > 0.1
    np.testing.assert_allclose(gained, paid, atol=(13.3 / RATES[1]) ** 2 / 12.0 * 2.5)
