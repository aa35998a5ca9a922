"""A compliance is the spring that it says: c N at rest, its period, and damping where it is given.

Closed forms of an oscillator that rests on its contacts. With omega^2 = 1/(m c) a ball that is let
go where it just touches swings about c m g and never leaves. All scenes are run in one engine.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, ball, config, orders, run_scenes

C, OMEGA = 1e-4, 100.0  # [m/N], [1/s] of 1 kg
HALVED = (240, 480, 960)
FINE = (1000, 2000, 4000)
GAP, SPEED = 0.01037, 1.3  # met within a step [m], [m/s]
# Steps are solved to 1e-9 m/s, which moves a body by no more than that times the timestep; a spring
# undamped keeps what each of up to 960 of them adds.
SOLVED = 1e-9
GRAVITY_OF = f"[0, 0, {-GRAVITY}]"
# Of columns that steps do not resolve, dt^2/(m c) up to 1.7e5; the damping of each.
STIFF, DAMPED = (1e-6, 1e-8, 1e-10), (0.0, 0.2, 1.0)
COLUMN, FASTEST = 6, 4.0  # balls of 1 to 6 kg; what falls 0.05 m onto 21 kg is slower [m/s]
FALL, RADIUS = 0.05, 0.1
DROPS = (0.1, 0.113, 0.121)  # met early and late in a step [m]
SHORT = 1e-6  # of 1 kg at 240 Hz: dt^2/(m c) = 17, unresolved [m/N]
GIVEN_BACK = {  # exp(-2 a cot a), a = acos zeta
    0.0: 1.0,
    0.2: math.exp(-0.4 * math.acos(0.2) / math.sqrt(1.0 - 0.04)),
    1.0: math.exp(-2.0),
    2.0: math.exp(-4.0 * math.acosh(2.0) / math.sqrt(3.0)),
}
FLOOR = "{shape: {kind: plane}}"  # rigid


def spring(body: str, rate: int, duration: float, more: str = "") -> str:
    """Return the config of a body on a floor whose contact has the compliance C."""
    surface = f"compliance: {C}{more}"
    return config({"floor": FLOOR, "ball": body}, rate, duration, surface, GRAVITY_OF)


def scenes() -> dict[str, str]:
    """Return all scenes of this file by name."""
    touching, above = ball(0.1, 1.0, (0, 0, 0.1)), ball(0.1, 1.0, (0, 0, 0.15))
    shape = "{kind: box, size: [0.4, 0.3, 0.2]}"
    box = f"{{shape: {shape}, mass: 1.0, surface: one, position: [0, 0, 0.1]}}"
    column = {"floor": FLOOR} | {
        f"ball{i}": ball(0.1, 1.0, (0, 0, 0.1 + 0.2 * i)) for i in range(3)
    }
    found = {
        "box": spring(box, 240, 1.0, ", damping_ratio: 0.5"),
        "column": config(column, 240, 6.0, f"compliance: {C}, damping_ratio: 0.5", GRAVITY_OF),
    }
    for rate in (60, 240, 1000):
        found[f"rest {rate}"] = spring(touching, rate, 1.0, ", damping_ratio: 0.7")
    for rate in HALVED:
        found[f"swing {rate}"] = spring(touching, rate, 0.25)
        found[f"damped {rate}"] = spring(touching, rate, 0.25, ", damping_ratio: 0.2")
        found[f"bounce {rate}"] = spring(above, rate, 1.0)
    for rate in FINE:
        surface = f"compliance: {C}, damping_ratio: 0.2"
        falls = ball(RADIUS, 1.0, (0, 0, RADIUS + GAP), (0, 0, -SPEED))
        found[f"leaves {rate}"] = config({"floor": FLOOR, "ball": falls}, rate, 0.1, surface)
        found[f"flies {rate}"] = spring(above, rate, 0.16)
    stiff = {"floor": FLOOR} | {
        f"ball{i}": ball(RADIUS, 1.0 + i, (0, 0, RADIUS + 0.001 * (i + 1) + 0.2 * i))
        for i in range(COLUMN)
    }
    for c in STIFF:
        for ratio in DAMPED:
            surface = f"compliance: {c}, damping_ratio: {ratio}"
            found[f"stiff {c} {ratio}"] = config(stiff, 240, 1.0, surface, GRAVITY_OF)
    for ratio in GIVEN_BACK:
        surface = f"compliance: {SHORT}, damping_ratio: {ratio}"
        for drop in DROPS:
            falls = {"floor": FLOOR, "ball": ball(RADIUS, 1.0, (0, 0, RADIUS + drop))}
            found[f"drop {drop} {ratio}"] = config(falls, 240, 0.5, surface, GRAVITY_OF)
    unlike = "compliance: 1e-8, damping_ratio: 0.4"
    found["stack"] = config(stiff, 240, 10.0, unlike, GRAVITY_OF)
    found["bounce, restitution"] = spring(above, 240, 1.0, ", restitution: 0.5")
    return found


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    return run_scenes(scenes())


def heights(states: States, body: str = "ball") -> np.ndarray:
    place, _, _ = states.of(body)
    return place[:, 2]


@pytest.mark.parametrize("rate", [60, 240, 1000])
def test_ball_rests_at_its_load_times_its_compliance(ran: dict[str, States], rate: int) -> None:
    # Damped by exp(-0.7 omega t) at least as far as the rule damps: at 60 Hz, omega dt = 1.7, by
    # (1 - zeta omega dt + ...)/(1 + zeta omega dt + ...) = 0.27 a step.
    depth = 0.1 - heights(ran[f"rest {rate}"])[-1]
    assert depth == pytest.approx(C * GRAVITY, abs=SOLVED)


def test_box_rests_on_four_springs(ran: dict[str, States]) -> None:
    depth = 0.1 - heights(ran["box"])[-1]
    assert depth == pytest.approx(C * GRAVITY / 4.0, abs=SOLVED)


def test_springs_of_two_surfaces_are_in_series(ran: dict[str, States]) -> None:
    tops = [heights(ran["column"], f"ball{i}")[-1] for i in range(3)]
    expected, sunk = [], 0.0
    for i, compliance in enumerate((C, 2.0 * C, 2.0 * C)):
        sunk += compliance * (3 - i) * GRAVITY
        expected.append(0.1 + 0.2 * i - sunk)
    # The slowest mode of the column, some omega/4, is damped by exp(-0.5/16 omega t): 7e-9.
    assert tops == pytest.approx(expected, abs=1e-8)


def test_spring_swings_at_its_period_to_order_2(ran: dict[str, States]) -> None:
    errors = []
    for rate in HALVED:
        states = ran[f"swing {rate}"]
        truth = 0.1 - C * GRAVITY * (1.0 - np.cos(OMEGA * states.time))
        errors.append(float(np.abs(heights(states) - truth).max()))
        # The rule turns the phase by 2 atan(omega dt/2) a step, and loses no amplitude.
        omega = 2.0 * rate * math.atan(OMEGA / (2.0 * rate))
        swung = 0.1 - C * GRAVITY * (1.0 - np.cos(omega * states.time))
        assert np.abs(heights(states) - swung).max() < SOLVED
    # A phase wrong by p = omega^3 dt^2 t/12, 0.36 at 240 Hz: sin p departs from p by p^2/6, 2 %.
    assert orders(errors) == pytest.approx([2.0, 2.0], abs=0.1)


def test_damped_spring_is_of_order_2(ran: dict[str, States]) -> None:
    zeta = 0.2
    damped = OMEGA * math.sqrt(1.0 - zeta**2)
    errors = []
    for rate in HALVED:
        t = ran[f"damped {rate}"].time
        swing = np.cos(damped * t) + zeta * OMEGA / damped * np.sin(damped * t)
        truth = 0.1 - C * GRAVITY * (1.0 - np.exp(-zeta * OMEGA * t) * swing)
        errors.append(float(np.abs(heights(ran[f"damped {rate}"]) - truth).max()))
    # The next term of the error is a share (omega dt)^2 of it: 0.17 at 240 Hz.
    assert orders(errors) == pytest.approx([2.0, 2.0], abs=0.2)


def total_energy(states: States) -> np.ndarray:
    return states.energy() + states.step["contact_energy"]


@pytest.mark.parametrize("rate", HALVED)
def test_spring_keeps_the_energy_while_it_is_pressed(ran: dict[str, States], rate: int) -> None:
    energy = total_energy(ran[f"swing {rate}"])
    assert np.abs(energy - GRAVITY * 0.1).max() < 1e-12


@pytest.mark.parametrize("rate", HALVED)
def test_bounce_on_a_spring_wins_nothing_and_loses_a_step_of_its_way(
    ran: dict[str, States], rate: int
) -> None:
    energy = total_energy(ran[f"bounce {rate}"])
    start = GRAVITY * 0.15
    assert np.all(np.diff(energy) < 1e-12)
    # It begins to push at the surface. In the step in which it leaves it is pushed as if it stayed:
    # what that spring would have stored is lost, at most (v dt)^2/(2 c) in each of two bounces.
    leaving = GRAVITY * 0.05 / (C * rate**2)
    assert start - energy[-1] <= 2.0 * leaving


@pytest.mark.parametrize("rate", HALVED)
def test_bounce_keeps_its_energy_as_it_meets_and_leaves(ran: dict[str, States], rate: int) -> None:
    energy = total_energy(ran[f"bounce {rate}"])
    # Of the law a thousandth of what solves leave, at up to 1 m/s, in each of up to 960 steps.
    assert np.abs(energy - GRAVITY * 0.15).max() < 960 * 1e-3 * SOLVED


def test_bounce_on_a_spring_is_of_order_2(ran: dict[str, States]) -> None:
    """It meets at v = sqrt(2 g h) and swings about c m g, by A from there, until it is back.

    It meets and leaves c m g = A cos(angle) above that middle, at A w sin(angle) = v.
    """
    v = math.sqrt(2.0 * GRAVITY * FALL)
    met, angle = v / GRAVITY, math.atan2(v / OMEGA, C * GRAVITY)
    lasts = 2.0 * (math.pi - angle) / OMEGA
    errors = []
    for rate in FINE:
        states = ran[f"flies {rate}"]
        flown = states.time[-1] - met - lasts
        truth = 0.1 + v * flown - 0.5 * GRAVITY * flown**2
        errors.append(abs(heights(states)[-1] - truth))
    # The phase falls behind by (w dt)^2/12 of its angle, here below pi; then it is late by that. In
    # the two steps in which it meets and leaves the force bends: w^2 v dt^3 each, whatever part.
    for rate, error in zip(FINE, errors, strict=True):
        late = (OMEGA / rate) ** 2 / 12.0 * math.pi / OMEGA
        assert error < v * (late + 2.0 * OMEGA**2 / rate**3)
    assert flown > 0.0


def test_damped_bounce_leaves_with_the_speed_of_its_law_to_order_2(ran: dict[str, States]) -> None:
    """It leaves where F = d/c + k_d d' is 0, of d = v/w_d exp(-zeta w t) sin(w_d t)."""
    zeta = 0.2
    damped = OMEGA * math.sqrt(1.0 - zeta**2)
    # 2 zeta d' = -w d with d'/v = exp(-zeta w t) (cos - zeta w/w_d sin): the tangent of w_d t.
    ratio = OMEGA / damped
    t = math.atan2(2.0 * zeta, 2.0 * zeta**2 * ratio - ratio) / damped
    decay = math.exp(-zeta * OMEGA * t)
    leaving = SPEED * decay * (zeta * ratio * math.sin(damped * t) - math.cos(damped * t))
    for rate in FINE:
        states = ran[f"leaves {rate}"]
        speed = states.of("ball")[1][-1, 2]
        # As it meets the force jumps to 2 zeta m w v: the way of that step is wrong by an eighth
        # of it times dt^2 at most, which the spring gives by w; as it leaves the force's slope does
        # so, 2 m w^2 v dt^2/8; and the phase, of order (w dt)^2/12. Together below (w dt)^2 v/2.
        assert abs(speed - leaving) < 0.5 * (OMEGA / rate) ** 2 * SPEED


