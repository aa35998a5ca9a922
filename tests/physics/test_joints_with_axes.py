"""Hinges, fixed joints and sliders against closed forms and conservation laws; one engine for all.

Bodies are boxes of three different moments of inertia. Energy is kept to what solves leave, 1e-9
m/s a step, at any timestep; what of it depends on the timestep is said where it is.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import ellipk
from shared_runs import GRAVITY, States, config, flow, orders, run_scenes

from lavendersim.geometry.rotations import rotation_matrices

RATES = (60, 120, 240)  # steps a second
HOOK = "{shape: {kind: sphere, radius: 0.001}, fixed: true, surface: one, position: [0, 0, 0]}"
ROD = (0.2, 0.4, 1.0)  # of the pendulum [m]
ANGLE = math.pi / 3.0
AXIS, AT, OTHER = np.array([1.0, 2.0, -1.0]) / math.sqrt(6.0), (0.3, 0.1, 0.05), (0.6, 0.2, 0.1)
SPINNING, SLIDING = 3.0, 0.2  # of b about, and along, the axis [rad/s], [m/s]
CRANK, COUPLER, SPEED = 0.5, 1.0, 2.0  # [m], [m], of the four-bar linkage [rad/s]
SLOPE = 0.5  # of the inclined slider [rad]


def box(size, mass, place, velocity=(0, 0, 0), spin=(0, 0, 0), degrees=0.0, axis=(0, 1, 0)) -> str:
    turn = f"orientation: {{axis: {flow(axis)}, degrees: {degrees!r}}}"
    moves = f"velocity: {flow(velocity)}, angular_velocity: {flow(spin)}"
    shape = f"shape: {{kind: box, size: {flow(size)}}}, mass: {mass!r}, surface: one"
    return f"{{{shape}, position: {flow(place)}, {moves}, {turn}}}"


def joint(kind: str, a: str, b: str, at, axis=None) -> str:
    along = "" if axis is None else f", axis: {flow(axis)}"
    return f"{{kind: {kind}, between: [{a}, {b}], at: {flow(at)}{along}}}"


def joined(bodies, joints, rate: int, duration: float, gravity: float = GRAVITY) -> str:
    text = config(bodies, rate, duration, "restitution: 0", repr(gravity))
    lines = "".join(f"    joint_{k}: {one}\n" for k, one in enumerate(joints))
    return text.replace("  bodies:\n", f"  connections:\n{lines}  bodies:\n", 1)


def pendulum(rate: int) -> str:
    """A rod on a hinge beside it: its axis is level, and where along it the hinge is, no matter."""
    place = (0.5 * math.sin(ANGLE), 0.0, -0.5 * math.cos(ANGLE))
    bodies = {"hook": HOOK, "rod": box(ROD, 2.0, place, degrees=-math.degrees(ANGLE))}
    return joined(bodies, [joint("hinge", "hook", "rod", (0, 0.3, 0), (0, 1, 0))], rate, 5.0)


def flight(kind: str, rate: int) -> str:
    """Two boxes that tumble as one, but for what their joint leaves free."""
    spin, velocity = np.array([0.5, -1.0, 2.0]), np.array([0.1, 0.2, 0.3])
    other, moves = spin, velocity + np.cross(spin, OTHER)
    if kind == "hinge":
        other = spin + SPINNING * AXIS
        moves = velocity + np.cross(spin, AT) + np.cross(other, np.subtract(OTHER, AT))
    if kind == "slider":
        moves = moves + SLIDING * AXIS
    bodies = {
        "a": box((0.2, 0.3, 0.4), 2.0, (0, 0, 0), velocity, spin, 30.0),
        "b": box((0.5, 0.2, 0.1), 1.0, OTHER, moves, other, 70.0, (1, 1, 0)),
    }
    one = joint(kind, "a", "b", AT, None if kind == "fixed" else AXIS)
    return joined(bodies, [one], rate, 2.0, 0.0)


def linkage(rate: int) -> str:
    """Four hinges of one direction: three rows more than are independent of each other."""
    to, half = (SPEED * CRANK, 0, 0), (SPEED * CRANK / 2, 0, 0)
    side = (0.05, 0.05, CRANK)
    bodies = {
        "ground": HOOK,
        "crank": box(side, 1.0, (0, 0, CRANK / 2), half, (0, SPEED, 0)),
        "coupler": box((COUPLER, 0.05, 0.05), 3.0, (COUPLER / 2, 0, CRANK), to),
        "rocker": box(side, 1.0, (COUPLER, 0, CRANK / 2), half, (0, SPEED, 0)),
    }
    places = [(0, 0, 0), (0, 0, CRANK), (COUPLER, 0, CRANK), (COUPLER, 0, 0)]
    names = ["ground", "crank", "coupler", "rocker", "ground"]
    joints = [
        joint("hinge", *pair, at, (0, 1, 0))
        for *pair, at in zip(names[:-1], names[1:], places, strict=True)
    ]
    return joined(bodies, joints, rate, 2.0, 0.0)


def held(rate: int = 240) -> str:
    """A cantilever, a door on two hinges, a block on an inclined slider: each far from the rest."""
    door = box((1.0, 0.05, 2.0), 20.0, (10.5, 0, 0), (0, 0.5, 0), (0, 0, 1.0))
    bodies = {
        "hook": HOOK,
        "beam": box((1.0, 0.1, 0.1), 2.0, (0.5, 0, 0)),
        "door": door,
        "block": box((0.2, 0.1, 0.1), 3.0, (20, 0, 0)),
    }
    down = (math.cos(SLOPE), 0.0, -math.sin(SLOPE))
    joints = [
        joint("fixed", "hook", "beam", (0, 0, 0)),
        joint("hinge", "hook", "door", (10, 0, 0.8), (0, 0, 1)),
        joint("hinge", "hook", "door", (10, 0, -0.8), (0, 0, 1)),
        joint("slider", "hook", "block", (20, 0.3, 0.2), down),
    ]
    return joined(bodies, joints, rate, 0.5)


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {f"pendulum {r}": pendulum(r) for r in RATES}
    texts |= {f"{k} {r}": flight(k, r) for k in ("hinge", "fixed", "slider") for r in RATES}
    texts |= {"linkage": linkage(60), "unparted": held()}
    return run_scenes(texts)


def vectors(rows: np.ndarray, name: str) -> np.ndarray:
    return np.column_stack([rows[f"{name}_{axis}"] for axis in "xyz"])


def turns_of(states: States, body: str) -> np.ndarray:
    return states.turn[:, states.names.index(body)]


def load(states: States, number: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a joint's force [N] and its torque [N m] about where it is, in the last step."""
    rows = states.contact
    own = rows[(rows["joint"] == number) & (rows["step"] == rows["step"].max())]
    forces = own["force_n"][:, None] * np.column_stack([own[f"n{axis}"] for axis in "xyz"])
    arms = np.column_stack([own[axis] - own[axis][0] for axis in "xyz"])
    return forces.sum(axis=0), np.cross(arms, forces).sum(axis=0)


