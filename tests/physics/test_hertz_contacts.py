"""Hertz's contact is the law that it says, of order 2: rest, swing, impact, and what damping takes.

    F = k d^(3/2) (1 + a d')
Without gravity, with v the speed of approach and D the deepest indentation, m d'' = -F gives
    m (a v - ln(1 + a v))/a^2 = 2/5 k D^(5/2),         1/2 m v^2 = 2/5 k D^(5/2) for a = 0
    T = 2 integral_0^D dd/d' = (D/v) 4/5 sqrt(pi) Gamma(2/5)/Gamma(9/10)            for a = 0
    a v - ln(1 + a v) = -a u - ln(1 - a u),  u the speed it leaves with, whatever k
the first and the last from m d' dd'/(1 + a d') = -k d^(3/2) dd. All scenes are run in one engine.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, ball, config, orders, run_scenes

K, MASS, SPEED = 1e6, 2.0, 1.5  # [N/m^1.5], [kg], [m/s]
DAMPED = 0.4  # [s/m]
# Steps are solved to 1e-9 m/s, and the law itself to a thousandth of it: each may leave m v times
# that of the energy, of up to 400 steps in a row.
SOLVED = 1e-12
KEPT = 400.0 * MASS * SPEED * SOLVED
RESOLVED = (1000, 2000, 4000)
RESTS = (60, 240, 1000)
# Of columns that no step resolves: k dt^(5/2) sqrt(v)/m is 4e4 and above.
STIFF = (3e10, 3e12)
DEEP = (MASS * GRAVITY / K) ** (2.0 / 3.0)  # at rest [m]
SMALL = 1e-3  # of a swing about it, of DEEP
GRAVITY_OF = f"[0, 0, {-GRAVITY}]"
RIGID = "{shape: {kind: plane}}"
FRICTIONAL = "{shape: {kind: plane}, surface: one}"
FRICTION, SLIP, RADIUS = 0.1, 3.0, 0.1


def hertz(dissipation: float = 0.0, more: str = "", stiffness: float = K) -> str:
    return f"hertz_stiffness: {stiffness}, hunt_crossley_dissipation: {dissipation}{more}"


def scenes() -> dict[str, str]:
    """Return all scenes of this file by name; impacts begin where surfaces touch."""
    fall = ball(RADIUS, MASS, (0, 0, RADIUS), (0, 0, -SPEED))
    slide = ball(RADIUS, MASS, (0, 0, RADIUS), (SLIP, 0, -SPEED))
    two = {"one": ball(RADIUS, MASS, (0, 0, 0), (SPEED, 0.2, 0))} | {
        "other": ball(RADIUS, 3.0 * MASS, (2.0 * RADIUS, 0, 0), (0, 0.2, 0))
    }
    found = {}
    for rate in RESOLVED:
        found[f"impact {rate}"] = config({"floor": RIGID, "ball": fall}, rate, 0.04, hertz())
        found[f"damped {rate}"] = config({"floor": RIGID, "ball": fall}, rate, 0.04, hertz(DAMPED))
        found[f"two {rate}"] = config(two, rate, 0.04, hertz())
        surface = hertz(0.0, f", friction: {FRICTION}")
        found[f"slide {rate}"] = config({"floor": FRICTIONAL, "ball": slide}, rate, 0.04, surface)
    for rate in RESTS:
        touching = ball(RADIUS, MASS, (0, 0, RADIUS))
        found[f"rest {rate}"] = config(
            {"floor": RIGID, "ball": touching}, rate, 2.0, hertz(10.0), GRAVITY_OF
        )
    low = ball(RADIUS, MASS, (0, 0, RADIUS - DEEP * (1.0 + SMALL)))
    found["swing"] = config({"floor": RIGID, "ball": low}, 1000, 0.4, hertz(), GRAVITY_OF)
    for stiffness in STIFF:
        column = {"floor": RIGID} | {
            f"ball{i}": ball(RADIUS, 1.0 + i, (0, 0, RADIUS + 0.21 * i)) for i in range(4)
        }
        found[f"column {stiffness:g}"] = config(
            column, 240, 1.0, hertz(0.0, "", stiffness), GRAVITY_OF
        )
    return found


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    return run_scenes(scenes())


def depths(states: States, body: str = "ball") -> np.ndarray:
    return RADIUS - states.of(body)[0][:, 2]


def total_energy(states: States) -> np.ndarray:
    return states.energy() + states.step["contact_energy"]


def deepest(speed: float, mass: float = MASS, stiffness: float = K, a: float = 0.0) -> float:
    taken = 0.5 * speed**2 if a == 0.0 else (a * speed - math.log1p(a * speed)) / a**2
    return float((2.5 * mass * taken / stiffness) ** 0.4)


def duration(speed: float, mass: float = MASS, stiffness: float = K) -> float:
    swing = 0.8 * math.sqrt(math.pi) * math.gamma(0.4) / math.gamma(0.9)
    return swing * deepest(speed, mass, stiffness) / speed


def leaving(speed: float, a: float) -> float:
    """Return u, by bisection of -a u - ln(1 - a u), which grows with u."""
    asked, low, high = a * speed - math.log1p(a * speed), 0.0, 1.0 / a
    for _ in range(200):
        u = 0.5 * (low + high)
        low, high = (u, high) if -a * u - math.log1p(-a * u) < asked else (low, u)
    return low


@pytest.mark.parametrize("rate", RESTS)
def test_ball_rests_as_deep_as_its_weight_presses(ran: dict[str, States], rate: int) -> None:
    # Damped at least by sqrt((1 + x^2 - y)/(1 + x^2 + y)) a step of 2 x = omega dt, 2 y = a g dt,
    # omega^2 = 3/2 g/d: at 60 Hz by 0.69, 120 times.
    assert depths(ran[f"rest {rate}"])[-1] == pytest.approx(DEEP, rel=1e-10)


def test_small_swing_about_rest_has_the_frequency_of_the_slope(ran: dict[str, States]) -> None:
    """omega^2 = F'(d)/m = 3/2 g/d; the step turns its phase by 2 atan(omega dt/2)."""
    states = ran["swing"]
    z, t = DEEP - depths(states), states.time
    up = np.flatnonzero((z[:-1] < 0.0) & (z[1:] >= 0.0))
    crossed = t[up] + (t[up + 1] - t[up]) * z[up] / (z[up] - z[up + 1])
    measured = 2.0 * math.pi * (len(up) - 1) / (crossed[-1] - crossed[0])
    omega = math.sqrt(1.5 * GRAVITY / DEEP)
    # The swing about a force that bends is slower by a share of SMALL^2, and its middle lies some
    # SMALL/8 of it to one side; chords of a sine cut crossings by (omega dt)^2/8 of that.
    assert len(up) > 5
    assert measured == pytest.approx(2000.0 * math.atan(omega / 2000.0), rel=1e-5)


