"""Springs between bodies keep energy and angular momentum as they turn, and end what is damped.

Those at levers that steps do not resolve give no energy, whatever they lose.

Conservation laws and the closed form of the damped oscillator. All scenes are run in one engine.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from shared_runs import States, ball, config, flow, orders, run_scenes

RATES = (60, 240, 1000)  # steps a second
STIFFNESS, LENGTH = 900.0, 0.5  # [N/m], [m]
FINE = (120, 240, 480, 960)


def spring(a: str, b: str, stiffness: float, length: float, more: str = "") -> str:
    return f"    - {{a: {a}, b: {b}, stiffness: {stiffness!r}, rest_length: {length!r}{more}}}\n"


def joined(bodies: dict[str, str], springs: str, rate: int, duration: float) -> str:
    """Return a config of bodies that nothing but springs moves."""
    text = config(bodies, rate, duration)
    return text.replace("  bodies:\n", f"  springs:\n{springs}  bodies:\n", 1)


def anchor(place: tuple[float, ...] = (0.0, 0.0, 0.0)) -> str:
    shape = "{kind: sphere, radius: 0.001}"
    return f"{{shape: {shape}, fixed: true, surface: one, position: {flow(place)}}}"


def orbit(rate: int, duration: float) -> str:
    """A ball flies round a point that a spring ties it to, and swings as it does."""
    bodies = {"one": anchor(), "ball": ball(0.05, 1.0, (0.6, 0, 0), (0.0, 2.4, 1.8))}
    return joined(bodies, spring("one", "ball", STIFFNESS, LENGTH), rate, duration)


def levers(rate: int) -> str:
    """A chain of two balls that hang by points off their centres, and turn."""
    bodies = {
        "one": anchor(),
        "near": ball(0.1, 1.5, (0.7, 0, 0), (0.0, 1.0, 0.4)),
        "far": ball(0.08, 0.5, (1.3, 0.1, 0), (0.3, 2.0, -0.4)),
    }
    springs = spring("one", "near", 400.0, 0.5, ", point_b: [0.05, 0.06, 0]")
    ends = ", point_a: [0, -0.08, 0.02], point_b: [0.03, 0, 0.06]"
    return joined(bodies, springs + spring("near", "far", 250.0, 0.4, ends), rate, 8.0)


def box_on_lever(rate: int) -> str:
    """A box with three moments of inertia hangs by a corner of it."""
    shape = "{kind: box, size: [0.2, 0.1, 0.3]}"
    bodies = {
        "one": anchor(),
        "box": f"{{shape: {shape}, mass: 2.0, surface: one, position: [0.9, 0, -0.4], "
        "velocity: [0, 1, 0], angular_velocity: [1, 2, 3]}",
    }
    corner = spring("one", "box", 200.0, 0.9, ", point_b: [0.1, 0.05, 0.15]")
    return joined(bodies, corner, rate, 0.5)


def stretched(ratio: float, stiffness: float, rate: int) -> str:
    """Two balls of 1 and 3 kg fly along; their damped spring is 10 mm too long."""
    damping = 2.0 * ratio * math.sqrt(stiffness * 0.75)
    bodies = {
        "one": ball(0.05, 1.0, (3, 4, 5), (1, 2, 0.1)),
        "two": ball(0.05, 3.0, (3, 4, 5.51), (1, 2, 0.1)),
    }
    link = spring("one", "two", stiffness, LENGTH, f", damping: {damping!r}")
    return joined(bodies, link, rate, 1.0)


def whirled() -> str:
    """A small box is tied by a point well outside it: it swings in a hundredth of a step.

    k r^2 dt^2/I = 1e6 0.04^2/(30^2 4e-5) = 4e4, I its moments of inertia, at most.
    """
    shape = "{kind: box, size: [0.004, 0.006, 0.02]}"
    tied = f"{{shape: {shape}, mass: 1.0, surface: one, position: [3.9, 0.3, 0.2]}}"
    link = spring("one", "body", 1e6, 1.0, ", point_b: [0, 0.02, 0.04]")
    return joined({"one": anchor(), "body": tied}, link, 30, 0.4)


def tied_pair(stiffness: float, rate: int, even: bool, damping: float = 0.0) -> str:
    """Two small boxes that turn are tied by points well off their centres, and fly on freely."""
    sizes = (
        ([0.06, 0.06, 0.06], [0.1, 0.1, 0.1]) if even else ([0.02, 0.05, 0.09], [0.1, 0.04, 0.2])
    )
    light, heavy = (f"{{kind: box, size: {size}}}" for size in sizes)
    bodies = {
        "light": f"{{shape: {light}, mass: 0.3, surface: one, position: [0, 0.1, 0], "
        "velocity: [0.2, 1, -0.5], angular_velocity: [1, 2, 3]}",
        "heavy": f"{{shape: {heavy}, mass: 2.0, surface: one, position: [2, 0, 0.3], "
        "velocity: [0, -0.3, 0.4], angular_velocity: [-1, 0.5, 2]}",
    }
    more = f", damping: {damping!r}, point_a: [0.05, 0.08, 0.02], point_b: [-0.1, 0.06, 0.1]"
    return joined(bodies, spring("light", "heavy", stiffness, 1.9, more), rate, 60.0 / rate)


PAIRS = list(itertools.product((1e2, 1e4, 1e6, 1e8), (30, 240, 1000), (True, False), (0.0, 20.0)))

STIFF = [(ratio, k) for ratio in (0.1, 1.0, 5.0) for k in (1e8, 1e12)]


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {f"orbit {rate}": orbit(rate, 20.0) for rate in RATES}
    texts |= {f"levers {rate}": levers(rate) for rate in RATES}
    texts |= {f"box {rate}": box_on_lever(rate) for rate in FINE}
    texts |= {f"stiff {r} {k} {rate}": stretched(r, k, rate) for r, k in STIFF for rate in RATES}
    texts |= {f"damped {rate}": stretched(0.3, 300.0, rate) for rate in FINE}
    texts |= {f"pair {pair}": tied_pair(*pair) for pair in PAIRS}
    texts |= {"whirled": whirled()}
    texts |= {"thousand periods": orbit(240, 2.0 * math.pi / math.sqrt(STIFFNESS) * 1000.0)}
    return run_scenes(texts)


def energy(states: States) -> np.ndarray:
    return states.energy() + states.step["spring_energy"]


@pytest.mark.parametrize("name", [*(f"orbit {rate}" for rate in RATES), "thousand periods"])
def test_spring_that_turns_keeps_energy_and_angular_momentum(
    ran: dict[str, States], name: str
) -> None:
    states = ran[name]
    # Impulses are found to 1e-14 of themselves: of m v = 3 N s at most 3e-14, times 3 m/s, in each
    # of n steps, as round-off adds up.
    bound = 3e-13 * math.sqrt(len(states.time))
    assert abs(energy(states) - energy(states)[0]).max() <= bound
    place, velocity, _ = states.of("ball")
    momentum = np.cross(place, velocity)
    np.testing.assert_allclose(momentum, momentum[:1].repeat(len(momentum), 0), atol=bound)


@pytest.mark.parametrize("rate", RATES)
def test_springs_at_points_off_the_centres_keep_energy(ran: dict[str, States], rate: int) -> None:
    states = ran[f"levers {rate}"]
    assert np.ptp(states.step["spring_energy"]) > 1.0, "they do not swing"
    assert abs(states.spin[-1]).max() > 1.0, "they do not turn"
    np.testing.assert_allclose(energy(states), energy(states)[0], rtol=1e-10)


@pytest.mark.parametrize("rate", FINE)
def test_spring_at_the_corner_of_a_box_keeps_its_energy(ran: dict[str, States], rate: int) -> None:
    """The box has three moments of inertia: its spin turns within the step as well."""
    states = ran[f"box {rate}"]
    assert np.ptp(states.step["spring_energy"]) > 1.0, "it does not swing"
    # Impulses are found to 1e-13 of themselves, in each of some hundred steps.
    np.testing.assert_allclose(energy(states), energy(states)[0], rtol=1e-11)


def test_spring_at_a_lever_that_no_step_resolves_gives_no_energy(ran: dict[str, States]) -> None:
    """What it stores as the box begins at rest is all there is."""
    found = energy(ran["whirled"])
    assert found.max() <= found[0] * (1.0 + 1e-11)


@pytest.mark.parametrize("pair", PAIRS)
def test_tied_pair_gains_no_energy_and_keeps_its_momenta(
    ran: dict[str, States], pair: tuple[float, int, bool, float]
) -> None:
    """From springs that steps resolve, k K dt^2 of 1e-3, to some 1e9; only what is damped loses.

    A turn is resolved where no body turns by more than a radian or so in a step.
    """
    states = ran[f"pair {pair}"]
    found = energy(states)
    # As above; a stiff spring has the round-off of a length of 2 m: k l s 4e-16 of k s^2/2, with
    # a stretch s of 0.02 m and more.
    assert found.max() <= found[0] * (1.0 + 1e-11)
    if pair[3] == 0.0 and abs(states.spin).max() <= 0.5 * pair[1]:
        np.testing.assert_allclose(found, found[0], rtol=1e-11)
    # Round-off of sixty steps, of the largest of the terms that cancel: a body's momentum by 2 m.
    masses = np.array([0.3, 2.0])
    size = float((masses * np.linalg.norm(states.velocity, axis=2)).max()) + 1.0
    for name in ("momentum", "angular_momentum"):
        momenta = np.column_stack([states.step[f"{name}_{axis}"] for axis in "xyz"])
        kept = momenta[:1].repeat(len(momenta), 0)
        np.testing.assert_allclose(momenta, kept, rtol=0.0, atol=1e-12 * size)


def test_spring_at_the_corner_of_a_box_is_of_second_order(ran: dict[str, States]) -> None:
    ends = [ran[f"box {rate}"].of("box")[0][-1] for rate in FINE]
    changes = [float(np.linalg.norm(b - a)) for a, b in itertools.pairwise(ends)]
    assert orders(changes)[-1] == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize(("ratio", "stiffness"), STIFF)
def test_damped_spring_that_no_step_resolves_comes_to_rest(
    ran: dict[str, States], ratio: float, stiffness: float, rate: int
) -> None:
    """A step is 1.8 to 3000 periods long or more; the energy goes in a few steps."""
    states = ran[f"stiff {ratio} {stiffness} {rate}"]
    one, two = states.of("one"), states.of("two")
    stretch = np.linalg.norm(two[0] - one[0], axis=1) - LENGTH
    # What round-off of places of 5 m leaves.
    assert abs(stretch[len(stretch) // 2 :]).max() <= 1e-12
    assert abs(two[1] - one[1])[len(stretch) // 2 :].max() <= 1e-9


def test_damped_spring_is_of_second_order(ran: dict[str, States]) -> None:
    """x = x_0 e^(-z w t) (cos w' t + z w/w' sin w' t), w' = w sqrt(1 - z^2)."""
    w, z = math.sqrt(300.0 / 0.75), 0.3
    turned = w * math.sqrt(1.0 - z * z)
    errors = []
    for rate in FINE:
        states = ran[f"damped {rate}"]
        t = states.time
        truth = np.exp(-z * w * t) * (np.cos(turned * t) + z * w / turned * np.sin(turned * t))
        apart = np.linalg.norm(states.of("two")[0] - states.of("one")[0], axis=1)
        errors.append(float(abs(apart - LENGTH - 0.01 * truth).max()))
    assert orders(errors) == pytest.approx([2.0, 2.0, 2.0], abs=0.15)