def test_pendulum_on_a_hinge_has_the_period_of_its_moment_of_inertia(
    ran: dict[str, States],
) -> None:
    """T = 4 sqrt(I/(m g d)) K(sin^2(a/2)), I = m (d^2 + (x^2 + z^2)/12), of order 2."""
    d = 0.5
    swung = math.sqrt((d * d + (ROD[0] ** 2 + ROD[2] ** 2) / 12.0) / (GRAVITY * d))
    period, errors = 4.0 * swung * ellipk(math.sin(0.5 * ANGLE) ** 2), []
    for rate in RATES:
        states = ran[f"pendulum {rate}"]
        x = states.of("rod")[0][:, 0]
        down = np.flatnonzero((x[:-1] > 0.0) & (x[1:] <= 0.0))
        crossed = states.time[down] + x[down] / (x[down] - x[down + 1]) / rate
        errors.append(abs((crossed[-1] - crossed[0]) / (len(crossed) - 1) - period))
    # (w dt)^2/8 of it at small angles, w = 1/swung; half as much again at this one.
    for error, rate in zip(errors, RATES, strict=True):
        assert error <= 0.2 / (swung * rate) ** 2 * period
    assert orders(errors) == pytest.approx([2.0] * 2, abs=0.2)


@pytest.mark.parametrize("rate", RATES)
def test_pendulum_on_a_hinge_keeps_its_energy_and_its_axis(
    ran: dict[str, States], rate: int
) -> None:
    states = ran[f"pendulum {rate}"]
    place, turn = states.of("rod")[0], turns_of(states, "rod")
    # As of a ball joint: the first step, and turning points, are of order 3 and 4 in the timestep.
    assert np.ptp(states.energy()) <= 2e-5 * (60 / rate) ** 3
    # What the first step falls beyond its circle, sweeps share out among rows for some steps.
    fallen = (0.5 * GRAVITY / rate**2) ** 2
    assert abs(place[:, 1]).max() <= fallen
    axes = rotation_matrices(turn)[:, :, 1]
    # At the distance of its two points, the body's radius of gyration of 0.26 m.
    np.testing.assert_allclose(axes, [[0, 1, 0]] * len(turn), atol=fallen / 0.26)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("kind", ["hinge", "fixed", "slider"])
