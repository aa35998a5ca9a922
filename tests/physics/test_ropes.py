"""Ropes against closed forms, conservation laws and the equations of motion of scipy.

What a rope ties at its centre keeps energy, momentum and angular momentum as it turns; a rope that
becomes taut takes mu v_n (1 + e) along its line and nothing else. All small scenes share an engine.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk
from shared_runs import GRAVITY, States, ball, config, flow, orders, run_scenes

RATES = (60, 120, 240, 480)  # steps a second
LENGTHS, MASSES, ANGLES = (0.7, 0.5), (1.3, 0.8), (0.6, -0.4)  # of the double pendulum
FIRST, VELOCITY = np.array([0.3, 0.1, 0.0]), np.array([1.5, 0.8, 0.4])  # of what flies off
KINDS = ("pair", "taut 0.0", "taut 0.5")
REDUCED = 0.75  # [kg], of 1 and 3 kg


def hook() -> str:
    shape = "{kind: sphere, radius: 0.001}"
    return f"{{shape: {shape}, fixed: true, surface: one, position: [0, 0, 0]}}"


def tied(
    bodies: dict[str, str], ropes: list[str], rate: int, duration: float, gravity: float = GRAVITY
) -> str:
    """Return a config of bodies and ropes; a rope by what stands behind its kind."""
    text = config(bodies, rate, duration, "restitution: 0", repr(gravity))
    lines = "".join(f"    rope_{k}: {{kind: rope, {one}}}\n" for k, one in enumerate(ropes))
    return text.replace("  bodies:\n", f"  connections:\n{lines}  bodies:\n", 1)


def pendulum(rate: int, angle: float, duration: float) -> str:
    place = (math.sin(angle), 0.0, -math.cos(angle))
    return tied(
        {"hook": hook(), "bob": ball(0.05, 1.0, place)}, ["between: [hook, bob]"], rate, duration
    )


def conical(rate: int) -> str:
    height, rate_of_turn = math.cos(0.5), math.sqrt(GRAVITY / math.cos(0.5))
    radius = math.sin(0.5)
    bob = ball(0.05, 0.7, (radius, 0, -height), (0, rate_of_turn * radius, 0))
    return tied({"hook": hook(), "bob": bob}, ["between: [bob, hook]"], rate, 5.0)


def double(rate: int) -> str:
    (one, other), (first, second) = LENGTHS, ANGLES
    upper = np.array([one * math.sin(first), 0.0, -one * math.cos(first)])
    lower = upper + np.array([other * math.sin(second), 0.0, -other * math.cos(second)])
    bodies = {
        "hook": hook(),
        "upper": ball(0.05, MASSES[0], upper),
        "lower": ball(0.04, MASSES[1], lower),
    }
    return tied(bodies, ["between: [hook, upper]", "between: [lower, upper]"], rate, 3.0)


def free_pair(rate: int) -> str:
    bodies = {
        "heavy": ball(0.1, 3.0, (0, 0, 0), (0.1, 0, 0)),
        "light": ball(0.05, 1.0, (1, 0, 0), (0.1, 2.0, 0.4)),
    }
    return tied(bodies, ["between: [heavy, light]"], rate, 5.0, 0.0)


def flying_off(rate: int, restitution: float) -> str:
    bodies = {
        "heavy": ball(0.1, 3.0, (0, 0, 0)),
        "light": ball(0.05, 1.0, FIRST, tuple(VELOCITY)),
    }
    rope = f"between: [heavy, light], length: 1.0, restitution: {restitution!r}"
    return tied(bodies, [rope], rate, 1.0, 0.0)


def hung_box(rate: int) -> str:
    """A box of three moments of inertia swings on a rope at its corner."""
    corner = np.array([0.1, 0.05, 0.15])
    place = np.array([0.5 * math.sin(0.5), 0.0, -0.5 * math.cos(0.5)]) - corner
    shape = "{kind: box, size: [0.2, 0.1, 0.3]}"
    box = f"{{shape: {shape}, mass: 2.0, surface: one, position: {flow(place)}}}"
    rope = f"between: [hook, box], points: [[0, 0, 0], {flow(corner)}]"
    return tied({"hook": hook(), "box": box}, [rope], rate, 0.5)


def free_box(rate: int, height: float) -> str:
    """A ball and a box go round each other, tied at its corner; the box turns as well."""
    shape = f"{{kind: box, size: [0.2, 0.2, {height!r}]}}"
    bodies = {
        "box": f"{{shape: {shape}, mass: 2.0, surface: one, position: [0, 0, 0], "
        "velocity: [0, -1, 0]}",
        "light": ball(0.05, 0.5, (1, 0, 0), (0, 2.0, 0.5)),
    }
    return tied(
        bodies, ["between: [box, light], points: [[0.1, 0.05, 0.1], [0, 0, 0]]"], rate, 2.0, 0.0
    )


def chain(links: int, load: float) -> str:
    bodies, ropes, last = {"hook": hook()}, [], "hook"
    for k in range(links):
        bodies[f"link_{k}"] = ball(0.02, load if k == links - 1 else 1.0, (0, 0, -0.1 * (k + 1)))
        ropes.append(f"between: [{last}, link_{k}]")
        last = f"link_{k}"
    return tied(bodies, ropes, 240, 0.1)


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {
        f"pendulum {angle} {rate}": pendulum(rate, angle, 10.0)
        for angle in (0.5, 1.5)
        for rate in RATES
    }
    texts |= {f"conical {rate}": conical(rate) for rate in RATES}
    texts |= {f"double {rate}": double(rate) for rate in RATES}
    texts |= {f"pair {rate}": free_pair(rate) for rate in RATES}
    texts |= {f"taut {e} {rate}": flying_off(rate, e) for e in (0.0, 0.5) for rate in RATES}
    texts |= {f"hung {rate}": hung_box(rate) for rate in RATES}
    texts |= {f"cube {rate}": free_box(rate, 0.2) for rate in RATES}
    texts |= {f"box {rate}": free_box(rate, 0.3) for rate in RATES}
    texts |= {"chain": chain(10, 1.0)}
    return run_scenes(texts)


def momenta(states: States, name: str) -> np.ndarray:
    return np.column_stack([states.step[f"{name}_{axis}"] for axis in "xyz"])


@pytest.mark.parametrize(("angle", "rate"), [*itertools.product((0.5, 1.5), RATES)])
def test_pendulum_keeps_its_energy_and_length(
    ran: dict[str, States], angle: float, rate: int
) -> None:
    states = ran[f"pendulum {angle} {rate}"]
    # The first step begins at rest: its middle is its start, from which the bob falls by g dt^2/2
    # along the tangent, (g dt^2/2)^2/2 beyond the circle. Passes to the middle leave 1e-9 m/s.
    fallen = (0.5 * GRAVITY / rate**2) ** 2 / 2.0
    length = np.linalg.norm(states.of("bob")[0], axis=1)
    assert abs(length - 1.0).max() <= 1.1 * fallen + 1e-9
    # That lifts it by as much at most, and n steps of round-off of some 10 J.
    found = states.energy()
    assert abs(found - found[0]).max() <= 2.0 * GRAVITY * fallen + 1e-15 * 10.0 * len(found)


@pytest.mark.parametrize("angle", [0.5, 1.5])
def test_pendulum_has_the_period_of_its_amplitude(ran: dict[str, States], angle: float) -> None:
    """T = 4 sqrt(l/g) K(sin^2(a/2)), of order 2 in the timestep."""
    period, errors = 4.0 * math.sqrt(1.0 / GRAVITY) * ellipk(math.sin(0.5 * angle) ** 2), []
    for rate in RATES:
        states = ran[f"pendulum {angle} {rate}"]
        x = states.of("bob")[0][:, 0]
        down = np.flatnonzero((x[:-1] > 0.0) & (x[1:] <= 0.0))
        crossed = states.time[down] + x[down] / (x[down] - x[down + 1]) / rate
        errors.append(abs((crossed[-1] - crossed[0]) / (len(crossed) - 1) - period))
    # Half of (w dt)^2 at most of the period; crossings are linear between steps.
    assert all(
        error <= 0.5 * GRAVITY / rate**2 * period for error, rate in zip(errors, RATES, strict=True)
    )
    assert np.mean(orders(errors)) == pytest.approx(2.0, abs=0.3)


def test_conical_pendulum_goes_round_by_its_height_and_pulls_by_its_line(
    ran: dict[str, States],
) -> None:
    rate_of_turn = math.sqrt(GRAVITY / math.cos(0.5))
    for rate in RATES:
        states = ran[f"conical {rate}"]
        x = states.of("bob")[0]
        turned = np.unwrap(np.arctan2(x[:, 1], x[:, 0]))[-1]
        share = (rate_of_turn / rate) ** 2  # (w dt)^2
        assert turned == pytest.approx(rate_of_turn * 5.0, rel=share / 4.0)
        assert np.ptp(x[:, 2]) <= 1e-11
        pulls = states.contact["force_n"]
        np.testing.assert_allclose(pulls, 0.7 * GRAVITY / math.cos(0.5), rtol=share / 4.0)


def test_double_pendulum_moves_as_its_equations_say(ran: dict[str, States]) -> None:
    (one, other), (m, n) = LENGTHS, MASSES

    def rates(_: float, y: np.ndarray) -> list[float]:
        a, b, w, u = y
        between = a - b
        matrix = [
            [(m + n) * one, n * other * math.cos(between)],
            [one * math.cos(between), other],
        ]
        forces = [
            -(m + n) * GRAVITY * math.sin(a) - n * other * u * u * math.sin(between),
            -GRAVITY * math.sin(b) + one * w * w * math.sin(between),
        ]
        return [w, u, *np.linalg.solve(matrix, forces)]

    a, b = solve_ivp(rates, (0.0, 3.0), [*ANGLES, 0.0, 0.0], rtol=1e-11, atol=1e-12).y[:2, -1]
    truth = (one * math.sin(a) + other * math.sin(b), 0.0, -one * math.cos(a) - other * math.cos(b))
    errors = [
        float(np.linalg.norm(ran[f"double {rate}"].of("lower")[0][-1] - truth)) for rate in RATES
    ]
    assert errors[-1] <= 1e-4
    assert orders(errors) == pytest.approx([2.0] * 3, abs=0.1)


@pytest.mark.parametrize(("kind", "rate"), [*itertools.product(KINDS, RATES)])
def test_what_ropes_tie_in_free_flight_keeps_its_momenta(
    ran: dict[str, States], kind: str, rate: int
) -> None:
    states = ran[f"{kind} {rate}"]
    for name in ("momentum", "angular_momentum"):
        found = momenta(states, name)
        # A dozen roundings of some 3 kg m/s and kg m^2/s in a step.
        np.testing.assert_allclose(found, found[:1].repeat(len(found), 0), atol=1e-14 * len(found))


@pytest.mark.parametrize("rate", RATES)
def test_pair_that_goes_round_keeps_its_energy_and_distance(
    ran: dict[str, States], rate: int
) -> None:
    states = ran[f"pair {rate}"]
    found = states.energy()
    np.testing.assert_allclose(found, found[0], rtol=1e-15 * len(found))
    apart = np.linalg.norm(states.of("light")[0] - states.of("heavy")[0], axis=1)
    np.testing.assert_allclose(apart, 1.0, atol=1e-15 * len(apart))


@pytest.mark.parametrize(("restitution", "rate"), [*itertools.product((0.0, 0.5), RATES)])
def test_rope_becomes_taut_within_a_step_by_an_impact_along_it(
    ran: dict[str, States], restitution: float, rate: int
) -> None:
    """At |p + v t| = L: impulse mu v_n (1 + e), energy taken mu v_n^2 (1 - e^2)/2."""
    along, squared = FIRST @ VELOCITY, VELOCITY @ VELOCITY
    when = (-along + math.sqrt(along**2 - squared * (FIRST @ FIRST - 1.0))) / squared
    speed = float((FIRST + when * VELOCITY) @ VELOCITY)
    states = ran[f"taut {restitution} {rate}"]
    found = states.energy()
    taken = 0.5 * REDUCED * speed * speed * (1.0 - restitution**2)
    assert found[0] - found[-1] == pytest.approx(taken, abs=1e-13)
    first = states.contact[states.contact["impulse_n"] > 0.0][0]
    assert first["impulse_n"] == pytest.approx(REDUCED * speed * (1.0 + restitution), rel=1e-12)
    assert first["rope"] == 1
    assert first["step"] == math.ceil(when * rate)
    apart = np.linalg.norm(states.of("light")[0] - states.of("heavy")[0], axis=1)
    assert apart.max() <= 1.0 + 1e-12


def test_box_on_a_rope_at_its_corner_is_of_second_order(ran: dict[str, States]) -> None:
    ends = [ran[f"hung {rate}"].of("box")[0][-1] for rate in RATES]
    changes = [float(np.linalg.norm(b - a)) for a, b in itertools.pairwise(ends)]
    assert orders(changes)[-1] == pytest.approx(2.0, abs=0.25)


@pytest.mark.parametrize("kind", ["cube", "box"])
def test_free_box_keeps_its_momentum_and_to_second_order_its_angular_momentum(
    ran: dict[str, States], kind: str
) -> None:
    """The length of what is tied at a corner is projected back; a box turns as it is pushed."""
    changes = []
    for rate in RATES:
        found = momenta(ran[f"{kind} {rate}"], "momentum")
        np.testing.assert_allclose(found, found[:1].repeat(len(found), 0), atol=1e-14 * len(found))
        changes.append(float(np.ptp(momenta(ran[f"{kind} {rate}"], "angular_momentum"), 0).max()))
    assert changes[-1] <= 1e-4
    assert min(orders(changes)) >= 1.8


def test_what_hangs_off_its_centre_keeps_its_energy_to_second_order(ran: dict[str, States]) -> None:
    """Its point turns with it: the length drifts by (w dt)^3/24 a step, and is projected back."""
    changes = [float(np.ptp(ran[f"hung {rate}"].energy())) for rate in RATES]
    assert changes[-1] <= 1e-4
    assert orders(changes)[-1] >= 1.7


def test_chain_at_rest_has_the_tensions_of_the_weights_below(ran: dict[str, States]) -> None:
    rows = ran["chain"].contact
    last = np.sort(rows[rows["step"] == rows["step"].max()], order="rope")
    np.testing.assert_allclose(last["force_n"], GRAVITY * np.arange(10, 0, -1), rtol=1e-9)


def test_chain_of_a_hundred_carries_a_thousand_times_a_link() -> None:
    """More bodies move than take part in the least norm: a plan of its own."""
    states = run_scenes({"chain": chain(100, 1000.0)})["chain"]
    assert states.step["not_converged"].sum() == 0
    rows = states.contact
    last = np.sort(rows[rows["step"] == rows["step"].max()], order="rope")
    below = np.append(np.arange(99, 0, -1) + 1000.0, 1000.0)
    # A residual of 1e-9 m/s of a step's g/240.
    np.testing.assert_allclose(last["force_n"], GRAVITY * below, rtol=1e-9 * 240.0 / GRAVITY)