def test_impact_takes_its_time_to_order_2(ran: dict[str, States]) -> None:
    errors = []
    for rate in RESOLVED:
        states = ran[f"impact {rate}"]
        left = states.of("ball")[1][-1, 2]
        assert left == pytest.approx(SPEED, abs=2.0 * KEPT / (MASS * SPEED))
        flown = -depths(states)[-1] / left  # since the surfaces parted
        errors.append(abs(states.time[-1] - flown - duration(SPEED)))
    # 5 to 20 steps an impact: the next term of the error is a share of (omega dt)^2 of it.
    assert orders(errors) == pytest.approx([2.0, 2.0], abs=0.3)
    assert errors[-1] < 1e-2 * duration(SPEED)


@pytest.mark.parametrize("rate", RESOLVED)
def test_impact_is_as_deep_as_its_energy_allows(ran: dict[str, States], rate: int) -> None:
    """The deepest state of a step lies below D by half its acceleration times (dt/2)^2 at most."""
    depth = depths(ran[f"impact {rate}"]).max()
    most = deepest(SPEED)
    missed = 0.5 * K * most**1.5 / MASS * (0.5 / rate) ** 2
    assert most - missed <= depth <= most * (1.0 + 1e-9)


@pytest.mark.parametrize("rate", RESOLVED)
def test_undamped_impact_keeps_the_energy_in_every_step(ran: dict[str, States], rate: int) -> None:
    """As it meets, presses and leaves; it has no energy to store before the first step."""
    energy = total_energy(ran[f"impact {rate}"])
    assert np.abs(energy - 0.5 * MASS * SPEED**2).max() < KEPT