def test_two_bodies_in_flight_keep_energy_momentum_and_what_joins_them(
    ran: dict[str, States], kind: str, rate: int
) -> None:
    states = ran[f"{kind} {rate}"]
    assert states.step["not_converged"].sum() == 0
    found = states.energy()
    # 1e-9 m/s a step of some kg m/s; a slider's mean is taken for torn where what it passes on
    # changes its sign, of order 4 in the timestep.
    assert np.ptp(found) <= (1e-8 if kind != "slider" else 5e-7)
    apart = 1e-10 if kind != "slider" else 5e-6
    assert abs(states.contact["separation"]).max() <= apart
    momentum = vectors(states.step, "momentum")
    np.testing.assert_allclose(momentum, momentum[:1].repeat(len(momentum), 0), atol=3e-9)
    # A torque turns an uneven body by its inertia of the middle, half before and half after it.
    angular = vectors(states.step, "angular_momentum")
    assert np.ptp(angular, axis=0).max() <= 1e-5 * (60 / rate) ** 2
    one, other = (rotation_matrices(turns_of(states, name)) for name in "ab")
    if kind == "hinge":
        axes = [turns @ (turns[0].T @ AXIS) for turns in (one, other)]
        np.testing.assert_allclose(axes[0], axes[1], atol=apart / 0.1)
    else:
        relative = one.transpose(0, 2, 1) @ other
        np.testing.assert_allclose(relative, relative[:1].repeat(len(relative), 0), atol=10 * apart)
    between = states.of("b")[0] - states.of("a")[0]
    local = np.einsum("nji,nj->ni", one, between)
    if kind == "fixed":
        np.testing.assert_allclose(local, local[:1].repeat(len(local), 0), atol=10 * apart)
    if kind == "slider":
        slid = local - local[0]
        along = one[0].T @ AXIS
        assert np.linalg.norm(slid - np.outer(slid @ along, along), axis=1).max() <= 10 * apart
        assert slid[-1] @ along > SLIDING  # in 2 s, and what turns throws it out


def test_linkage_of_hinges_turns_evenly_though_its_rows_are_too_many(
    ran: dict[str, States],
) -> None:
    states = ran["linkage"]
    assert states.step["not_converged"].sum() == 0
    assert states.step["midpoint_not_converged"].sum() == 0
    spin = states.of("crank")[2]
    # As that of ball joints (`test_joints`).
    left = 1e-9 * 2 * 60 / (0.5 * COUPLER)
    np.testing.assert_allclose(spin, [[0, SPEED, 0]] * len(spin), atol=left)
    np.testing.assert_allclose(states.of("coupler")[2], 0.0, atol=left)
    place = states.of("coupler")[0] - [COUPLER / 2, 0, 0]
    np.testing.assert_allclose(np.linalg.norm(place, axis=1), CRANK, atol=left)


def test_a_fixed_joint_carries_weight_and_moment_of_a_cantilever(ran: dict[str, States]) -> None:
    force, torque = load(ran["unparted"], 1)
    # 1e-9 m/s of a step's g/240, of 2 kg, at 0.5 m.
    np.testing.assert_allclose(abs(force), [0, 0, 2.0 * GRAVITY], atol=1e-6)
    np.testing.assert_allclose(abs(torque), [0, 2.0 * GRAVITY * 0.5, 0], atol=1e-6)


def test_a_door_on_two_hinges_turns_evenly_and_does_not_sag(ran: dict[str, States]) -> None:
    place, _, spin = ran["unparted"].of("door")
    assert abs(place[:, 2]).max() <= 1e-11
    np.testing.assert_allclose(spin, [[0, 0, 1.0]] * len(spin), atol=1e-9 * 120)
    forces = [load(ran["unparted"], number)[0] for number in (2, 3)]
    total = np.sum(forces, axis=0)
    # Its weight, and what keeps its centre on its circle: 20 kg, w^2 r = 0.5 m/s^2.
    assert abs(total[2]) == pytest.approx(20.0 * GRAVITY, rel=1e-6)
    assert np.hypot(*total[:2]) == pytest.approx(10.0, rel=1e-4)


def test_a_block_slides_down_its_slider_as_down_a_smooth_slope(ran: dict[str, States]) -> None:
    states = ran["unparted"]
    place, _, spin = states.of("block")
    fallen = 0.5 * GRAVITY * math.sin(SLOPE) * states.time**2
    down = np.array([math.cos(SLOPE), 0.0, -math.sin(SLOPE)])
    np.testing.assert_allclose(place - [20, 0, 0], np.outer(fallen, down), atol=1e-9)
    assert abs(spin).max() <= 1e-9 / 0.02  # what solves leave, at the body's radius of gyration
    force, _ = load(states, 4)
    assert np.linalg.norm(force) == pytest.approx(3.0 * GRAVITY * math.cos(SLOPE), rel=1e-6)


def test_joints_stay_together_where_no_force_acts_at_all() -> None:
    """A plan of its own: nothing accelerates bodies, and yet joints move them by their mean."""
    states = run_scenes({"hinge": flight("hinge", 120)})["hinge"]
    assert abs(states.contact["separation"]).max() <= 1e-10
    assert np.ptp(states.energy()) <= 1e-8