@pytest.mark.parametrize("c", STIFF)
@pytest.mark.parametrize("ratio", DAMPED)
def test_no_column_that_steps_do_not_resolve_wins_energy(
    ran: dict[str, States], c: float, ratio: float
) -> None:
    """A step's work on a spring is the change of what it stores; a damper takes some of it.

    By the trapezoidal rule, which pulls where a spring leaves and pushes late where it is met, the
    column of 1e-8 m/N had 150 times its energy after a second.
    """
    states = ran[f"stiff {c} {ratio}"]
    energy = total_energy(states)
    # A row misses its law by a thousandth of SOLVED as a velocity, an impulse of dt^2/(4 c) times
    # that; or the round-off of its speed, 1e-14. Both work along the displacement of a step.
    stiff = 1.0 / (4.0 * c * 240.0**2)
    missed = max(1e-3 * SOLVED, 1e-14 * FASTEST)
    bound = 240 * COLUMN * (stiff + COLUMN) * missed * FASTEST
    assert (energy - energy[0]).max() < bound
    assert states.step["not_converged"].sum() == 0
    if ratio == 0.0:
        assert np.abs(energy - energy[0]).max() < bound


@pytest.mark.parametrize("drop", DROPS)
@pytest.mark.parametrize("ratio", GIVEN_BACK)
def test_bounce_that_steps_do_not_resolve_is_that_of_its_damping(
    ran: dict[str, States], drop: float, ratio: float
) -> None:
    """Whatever the phase of the step: back at e v, e of a spring and a damper that never pull."""
    states = ran[f"drop {drop} {ratio}"]
    speed = math.sqrt(2.0 * GRAVITY * drop)
    met = speed / GRAVITY
    for step in np.flatnonzero(states.time > met)[:3]:
        flown = states.time[step] - met
        if flown < 2.0 * GIVEN_BACK[ratio] * speed / GRAVITY:
            risen = GIVEN_BACK[ratio] * speed * flown - 0.5 * GRAVITY * flown**2
            # An impact is located to 1e-9 s or better: of the speed that is less than 1e-8 m.
            assert heights(states)[step] == pytest.approx(RADIUS + risen, abs=1e-8)


def test_stack_of_stiff_springs_rests_at_load_times_compliance(ran: dict[str, States]) -> None:
    """Balls of 1 to 6 kg, each on two springs in series but for the lowest, on one."""
    states, depth = ran["stack"], 0.0
    for i in range(COLUMN):
        load = GRAVITY * sum(1.0 + j for j in range(i, COLUMN))
        depth += (1.0 if i == 0 else 2.0) * 1e-8 * load
        height = heights(states, f"ball{i}")[-1]
        assert height == pytest.approx(RADIUS * (1 + 2 * i) - depth, abs=SOLVED)
    assert states.step["kinetic_energy"][-1] < COLUMN * 6.0 * (10.0 * SOLVED) ** 2


def test_spring_has_no_impact(ran: dict[str, States]) -> None:
    """Its restitution has no effect."""
    with_restitution = heights(ran["bounce, restitution"])
    assert np.array_equal(with_restitution, heights(ran["bounce 240"]))
