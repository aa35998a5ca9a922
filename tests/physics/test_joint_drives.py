"""Limits and motors of hinges and sliders against closed forms and balances; one engine for all.

What a couple or a push along an axis gives is linear in time, and the scheme exact for it: what is
left are solves, 1e-9 m/s a step. What depends on the timestep is said where it is.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, run_scenes
from test_joints_with_axes import HOOK, box, joined, joint, load, turns_of, vectors

from lavendersim.geometry.rotations import rotation_matrices

RATE = 120  # steps a second
LEFT = 1e-9  # of a solve [m/s]
ROD, WEIGHT = (0.2, 0.4, 1.0), 2.0  # of the pendulum [m], [kg]; its hinge is at its end
HALF = 0.5
INERTIA = WEIGHT * (HALF**2 + (ROD[0] ** 2 + ROD[2] ** 2) / 12.0)  # about the hinge [kg m^2]
STOP, SLOPE, REACH = 0.8, 0.5, 0.5  # [rad], [rad], [m]
WHEEL = 2.0 * (ROD[0] ** 2 + ROD[2] ** 2) / 12.0  # about y [kg m^2]
TORQUE, SPIN = 0.4, 2.0  # of the wheel's motor [N m], [rad/s]
PUSH, MASS = 20.0, 3.0  # of a motor of a slider that cannot lift its block [N], [kg]
UP = 4.0  # how fast a block with friction begins [m/s]
CRANK, COUPLER, DRIVE = 0.1, 0.25, 4.0  # of the crank-slider [m], [m], [rad/s]
AXIS, OTHER = np.array([1.0, 2.0, -1.0]) / math.sqrt(6.0), (0.6, 0.2, 0.1)
TUMBLE = np.array([0.5, -1.0, 2.0])  # [rad/s]


def driven(kind: str, a: str, b: str, at, axis, keys: str) -> str:
    return f"{joint(kind, a, b, at, axis)[:-1]}, {keys}}}"


def level_rod(keys: str, duration: float, rate: int = RATE) -> str:
    """A rod held level by its end, which falls as an angle about y that grows."""
    bodies = {"hook": HOOK, "rod": box(ROD, WEIGHT, (HALF, 0, 0), degrees=90.0)}
    one = driven("hinge", "hook", "rod", (0, 0.3, 0), (0, 1, 0), keys)
    return joined(bodies, [one], rate, duration)


def block(axis, keys: str, duration: float, velocity=(0, 0, 0)) -> str:
    bodies = {"hook": HOOK, "block": box((0.2, 0.1, 0.1), MASS, (0.3, 0.2, 0), velocity)}
    one = driven("slider", "hook", "block", (0, 0, 0), axis, keys)
    return joined(bodies, [one], RATE, duration)


def wheel() -> str:
    """`between` turned round: the wheel against what stands, by the opposite speed."""
    bodies = {"hook": HOOK, "wheel": box(ROD, 2.0, (0, 0, 0))}
    keys = f"motor: {{speed: {-SPIN!r}, max_torque: {TORQUE!r}}}"
    return joined(bodies, [driven("hinge", "wheel", "hook", (0, 0, 0), (0, 1, 0), keys)], RATE, 1.0)


def crank_slider() -> str:
    """Three hinges and a slider, 20 rows for the 17 speeds that the crank's leaves no choice of."""
    bodies = {
        "ground": HOOK.replace("position: [0, 0, 0]", "position: [0, 5, 0]"),  # out of the way
        "crank": box((CRANK, 0.02, 0.02), 0.5, (CRANK / 2, 0, 0), (0, 0, 0)),
        "coupler": box((COUPLER, 0.02, 0.02), 1.0, (CRANK + COUPLER / 2, 0, 0)),
        "piston": box((0.06, 0.06, 0.06), 2.0, (CRANK + COUPLER, 0, 0)),
    }
    across = (0, 1, 0)
    motor = f"motor: {{speed: {-DRIVE!r}, max_torque: 500}}"  # from its first step on, in time
    joints = [
        driven("hinge", "ground", "crank", (0, 0, 0), across, motor),
        joint("hinge", "crank", "coupler", (CRANK, 0, 0), across),
        joint("hinge", "coupler", "piston", (CRANK + COUPLER, 0, 0), across),
        joint("slider", "piston", "ground", (CRANK + COUPLER, 0, 0), (1, 0, 0)),
    ]
    return joined(bodies, joints, RATE, 1.6, 0.0)


