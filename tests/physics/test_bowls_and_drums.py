"""What moves inside a bowl or a drum: pendulums by elliptic integrals, and statics.

A ball of radius r in a bowl of radius R swings about its centre at L = R - r, an upright cube whose
four lower corners touch as a rigid pendulum about it. With k = sin(q_0 / 2), from rest:

    q'' = -w^2 sin q,     q(t) = 2 arcsin(k cd(w t, k))
    sliding ball w^2 = g/L;   rolling ball (7/5) L w^2 = g;   rolling cylinder (3/2) L w^2 = g
    cube, edge s: d = sqrt(R^2 - s^2/2) - s/2 from the centre, w^2 = g d / (s^2/6 + d^2)
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import ellipj
from shared_runs import GRAVITY, States, config, flow, orders, run_scenes

R, SMALL, LARGE = 0.5, 0.1, 1.2  # [m], [rad]
RADIUS = 0.1  # of balls and cylinders [m]
EDGE = 0.2  # of the cube [m]
ARM = R - RADIUS
CUBE_ARM = math.sqrt(R * R - 0.5 * EDGE * EDGE) - 0.5 * EDGE
RATES = (120, 240, 480)
DURATION = 0.8  # [s], past where what slides turns back: half a swing from 1.2 rad takes 0.7 s
SQUARED = {  # w^2 [1/s^2], and the distance of the centre [m]
    "sliding": (GRAVITY / ARM, ARM),
    "rolling": (GRAVITY / (1.4 * ARM), ARM),
    "cylinder": (GRAVITY / (1.5 * ARM), ARM),
    "cube": (GRAVITY * CUBE_ARM / (EDGE * EDGE / 6.0 + CUBE_ARM**2), CUBE_ARM),
}
SHAPES = {
    "sliding": f"{{kind: sphere, radius: {RADIUS}}}",
    "rolling": f"{{kind: sphere, radius: {RADIUS}}}",
    "cylinder": f"{{kind: cylinder, radius: {RADIUS}, length: 0.3}}",
    "cube": f"{{kind: box, size: [{EDGE}, {EDGE}, {EDGE}]}}",
}
ROLLED = {"rolling", "cylinder"}
TURN = {"cylinder": (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)}  # its axis along y, as the drum's
BOWL = f"{{shape: {{kind: bowl, radius: {R}}}, position: [0, 0, 0], surface: one}}"
DRUM = (
    f"{{shape: {{kind: drum, radius: {R}}}, position: [0, 0, 0], surface: one, "
    f"orientation: {flow((math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0))}}}"
)


def released(motion: str, angle: float, rate: int) -> str:
    place = SQUARED[motion][1]
    at = flow((place * math.sin(angle), 0.0, -place * math.cos(angle)))
    turn = TURN.get(motion)
    if motion == "cube":
        turn = (math.cos(0.5 * angle), 0.0, -math.sin(0.5 * angle), 0.0)
    turned = f", orientation: {flow(turn)}" if turn else ""
    it = f"{{shape: {SHAPES[motion]}, mass: 2.0, position: {at}{turned}, surface: one}}"
    wall = {"drum": DRUM} if motion in TURN else {"bowl": BOWL}
    surface = f"friction: {20.0 if motion in ROLLED else 0.0}"
    text = config(wall | {"it": it}, rate, DURATION, surface, repr(GRAVITY))
    return text.replace("timestep:", "integrator: midpoint_contact, timestep:")


def swung(motion: str, angle: float, times: np.ndarray) -> np.ndarray:
    k, w = math.sin(0.5 * angle), math.sqrt(SQUARED[motion][0])
    _, cn, dn, _ = ellipj(w * times, k * k)
    return 2.0 * np.arcsin(k * cn / dn)


def angles(states: States) -> np.ndarray:
    place, _, _ = states.of("it")
    return np.arctan2(place[:, 0], -place[:, 2])


def billiard(place: np.ndarray, velocity: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return where a point in a bowl of radius ARM is that gives back everything, without gravity.

    It flies along chords of one length; at each end what is along the normal changes its sign.
    """
    found, now = [], 0.0
    for time in times:
        while True:
            squared, along = velocity @ velocity, place @ velocity
            root = math.sqrt(along * along + squared * (ARM * ARM - place @ place))
            left = (root - along) / squared
            if now + left > time:
                break
            place, now = place + velocity * left, now + left
            n = place / np.linalg.norm(place)
            velocity = velocity - 2.0 * (velocity @ n) * n
            place = n * ARM * (1.0 - 1e-15)
        place, now = place + velocity * (time - now), time
        found.append(place)
    return np.array(found)


THROWN = np.array([0.1, 0.0, -0.05])  # [m]
SPEEDS = (3.0, 100.0)  # [m/s]: a step of 1/120 s is 3 % and 83 % of the bowl across
DIRECTION = np.array([math.cos(1.9), 0.0, math.sin(1.9)])
OMEGA, RESISTANCE = 5.0, 0.02  # of the drum [rad/s]; rolling friction [m]


def thrown(speed: float) -> str:
    it = f"{{shape: {SHAPES['sliding']}, mass: 2.0, position: {flow(THROWN)}, surface: one, "
    it += f"velocity: {flow(speed * DIRECTION)}}}"
    text = config({"bowl": BOWL, "it": it}, 120, 0.5, "restitution: 1")
    return text.replace("timestep:", "integrator: midpoint_contact, timestep:")


