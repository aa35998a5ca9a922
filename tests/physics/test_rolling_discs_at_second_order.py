"""Discs that roll on their rims: errors of place and energy are of second order in the timestep.

A wheel that leans rolls in a circle, steadily and in closed form; a disc that starts faster than
steady nods, and its energy is kept. With `integrator: midpoint`, whose contacts are those of the
beginning of a step, both errors are of first order.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
from shared_runs import GRAVITY, States, config, flow, orders, run_scenes

UP = np.array([0.0, 0.0, 1.0])
ROLLING, NODDING = (120, 240, 480), (480, 960, 1920)  # steps a second
SOLVED = 1e-9  # [m/s], the default tolerance of a step


class Rolling(NamedTuple):
    """A cylinder of 1 kg on the rim of its lower face, at the start: it moves along -y."""

    radius: float  # [m]
    length: float  # [m]
    axis: np.ndarray  # of the cylinder
    arm: np.ndarray  # from its centre to the contact [m]
    spin: np.ndarray  # of steady rolling [rad/s]
    precession: float  # the rate of its axis about the vertical [rad/s]

    def text(self, rate: int, duration: float, faster: float, integrator: str) -> str:
        """Return a config; faster: than steady rolling."""
        lean, spin = math.acos(self.axis[2]), faster * self.spin
        rolling = (
            f"{{shape: {{kind: cylinder, radius: {self.radius}, length: {self.length}}}, "
            f"mass: 1.0, surface: one, position: {flow(-self.arm * UP)}, "
            f"orientation: {flow((math.cos(lean / 2.0), 0, math.sin(lean / 2.0), 0))}, "
            f"velocity: {flow(-np.cross(spin, self.arm))}, angular_velocity: {flow(spin)}}}"
        )
        bodies = {"floor": "{shape: {kind: plane}, surface: one}", "disc": rolling}
        text = config(bodies, rate, duration, surface="friction: 1", gravity=repr(GRAVITY))
        return text.replace("timestep:", f"integrator: {integrator}, timestep:")


def steady(radius: float, length: float, degrees: float, ratio: float) -> Rolling:
    """Return what rolls steadily, its axis e at some degrees from the vertical z.

    omega = W (z + ratio e), v = -omega x p, and all turn about z with W. About the centre
    W z x L = p x (W z x v + g z) [m = 1], across e: W^2 by what W = 1 gives.
    """
    angle = math.radians(degrees)
    axis = np.array([math.sin(angle), 0.0, math.cos(angle)])
    arm = -radius * np.array([-axis[2], 0, axis[0]]) - length / 2.0 * axis
    across = np.cross(UP, axis)
    about, along = (3.0 * radius**2 + length**2) / 12.0, radius**2 / 2.0
    unit = UP + ratio * axis
    momentum = about * unit + (along - about) * (unit @ axis) * axis
    inertial = np.cross(UP, momentum) - np.cross(arm, np.cross(UP, -np.cross(unit, arm)))
    squared = GRAVITY * (np.cross(arm, UP) @ across) / (inertial @ across)
    rate = math.sqrt(squared)
    return Rolling(radius, length, axis, arm, rate * unit, rate)


# A wheel leans by 15 degrees; a disc by 60, whose centre would be at rest.
WHEEL = steady(0.1, 0.02, 75.0, -20.0)
DISC = steady(0.05, 0.005, 30.0, -(math.cos(math.radians(30)) - 0.05 * math.sin(math.radians(30))))


def scenes(integrator: str) -> dict[str, str]:
    found = {f"wheel {rate}": WHEEL.text(rate, 1.0, 1.0, integrator) for rate in ROLLING}
    for rate in (*NODDING, 1000):
        found[f"disc {rate}"] = DISC.text(rate, 0.5, 1.1, integrator)
    return found


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    return run_scenes(scenes("midpoint_contact"))


@pytest.fixture(scope="module")
def ran_on_the_start() -> dict[str, States]:
    return run_scenes(scenes("midpoint"))


def place_errors(ran: dict[str, States]) -> list[float]:
    """Return the largest distance of the wheel's centre from where it should be on its circle."""
    errors = []
    for rate in ROLLING:
        states = ran[f"wheel {rate}"]
        place, velocity, _ = states.of("disc")
        turned = WHEEL.precession * states.time[:, None]
        forward, aside = velocity[0], np.cross(UP, velocity[0])
        way = np.sin(turned) * forward + (1.0 - np.cos(turned)) * aside
        errors.append(float(abs(place - place[0] - way / WHEEL.precession).max()))
    return errors


def energy_error(states: States) -> float:
    """Return the largest change of the energy, over that of the start without the height."""
    energy = states.energy()
    return float(abs(energy / energy[0] - 1.0).max())


def test_the_wheel_needs_less_friction_than_it_has() -> None:
    """Else the closed form would not be that of the scene: a = W^2 times the circle's radius."""
    speed = np.linalg.norm(np.cross(WHEEL.spin, WHEEL.arm))
    assert 0.1 < speed * WHEEL.precession / GRAVITY < 0.5


def test_wheel_rolls_in_its_circle_to_order_2(ran: dict[str, States]) -> None:
    errors = place_errors(ran)
    # The scheme is symmetric in time, its error a series in (omega dt)^2; at 1/120 that is
    # (20/120)^2 = 0.03, and a next term of up to four times its share changes a ratio by 9 %:
    # log2(1.09) = 0.12. Rests, over a second, are less than 1 % of the finest error.
    assert orders(errors) == pytest.approx([2.0, 2.0], abs=0.12)
    assert 0.01 * errors[-1] > SOLVED


def test_wheel_on_contacts_of_the_start_is_of_order_1(ran_on_the_start: dict[str, States]) -> None:
    # Not symmetric: a series in omega dt, whose next term is up to 20/120 of the first one.
    found = orders(place_errors(ran_on_the_start))
    assert found == pytest.approx([1.0, 1.0], abs=0.25)


def test_disc_that_nods_keeps_its_energy_to_order_2(ran: dict[str, States]) -> None:
    errors = [energy_error(ran[f"disc {rate}"]) for rate in NODDING]
    # At least: contacts that hold on the mean of a step's velocities work by nothing but what is
    # left out of the mean, itself of second order and nearly alternating. The next order has a
    # share of omega dt, 40/480 = 0.08; twice that changes a ratio by 8 %, log2(1.08) = 0.11.
    assert min(orders(errors)) >= 2.0 - 0.11
    assert energy_error(ran["disc 1000"]) <= 0.01


def test_disc_on_contacts_of_the_start_loses_energy_to_order_1(
    ran_on_the_start: dict[str, States],
) -> None:
    errors = [energy_error(ran_on_the_start[f"disc {rate}"]) for rate in NODDING]
    assert orders(errors) == pytest.approx([1.0, 1.0], abs=0.25)
    assert energy_error(ran_on_the_start["disc 1000"]) > 0.01