def flight(kind: str, keys: str) -> str:
    """Two boxes that tumble as one, until their motor has driven them or they meet a limit."""
    velocity = np.array([0.1, 0.2, 0.3])
    moves = velocity + np.cross(TUMBLE, OTHER)
    bodies = {
        "a": box((0.2, 0.3, 0.4), 2.0, (0, 0, 0), velocity, TUMBLE, 30.0),
        "b": box((0.5, 0.2, 0.1), 1.0, OTHER, moves, TUMBLE, 70.0, (1, 1, 0)),
    }
    one = driven(kind, "a", "b", (0.3, 0.1, 0.05), AXIS, keys)
    return joined(bodies, [one], RATE, 1.0, 0.0)


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    held = WEIGHT * GRAVITY * HALF
    down = (math.cos(SLOPE), 0, -math.sin(SLOPE))
    turning = "motor: {speed: 3, max_torque: 0.3}, limits: [-1, 0.5]"
    return run_scenes(
        {
            "rod": level_rod(f"limits: [-0.1, {STOP!r}]", 1.0),
            "block": block(down, f"limits: [-0.1, {REACH!r}]", 1.0),
            "wheel": wheel(),
            "weak": block((0, 0, 1), f"motor: {{speed: 1, max_force: {PUSH!r}}}", 0.5),
            "resisted": block(
                (0, 0, 1), f"motor: {{speed: 0, max_force: {PUSH!r}}}", 0.5, (0, 0, UP)
            ),
            "brake": level_rod(f"motor: {{speed: 0, max_torque: {1.2 * held!r}}}", 0.5),
            "slips": level_rod(f"motor: {{speed: 0, max_torque: {0.4 * held!r}}}", 0.02),
            "crank": crank_slider(),
            "turned": flight("hinge", turning),
            "thrown": flight("slider", "motor: {speed: 1, max_force: 2}, limits: [-1, 0.3]"),
        }
    )


def last(states: States) -> np.ndarray:
    rows = states.contact
    return rows[rows["step"] == rows["step"].max()]


def gained(states: States) -> np.ndarray:
    """Return energy less what motors gave, after every step [J]."""
    return states.energy() - np.cumsum(states.step["motor_work"])


def test_a_pendulum_that_falls_against_its_limit_gives_its_angular_momentum_and_rests(
    ran: dict[str, States],
) -> None:
    """I w = sqrt(2 m g d sin(stop) I) when it meets, m g d cos(stop) where it rests."""
    states = ran["rod"]
    spin = math.sqrt(2.0 * WEIGHT * GRAVITY * HALF * math.sin(STOP) / INERTIA)
    rows = states.contact[np.abs(states.contact["approach_velocity"]) > 1.0]
    # The stop pushes where the rod's centre is. Order 4 in dt of what energy has: (w dt)^4.
    met = float(rows["impulse_n"].max()) * HALF
    assert met == pytest.approx(INERTIA * spin, rel=(spin / RATE) ** 4)
    q = turns_of(states, "rod")
    angle = 2.0 * np.arctan2(q[:, 2], q[:, 0]) - math.pi / 2.0
    assert angle.max() <= STOP + 1e-9
    assert angle[-1] == pytest.approx(STOP, abs=1e-9)
    assert abs(states.of("rod")[2][-1]).max() <= LEFT / HALF
    _, torque = load(states, 1)
    expected = [WEIGHT * GRAVITY * 0.3, WEIGHT * GRAVITY * HALF * math.cos(STOP), 0]  # at y = 0.3
    # 1e-9 m/s of a step, by the body's moment of inertia.
    np.testing.assert_allclose(abs(torque), expected, atol=10 * LEFT * RATE * INERTIA / HALF)
    assert np.diff(gained(states)).max() <= LEFT