def turning() -> str:
    """Return a ball that rolls in a turning drum, near where it stays."""
    angle = math.atan2(RESISTANCE, RADIUS)
    at = flow((ARM * math.sin(angle), 0.0, -ARM * math.cos(angle)))
    spin = f"angular_velocity: {flow((0.0, -OMEGA * R / RADIUS, 0.0))}"
    it = f"{{shape: {SHAPES['rolling']}, mass: 2.0, position: {at}, surface: one, {spin}}}"
    drum = DRUM[:-1] + f", kinematic: true, angular_velocity: {flow((0.0, -OMEGA, 0.0))}}}"
    surface = f"friction: 1, rolling_friction: {RESISTANCE}"
    text = config({"drum": drum, "it": it}, 240, 1.0, surface, repr(GRAVITY))
    return text.replace("timestep:", "integrator: midpoint_contact, timestep:")


def scenes() -> dict[str, str]:
    found = {
        f"{motion} {angle} {rate}": released(motion, angle, rate)
        for motion in SQUARED
        for angle in (SMALL, LARGE)
        for rate in RATES
    }
    found |= {f"thrown {speed}": thrown(speed) for speed in SPEEDS}
    return found | {"turning": turning(), "rests": released("cube", 0.0, 120)}


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    return run_scenes(scenes())


@pytest.mark.parametrize("angle", [SMALL, LARGE])
@pytest.mark.parametrize("motion", SQUARED)
def test_it_swings_as_a_pendulum_to_order_2(
    ran: dict[str, States], motion: str, angle: float
) -> None:
    every = [ran[f"{motion} {angle} {rate}"] for rate in RATES]
    errors = [float(abs(angles(one) - swung(motion, angle, one.time)).max()) for one in every]
    # A series in (w dt)^2 <= (5.2/120)^2 = 2e-3, of which the next term is some share: log2 of a
    # ratio is then within 0.1, as of a rocking ellipsoid.
    assert orders(errors) == pytest.approx([2.0, 2.0], abs=0.1)
    # The trapezoidal rule on q'' = -w^2 q: its phase is (w dt)^2/12 of w t late, and the first step
    # from rest is as much once more; w t <= 5.2, (5.2/480)^2 = 1.2e-4, a turn of q / 2 per radian.
    assert errors[-1] < 2.0 * 5.2 * 1.2e-4 / 12.0 * angle


@pytest.mark.parametrize("angle", [SMALL, LARGE])
@pytest.mark.parametrize("motion", SQUARED)
def test_energy_and_the_distance_from_the_wall_are_kept(
    ran: dict[str, States], motion: str, angle: float
) -> None:
    """A chord of a circle is across the radius at its middle: contacts there do no work.

    Friction that holds a turning surface does, of order dt^3 in each step.
    """
    for rate in RATES:
        one = ran[f"{motion} {angle} {rate}"]
        energy, (place, _, _) = one.energy(), one.of("it")
        off = np.hypot(place[:, 0], place[:, 2]) - SQUARED[motion][1]
        swing = 2.0 * GRAVITY * SQUARED[motion][1] * (1.0 - math.cos(angle))  # [J], mass 2 kg
        stride = math.sqrt(SQUARED[motion][0]) * angle / rate
        # Round-off, solves that end at 1e-9 m/s, and (w dt)^2 of what rolls.
        assert abs(energy - energy[0]).max() < (stride**2 if motion in ROLLED else 1e-6) * swing
        assert abs(off).max() < 0.05 * stride**4 + 1e-8


@pytest.mark.parametrize("speed", SPEEDS)
def test_a_ball_that_gives_back_everything_flies_along_chords(
    ran: dict[str, States], speed: float
) -> None:
    one = ran[f"thrown {speed}"]
    exact = billiard(THROWN, speed * DIRECTION, one.time)
    # Each of up to 100 bounces is met within a quarter of 1e-9 m, and turns what follows as much
    # as a chord is long.
    np.testing.assert_allclose(one.of("it")[0], exact, atol=100 * 1e-9)
    energy = one.energy()
    np.testing.assert_allclose(energy, energy[0], rtol=1e-12)


def test_a_ball_stays_in_a_turning_drum_where_its_rolling_resistance_holds_it(
    ran: dict[str, States],
) -> None:
    """m g sin q = F, F r = c N, N = m g cos q: tan q = c/r, rolled on by the drum at R/r times
    its spin."""
    one = ran["turning"]
    _, velocity, spin = one.of("it")
    angle = math.atan2(RESISTANCE, RADIUS)
    # Solves end at 1e-9 m/s; and the wall is left alone within the slop, 1e-5 m of ARM.
    assert angles(one) == pytest.approx(angle, abs=1e-5 / ARM)
    np.testing.assert_allclose(velocity[-1], 0.0, atol=1e-7)
    np.testing.assert_allclose(spin[-1], (0.0, -OMEGA * R / RADIUS, 0.0), atol=1e-5)


def test_a_box_rests_on_four_corners_that_share_its_weight_by_their_slope(
    ran: dict[str, States],
) -> None:
    """Each corner pushes along the radius, at sin a = edge / sqrt(2) / R: N = m g / (4 cos a)."""
    one = ran["rests"]
    slope = math.sqrt(1.0 - 0.5 * (EDGE / R) ** 2)
    last = one.contact[one.contact["step"] == one.contact["step"].max()]
    assert len(last) == 4
    np.testing.assert_allclose(last["force_n"], 2.0 * GRAVITY / (4.0 * slope), rtol=1e-6)
    np.testing.assert_allclose(last["nz"], slope, rtol=1e-9)
    np.testing.assert_allclose(one.of("it")[0], [(0.0, 0.0, -CUBE_ARM)] * len(one.time), atol=1e-8)
