"""Frictionless bodies that turn meet where their surfaces do, and a flush seam is no impact.

Conservation laws and closed forms. All scenes are run in one engine.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, ball, config, flow, plane, run_scenes

RATES = (60, 240, 1000)  # steps a second
BOX_SIZE, BOX_MASS, BALL_RADIUS, BALL_MASS = (0.3, 0.2, 0.12), 1.5, 0.08, 0.7
FREE_SIZE, WALL = (0.2, 0.3, 0.4), 0.4  # [m]
# An impact is solved to the default tolerance of a step, and where bodies touch found to 1e-9 m.
IMPACT, PLACE = 1e-9, 1e-9  # [m/s], [m]
PATHS = ((0, 0), (0, 17), (0, 45), (17, 17), (45, 45))  # of a box and its own yaw [degrees]
PASSED, EDGE, SPEED = 1.1, 0.5, 2.0  # [s], [m] where the higher tiles begin, [m/s]


def about(axis: tuple[float, float, float], degrees: float) -> np.ndarray:
    """Return the quaternion of a rotation."""
    half = math.radians(degrees) / 2.0
    return np.array([math.cos(half), *(math.sin(half) * np.array(axis) / np.linalg.norm(axis))])


def box(
    size: tuple[float, ...],
    mass: float,
    place: tuple[float, ...],
    velocity: tuple[float, ...],
    turned: tuple[np.ndarray, tuple[float, ...]],
) -> str:
    """Return a box as a YAML mapping; turned: its orientation and its spin."""
    shape = f"{{kind: box, size: {flow(size)}}}"
    return (
        f"{{shape: {shape}, mass: {mass!r}, surface: one, position: {flow(place)}, velocity: "
        f"{flow(velocity)}, orientation: {flow(turned[0])}, angular_velocity: {flow(turned[1])}}}"
    )


def moments(size: tuple[float, ...], mass: float) -> np.ndarray:
    squares = np.array(size) ** 2
    return (squares.sum() - squares) * mass / 12.0


def meet(number: int, rate: int) -> str:
    """A ball at 4 m/s meets a box that turns and moves, off its centre, in one of six ways."""
    ways = ((1, 2, 3), (-3, 1, 0.5), (0, -1, 2), (2, -2, 1), (1, 1, -4), (-1, 0, 0))
    toward = np.array(ways[number], dtype=float)
    toward = toward / np.linalg.norm(toward)
    drift, centre = np.array([0.3, -0.4, 0.2]), np.array([0.7, -0.4, 0.5])
    aside = 0.04 * np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1)])[number % 3]
    far = 0.4 + 4.0 / rate * number / 6.0
    turned = about((1, 1, number), 40.0 * number), (2.0, -1.0, 3.0)
    bodies = {
        "box": box(BOX_SIZE, BOX_MASS, tuple(centre), tuple(drift), turned),
        "ball": ball(
            BALL_RADIUS, BALL_MASS, centre + aside - far * toward, tuple(4.0 * toward + drift)
        ),
    }
    return config(bodies, rate, math.ceil((far + 0.2) / 4.0 * rate) / rate)


def free(walls: int, rate: int) -> str:
    """A box turns and flies between pairs of elastic walls, for 3 s."""
    bodies = {}
    for k in range(walls // 2):
        bodies |= {f"low{k}": plane(np.eye(3)[k], -WALL), f"high{k}": plane(-np.eye(3)[k], -WALL)}
    turned = np.array([1.0, 0, 0, 0]), (2.0, 3.0, 1.0)
    velocity = (1.3, 0.2, -0.1) if walls == 2 else (1.3, 0.9, -0.7)
    bodies["box"] = box(FREE_SIZE, 1.0, (0.02, -0.03, 0.01), velocity, turned)
    return config(bodies, rate, 3.0)


def tiles(riser: float) -> dict[str, str]:
    """Return flush tiles of half a metre, those from x = EDGE on higher by `riser`."""
    found = {}
    for i in range(6):
        for j in range(6):
            up = riser if i >= 2 else 0.0
            at = (0.5 * (i - 0.5), 0.5 * (j - 1), up - 0.0625)
            shape = "{kind: box, size: [0.5, 0.5, 0.125]}"
            found[f"tile{i}_{j}"] = (
                f"{{shape: {shape}, fixed: true, surface: one, position: {flow(at)}}}"
            )
    return found


def slide(path: float, yaw: float, riser: float = 0.0, rate: int = 240) -> str:
    """A cube of 0.2 m slides at 2 m/s, along x or askew, over tiles."""
    a = math.radians(path)
    turned = about((0, 0, 1), yaw), (0.0, 0.0, 0.0)
    velocity = (SPEED * math.cos(a), SPEED * math.sin(a), 0.0)
    bodies = tiles(riser) | {"body": box((0.2,) * 3, 1.0, (-0.31, -0.23, 0.1), velocity, turned)}
    return config(bodies, rate, PASSED, surface="friction: 0", gravity=repr(GRAVITY))


def over_riser(rate: int) -> str:
    """A ball of 0.1 m slides at 2 m/s against an edge 0.1 mm high."""
    bodies = tiles(1e-4) | {"body": ball(0.1, 1.0, (0.1, 0.13, 0.1), (SPEED, 0, 0))}
    return config(bodies, rate, 0.5, surface="friction: 0", gravity=repr(GRAVITY))


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {f"meet {number} {rate}": meet(number, rate) for number in range(6) for rate in RATES}
    texts |= {f"free {walls} {rate}": free(walls, rate) for walls in (2, 6) for rate in RATES}
    texts |= {f"seams {path}": slide(*path) for path in PATHS}
    texts |= {f"ball {rate}": over_riser(rate) for rate in RATES}
    texts |= {"riser 1e-4": slide(0, 0, 1e-4), "riser 1e-9": slide(0, 0, 1e-9)}
    return run_scenes(texts)


def rotations(turn: np.ndarray) -> np.ndarray:
    """Return the matrices (k, 3, 3) of quaternions (k, 4)."""
    w, v = turn[:, 0, None, None], turn[:, 1:]
    zero = np.zeros(len(turn))
    cross = np.array(
        [[zero, -v[:, 2], v[:, 1]], [v[:, 2], zero, -v[:, 0]], [-v[:, 1], v[:, 0], zero]]
    )
    cross = np.moveaxis(cross, -1, 0)
    return np.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross


def angular_momentum(states: States, bodies: dict[str, tuple[float, np.ndarray]]) -> np.ndarray:
    """Return the angular momentum about the origin of bodies of (mass, moments), (k + 1, 3)."""
    total = np.zeros((len(states.time), 3))
    for name, (mass, inertia) in bodies.items():
        i = states.names.index(name)
        frame = rotations(states.turn[:, i])
        body_spin = np.einsum("kij,ki->kj", frame, states.spin[:, i])
        total += np.einsum("kij,kj->ki", frame, inertia * body_spin)
        total += mass * np.cross(states.place[:, i], states.velocity[:, i])
    return total


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("number", range(6))
def test_bodies_that_meet_off_centre_keep_momentum_and_energy(
    ran: dict[str, States], number: int, rate: int
) -> None:
    states = ran[f"meet {number} {rate}"]
    assert abs(states.velocity[-1] - states.velocity[0]).max() > 0.1, "they missed each other"
    masses = np.array([BOX_MASS, BALL_MASS])
    momentum = np.einsum("i,kij->kj", masses, states.velocity)
    # Round-off of 3.7 kg m/s and, about the origin, of 4 N m s, in 120 to 200 steps.
    np.testing.assert_allclose(momentum - momentum[0], 0.0, atol=3.7e-12)
    ball_moments = np.full(3, 0.4 * BALL_MASS * BALL_RADIUS**2)
    found = angular_momentum(
        states,
        {"box": (BOX_MASS, moments(BOX_SIZE, BOX_MASS)), "ball": (BALL_MASS, ball_moments)},
    )
    np.testing.assert_allclose(found - found[0], 0.0, atol=4e-12)
    # The rest of a row, 1e-9 m/s, by an impulse of less than 2 m v = 5.6 N s, of more than 5.6 J.
    np.testing.assert_allclose(states.energy(), states.energy()[0], rtol=1e-9)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("walls", [2, 6])
def test_box_between_elastic_walls_keeps_its_energy(
    ran: dict[str, States], walls: int, rate: int
) -> None:
    states = ran[f"free {walls} {rate}"]
    # Some 20 impacts, each off by its row's rest of 1e-9 m/s times a jump of 3 m/s if it is
    # always the same sign; of 1.3 J or more. Single corners are solved to round-off.
    np.testing.assert_allclose(states.energy(), states.energy()[0], rtol=20e-9)
    corners = np.array(np.meshgrid(*([-s / 2, s / 2] for s in FREE_SIZE))).reshape(3, -1)
    i = states.names.index("box")
    at = states.place[:, i, :, None] + rotations(states.turn[:, i]) @ corners
    # A corner may be as deep as where it touches is not known, and as the slop of what lasts.
    assert abs(at[:, : walls // 2]).max() <= WALL + 1e-7 + PLACE
    velocity = states.velocity[:, i]
    assert np.ptp(velocity[:, 0]) > 2.0, "no wall was met"
    if walls == 2:  # they push along x: nothing else changes, nor the spin about x
        np.testing.assert_allclose(
            velocity[:, 1:], velocity[:1, 1:].repeat(len(velocity), 0), atol=1e-12
        )
        inertia = {"box": (1.0, moments(FREE_SIZE, 1.0))}
        spin = angular_momentum(states, inertia) - np.cross(states.place[:, i], velocity)
        np.testing.assert_allclose(spin[:, 0], spin[0, 0], atol=1e-12)


@pytest.mark.parametrize("path", PATHS)
def test_flush_seams_leave_a_box_alone(ran: dict[str, States], path: tuple[int, int]) -> None:
    """As on one plane: x + v t, and it does not turn."""
    states = ran[f"seams {path}"]
    place, _, spin = states.of("body")
    expected = place[0] + states.time[:, None] * states.velocity[0, -1]
    # It may sink by the slop of 1e-7 m, and slide down what its corners are apart in it.
    np.testing.assert_allclose(place, expected, atol=1e-6)
    np.testing.assert_allclose(0.1 * spin, 0.0, atol=1e-6)


def test_riser_of_a_nanometre_is_not_felt(ran: dict[str, States]) -> None:
    states = ran["riser 1e-9"]
    place, velocity, _ = states.of("body")
    assert place[-1, 0] > EDGE + 0.5
    expected = place[0] + states.time[:, None] * velocity[0]
    np.testing.assert_allclose(place, expected, atol=1e-6)


@pytest.mark.parametrize("rate", RATES)
def test_ball_meets_a_riser_of_a_tenth_of_a_millimetre(ran: dict[str, States], rate: int) -> None:
    """At e = 0 the velocity along the normal of the edge goes: v cos^2 of it is left along x."""
    place, velocity, _ = ran[f"ball {rate}"].of("body")
    assert place[-1, 0] > EDGE
    cosine = (0.1 - 1e-4) / 0.1
    # Where the ball has sunk by the slop of 1e-7 m, cos^2 is off by 2e-6, v by 4e-6 m/s.
    assert velocity[-1, 0] == pytest.approx(SPEED * cosine**2, abs=4e-6, rel=0)


def test_box_trips_over_a_riser_of_a_tenth_of_a_millimetre(ran: dict[str, States]) -> None:
    """It pivots about its lower edge: m v a/2 = (2/3) m a^2 omega, so 3/8 v is left along x."""
    _, velocity, spin = ran["riser 1e-4"].of("body")
    tripped = int(np.argmax(velocity[:, 0] < 0.9 * SPEED))
    # Of the step in which it trips: gravity slows the pivot by (3/4) g/a dt = 0.15 rad/s, that is
    # 15 mm/s; the contact is up to 0.1 mm above the edge, 0.1 % of it.
    assert velocity[tripped, 0] == pytest.approx(3.0 / 8.0 * SPEED, abs=0.016, rel=0)
    assert spin[tripped, 1] == pytest.approx(3.0 / 4.0 * SPEED / 0.2, abs=0.16, rel=0)