def test_a_block_that_meets_the_end_of_its_slider_stops_there(ran: dict[str, States]) -> None:
    states = ran["block"]
    place = states.of("block")[0] - [0.3, 0.2, 0]
    slid = place @ [math.cos(SLOPE), 0, -math.sin(SLOPE)]
    assert slid.max() <= REACH + 1e-11
    assert slid[-1] == pytest.approx(REACH, abs=1e-11)
    speed = math.sqrt(2.0 * GRAVITY * math.sin(SLOPE) * REACH)
    assert states.contact["impulse_n"].max() == pytest.approx(MASS * speed, rel=1e-9)
    assert np.linalg.norm(load(states, 1)[0]) == pytest.approx(MASS * GRAVITY, rel=1e-8)


def test_a_motor_brings_a_wheel_to_its_speed_by_its_torque_and_holds_it(
    ran: dict[str, States],
) -> None:
    states = ran["wheel"]
    spin = states.of("wheel")[2]
    expected = np.minimum(TORQUE / WHEEL * states.time, SPIN)
    np.testing.assert_allclose(spin[:, 1], expected, atol=LEFT)
    np.testing.assert_allclose(spin[:, [0, 2]], 0.0, atol=1e-12)
    # All that it gave is motion: (s_0 + s_1)/2 is how it turned.
    assert states.step["motor_work"].sum() == pytest.approx(0.5 * WHEEL * SPIN**2, abs=1e-9)
    twists = states.contact["twist_y"]
    assert np.abs(twists).max() == pytest.approx(TORQUE / RATE, rel=1e-12)
    assert np.abs(last(states)["twist_y"]).max() <= LEFT


def test_a_motor_that_is_too_weak_falls_by_what_it_lacks(ran: dict[str, States]) -> None:
    states = ran["weak"]
    velocity = states.of("block")[1][:, 2]
    lacks = PUSH / MASS - GRAVITY
    np.testing.assert_allclose(velocity, lacks * states.time, atol=LEFT)
    fallen = 0.5 * lacks * states.time[-1] ** 2
    assert states.step["motor_work"].sum() == pytest.approx(PUSH * fallen, rel=1e-9)


def test_friction_of_a_slider_turns_round_where_its_block_does(ran: dict[str, States]) -> None:
    """Up against g + f, down against g - f, f = PUSH/m, from where it stands still, in a step."""
    states, resists = ran["resisted"], PUSH / MASS
    height = states.of("block")[0][:, 2]
    turns = UP / (GRAVITY + resists)
    assert 0.1 < turns * RATE % 1.0 < 0.9
    up, down = np.minimum(states.time, turns), np.maximum(states.time - turns, 0.0)
    expected = UP * up - 0.5 * (GRAVITY + resists) * up**2 - 0.5 * (GRAVITY - resists) * down**2
    # Solves leave 1e-9 m/s in each of its parts; the instant is found to 1e-6 of a step.
    np.testing.assert_allclose(height, expected, atol=states.time[-1] * 10 * LEFT)
    way = 0.5 * UP * turns + 0.5 * (GRAVITY - resists) * down[-1] ** 2
    assert states.step["motor_work"].sum() == pytest.approx(-PUSH * way, rel=1e-7)


def test_a_motor_keeps_its_speed_however_its_bodies_tumble(ran: dict[str, States]) -> None:
    """It is kept about the axis of the middle, which is w dt/2 from that of the end: 1 - cos."""
    states = ran["turned"]
    one = rotation_matrices(turns_of(states, "a"))
    axis = np.einsum("nij,kj,k->ni", one, one[0], AXIS)
    spins = [states.of(body)[2] for body in "ab"]
    along = np.einsum("ni,ni->n", axis, spins[1] - spins[0])
    kept = (states.time > 0.12) & (states.time < 0.2)  # it has it, and meets no limit yet
    fastest = max(np.linalg.norm(one, axis=1).max() for one in spins)
    assert kept.sum() > 5
    np.testing.assert_allclose(along[kept], 3.0, atol=3.0 * (fastest / RATE) ** 2 / 8.0)
    assert states.step["parts"][kept].max() == 1  # while it holds, no part ends for it