def test_damping_leaves_the_speed_of_the_law_to_order_2(ran: dict[str, States]) -> None:
    errors = []
    for rate in RESOLVED:
        states = ran[f"damped {rate}"]
        assert np.diff(total_energy(states)).max() < SOLVED
        errors.append(abs(states.of("ball")[1][-1, 2] - leaving(SPEED, DAMPED)))
    assert orders(errors) == pytest.approx([2.0, 2.0], abs=0.3)
    assert errors[-1] < 1e-2 * (SPEED - leaving(SPEED, DAMPED))


def test_damped_impact_is_as_deep_as_the_law(ran: dict[str, States]) -> None:
    most, rate = deepest(SPEED, a=DAMPED), RESOLVED[-1]
    missed = 0.5 * K * most**1.5 / MASS * (0.5 / rate) ** 2
    # d' is wrong by as much as the speed that it leaves with, of order 2: below 1e-3 of it.
    assert most * (1.0 - 1e-3) - missed <= depths(ran[f"damped {rate}"]).max() <= most * 1.001


def test_two_balls_keep_momentum_and_meet_one_behind_the_other(ran: dict[str, States]) -> None:
    """Of equal surfaces k is that of one by 2^(3/2); the mass is m_1 m_2/(m_1 + m_2)."""
    errors = []
    for rate in RESOLVED:
        states = ran[f"two {rate}"]
        (at, v, _), (by, w, _) = states.of("one"), states.of("other")
        momentum = MASS * v + 3.0 * MASS * w
        assert np.abs(momentum - momentum[0]).max() < 1e-14 * MASS * SPEED * len(v)
        assert np.abs(total_energy(states) - total_energy(states)[0]).max() < KEPT
        parted = w[-1, 0] - v[-1, 0]
        flown = (by[-1, 0] - at[-1, 0] - 2.0 * RADIUS) / parted
        lasted = duration(SPEED, 0.75 * MASS, K / 2.0**1.5)
        errors.append(abs(states.time[-1] - flown - lasted))
    assert orders(errors) == pytest.approx([2.0, 2.0], abs=0.3)


@pytest.mark.parametrize("rate", RESOLVED)
def test_friction_of_an_impact_is_coulombs_with_the_force_of_the_spring(
    ran: dict[str, States], rate: int
) -> None:
    """It slides throughout: its slip changes by mu times the change of speed, its spin with it."""
    states = ran[f"slide {rate}"]
    _, velocity, spin = states.of("ball")
    contact = states.contact
    along = np.hypot(contact["impulse_t1"], contact["impulse_t2"])
    pressed = contact["impulse_n"]
    assert np.all(along <= FRICTION * pressed * (1.0 + 1e-12) + 1e-15)
    gained = velocity[-1, 2] + SPEED
    # Each of some 20 steps is solved to SOLVED m/s along the normal, and 1e-9 along the floor.
    assert velocity[-1, 0] == pytest.approx(SLIP - FRICTION * gained, abs=2e-8)
    assert spin[-1, 1] == pytest.approx(2.5 * FRICTION * gained / RADIUS, abs=2.5 * 2e-8 / RADIUS)


@pytest.mark.parametrize("stiffness", STIFF)
def test_no_column_that_steps_do_not_resolve_wins_energy(
    ran: dict[str, States], stiffness: float
) -> None:
    """Impacts within a step hit what has not moved yet, which then meets others."""
    energy = total_energy(ran[f"column {stiffness:g}"])
    # 10 kg at up to 4 m/s, solved to 1e-9 m/s in each of 240 steps.
    assert np.abs(energy - energy[0]).max() < 240 * 10.0 * 4.0 * 1e-9