def test_a_motor_of_no_speed_holds_as_friction_does_up_to_its_most(ran: dict[str, States]) -> None:
    braked = ran["brake"]
    assert abs(braked.of("rod")[2]).max() <= LEFT / HALF
    twists = last(braked)["twist_y"]
    held = WEIGHT * GRAVITY * HALF
    assert np.abs(twists).max() * RATE == pytest.approx(held, abs=10 * LEFT * RATE * INERTIA / HALF)
    slips = ran["slips"]
    # The first step begins level: the rest of the torque turns it.
    assert slips.of("rod")[2][1, 1] == pytest.approx(0.6 * held / INERTIA / RATE, abs=LEFT / HALF)
    assert slips.step["motor_work"][1:].max() < 0.0  # it only takes


def test_a_crank_slider_that_a_motor_drives_has_its_closed_form(ran: dict[str, States]) -> None:
    """x = r cos a + sqrt(l^2 - (r sin a)^2) of the crank's own angle a."""
    states = ran["crank"]
    assert states.step["not_converged"].sum() == 0
    assert states.step["midpoint_not_converged"].sum() == 0
    # The first step takes all of it from rest, and turns by half of it, as bodies do that jump.
    spin = states.of("crank")[2]
    np.testing.assert_allclose(spin[2:], [[0, -DRIVE, 0]] * (len(spin) - 2), atol=10 * LEFT / CRANK)
    q = turns_of(states, "crank")
    angle = np.unwrap(2.0 * np.arctan2(-q[:, 2], q[:, 0]), period=2.0 * math.pi)
    x = CRANK * np.cos(angle) + np.sqrt(COUPLER**2 - (CRANK * np.sin(angle)) ** 2)
    # Points of joints are together to what projection leaves, through the dead centres too. First
    # steps tear them by r (w dt)^2/2, and that is brought back to its square in each.
    off = x - states.of("piston")[0][:, 0]
    torn = 0.5 * (DRIVE / RATE) ** 2
    assert abs(off).max() <= COUPLER * torn * (DRIVE / RATE)
    assert abs(off[6:]).max() <= 1e-9
    np.testing.assert_allclose(states.of("piston")[0][:, 1:], 0.0, atol=1e-10)
    turned = angle[-1] - angle[6]
    # 2 atan(w dt/2) a step, Cayley's map; where what a joint passes on changes its sign a step may
    # take it for torn, of order 4.
    once = (DRIVE / RATE) ** 4
    each = 2.0 * math.atan(0.5 * DRIVE / RATE)
    assert turned == pytest.approx((len(angle) - 7) * each, abs=once)
    # What the motor gives is kinetic energy: nothing else works.
    assert np.ptp(gained(states)[6:]) <= once


@pytest.mark.parametrize("name", ["turned", "thrown"])
def test_motors_and_limits_act_between_bodies_and_on_nothing_else(
    ran: dict[str, States], name: str
) -> None:
    states = ran[name]
    momentum = vectors(states.step, "momentum")
    np.testing.assert_allclose(momentum, momentum[:1].repeat(len(momentum), 0), atol=3e-9)
    angular = vectors(states.step, "angular_momentum")
    # As of joints alone: uneven bodies have their torques at the middle of the step.
    assert np.ptp(angular, axis=0).max() <= 3e-5
    assert states.step["motor_work"].max() > 0.0
    one, other = (rotation_matrices(turns_of(states, body)) for body in "ab")
    if name == "turned":
        relative = np.einsum("nji,njk->nik", one, other)
        cosine = 0.5 * (np.einsum("nij,ij->n", relative, relative[0]) - 1.0)
        moved = np.arccos(np.clip(cosine, -1.0, 1.0))
        # It is met by even spins in a step: (w dt)^2 of what turns at some 3 rad/s.
        limit, off = 0.5, (3.0 / RATE) ** 2
    else:
        between = states.of("b")[0] - states.of("a")[0]
        local = np.einsum("nji,nj->ni", one, between)
        moved = np.linalg.norm(local - local[0], axis=1)
        limit, off = 0.3, 1e-9
    assert moved.max() == pytest.approx(limit, abs=off)
    assert moved[-1] == pytest.approx(limit, abs=off)
    # A motor gives what it says; a limit only takes, but for what its place is off, (w dt)^2.
    rises = np.diff(gained(states))
    met = int(np.argmax(moved > limit - 10 * off))
    assert np.abs(rises[: met - 1]).max() <= 1e-11
    assert np.maximum(rises, 0.0).sum() <= (1e-11 if name == "thrown" else off)
    assert rises.min() < -1e-3  # it stops
