"""Ball joints against closed forms and conservation laws; all scenes share an engine.

At the middle of a step a joint does no work and leaves nothing to project (`engine.joint_turn`), so
energy is kept to what solves and passes leave, at any timestep.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from scipy.special import ellipk
from shared_runs import GRAVITY, States, ball, config, flow, orders, run_scenes

RATES = (60, 120, 240)  # steps a second
RADIUS = 0.3  # of the pendulum's bob [m]
HOOK = "{shape: {kind: sphere, radius: 0.001}, fixed: true, surface: one, position: [0, 0, 0]}"
AT = np.array([0.3, 0.1, 0.05])  # of the joint of what flies [m]
OFF = np.array([0.3, -0.2, 0.4])  # at which the joint is torn as the run begins [m/s]
CRANK, COUPLER, SPEED = 0.5, 1.0, 2.0  # [m], [m], of the four-bar linkage [rad/s]
MASSES = (2.0, 1.0)


def joined(
    bodies: dict[str, str], joints: list[str], rate: int, duration: float, gravity: float
) -> str:
    text = config(bodies, rate, duration, "restitution: 0", repr(gravity))
    lines = "".join(f"    joint_{k}: {{kind: ball, {one}}}\n" for k, one in enumerate(joints))
    return text.replace("  bodies:\n", f"  connections:\n{lines}  bodies:\n", 1)


def turning(radius: float, mass: float, place, velocity, spin) -> str:
    one = ball(radius, mass, place, tuple(velocity))
    return one.replace("surface: one", f"angular_velocity: {flow(spin)}, surface: one")


def pendulum(rate: int, angle: float) -> str:
    place = (math.sin(angle), 0.0, -math.cos(angle))
    bodies = {"hook": HOOK, "bob": ball(RADIUS, 1.0, place)}
    return joined(bodies, ["between: [bob, hook], at: [0, 0, 0]"], rate, 10.0, GRAVITY)


def flight(rate: int, off: np.ndarray) -> str:
    """Two balls that turn about the point that they share, which b's leaves at a velocity."""
    place, spins = np.array([0.6, 0.2, 0.1]), np.array([[0.5, -1.0, 2.0], [1.0, 2.0, -1.5]])
    first = np.array([0.1, 0.2, 0.3])
    second = first + np.cross(spins[0], AT) - np.cross(spins[1], AT - place) + off
    bodies = {
        "a": turning(0.2, MASSES[0], (0, 0, 0), first, spins[0]),
        "b": turning(0.3, MASSES[1], place, second, spins[1]),
    }
    return joined(bodies, [f"between: [a, b], at: {flow(AT)}"], rate, 3.0, 0.0)


def parallelogram(rate: int) -> str:
    """Four equal sides two and two, of balls: nine rows more than its motion has unknowns of."""
    bodies = {
        "ground": HOOK,
        "crank": turning(0.02, 1.0, (0, 0, CRANK / 2), (SPEED * CRANK / 2, 0, 0), (0, SPEED, 0)),
        "coupler": ball(0.02, 3.0, (COUPLER / 2, 0, CRANK), (SPEED * CRANK, 0, 0)),
        "rocker": turning(
            0.02, 1.0, (COUPLER, 0, CRANK / 2), (SPEED * CRANK / 2, 0, 0), (0, SPEED, 0)
        ),
    }
    joints = [
        "between: [ground, crank], at: [0, 0, 0]",
        f"between: [crank, coupler], at: [0, 0, {CRANK}]",
        f"between: [coupler, rocker], at: [{COUPLER}, 0, {CRANK}]",
        f"between: [rocker, ground], at: [{COUPLER}, 0, 0]",
    ]
    return joined(bodies, joints, rate, 2.0, 0.0)


def chain(links: int, load: float) -> str:
    """Links between joints 0.1 m apart; balls that overlap where they are joined."""
    bodies, joints, last = {"hook": HOOK}, [], "hook"
    for k in range(links):
        mass = load if k == links - 1 else 1.0
        bodies[f"link_{k}"] = ball(0.06, mass, (0, 0, -0.1 * (k + 0.5)))
        joints.append(f"between: [{last}, link_{k}], at: {flow((0, 0, -0.1 * k))}")
        last = f"link_{k}"
    return joined(bodies, joints, 240, 0.1, GRAVITY)


def falling(rate: int) -> str:
    """Four links in a level row, the first at a hook, let go."""
    bodies = {"hook": HOOK}
    for k in range(4):
        bodies[f"link_{k}"] = ball(0.04, 0.5, (0.05 + 0.1 * k, 0, 0))
    names = [*bodies]
    joints = [
        f"between: [{a}, {b}], at: {flow((0.1 * k, 0, 0))}"
        for k, (a, b) in enumerate(itertools.pairwise(names))
    ]
    return joined(bodies, joints, rate, 1.0, GRAVITY)


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {f"pendulum {angle} {r}": pendulum(r, angle) for angle in (0.5, 1.5) for r in RATES}
    texts |= {f"flight {r}": flight(r, np.zeros(3)) for r in RATES}
    texts |= {f"torn {r}": flight(r, OFF) for r in RATES}
    texts |= {f"linkage {r}": parallelogram(r) for r in RATES}
    texts |= {"chain": chain(10, 1000.0)}
    texts |= {f"falling {r}": falling(r) for r in RATES}
    return run_scenes(texts)


def vectors(rows: np.ndarray, name: str) -> np.ndarray:
    return np.column_stack([rows[f"{name}_{axis}"] for axis in "xyz"])


def forces(states: States, joint: int) -> np.ndarray:
    """Return the force of a joint in every step, along the world's axes [N]."""
    rows = states.contact[states.contact["joint"] == joint]
    along = rows["force_n"][:, None] * np.column_stack([rows[f"n{axis}"] for axis in "xyz"])
    return along.reshape(-1, 3, 3).sum(axis=1)


@pytest.mark.parametrize(("angle", "rate"), [*itertools.product((0.5, 1.5), RATES)])
def test_pendulum_keeps_its_energy_and_its_point(
    ran: dict[str, States], angle: float, rate: int
) -> None:
    states = ran[f"pendulum {angle} {rate}"]
    found = states.energy()
    # Begun at rest, the first step is made with the levers of its start: it falls by g dt^2/2 along
    # the tangent, and is brought back by the square of that over 2 l.
    fallen = 0.5 * GRAVITY / rate**2
    assert abs(found[1] - found[0]) <= GRAVITY * fallen**2
    # The first step, from rest, had no middle; its end is torn, and is left. From there on it is
    # what passes leave: 1e-9 m/s of each impulse, of some m g T/rate in a step.
    assert abs(found[2] - found[1]) <= GRAVITY * fallen**2
    assert np.ptp(found[2:]) <= 3e-9
    lengths = np.linalg.norm(states.of("bob")[0], axis=1)
    assert abs(lengths - 1.0).max() <= 0.6 * fallen**2 + 1e-8 * (60 / rate) ** 3


@pytest.mark.parametrize("rate", RATES)
def test_chain_that_falls_keeps_its_energy_where_links_turn_back(
    ran: dict[str, States], rate: int
) -> None:
    """The ends of a link that turns slowly part by what its turning left before, which is no tear.

    Work is what passes leave of its velocities, 1e-9 m/s, by the impulses of each step.
    """
    states = ran[f"falling {rate}"]
    assert states.step["midpoint_not_converged"].sum() == 0
    found, rows = states.energy()[2:], states.contact
    pulls = np.bincount(rows["step"], abs(rows["impulse_n"]), len(states.step))[2:]
    won = abs(np.diff(found)) / (1e-9 * pulls[1:])
    assert won.max() <= 1.0


@pytest.mark.parametrize("angle", [0.5, 1.5])
def test_pendulum_has_the_period_of_its_amplitude(ran: dict[str, States], angle: float) -> None:
    """T = 4 sqrt((l^2 + 2 r^2/5)/(g l)) K(sin^2(a/2)), of order 2 in the timestep."""
    swung = math.sqrt((1.0 + 0.4 * RADIUS**2) / GRAVITY)
    period, errors = 4.0 * swung * ellipk(math.sin(0.5 * angle) ** 2), []
    for rate in RATES:
        states = ran[f"pendulum {angle} {rate}"]
        x = states.of("bob")[0][:, 0]
        down = np.flatnonzero((x[:-1] > 0.0) & (x[1:] <= 0.0))
        crossed = states.time[down] + x[down] / (x[down] - x[down + 1]) / rate
        errors.append(abs((crossed[-1] - crossed[0]) / (len(crossed) - 1) - period))
    # Of the period (w dt)^2/8 at small angles, w^2 = g; more where it turns faster.
    assert all(
        error <= 0.2 * GRAVITY / rate**2 * period for error, rate in zip(errors, RATES, strict=True)
    )
    assert orders(errors) == pytest.approx([2.0] * 2, abs=0.2)


@pytest.mark.parametrize("rate", RATES)
def test_two_joined_bodies_in_flight_keep_energy_and_both_momenta(
    ran: dict[str, States], rate: int
) -> None:
    states = ran[f"flight {rate}"]
    for name in ("momentum", "angular_momentum"):
        found = vectors(states.step, name)
        # Passes leave 1e-9 m/s of the joint, of up to 2 kg at 0.7 m; they are projected back.
        np.testing.assert_allclose(found, found[:1].repeat(len(found), 0), atol=3e-9)
    found = states.energy()
    np.testing.assert_allclose(found, found[0], atol=3e-9)
    rows = states.contact[states.contact["joint"] == 1]
    assert rows["separation"].max() <= 1e-10


@pytest.mark.parametrize("rate", RATES)
def test_a_joint_that_is_torn_as_it_begins_takes_one_impulse(
    ran: dict[str, States], rate: int
) -> None:
    """p = -K^-1 v: as two surfaces that stay together, it takes v . K^-1 v/2 of the energy."""
    ends = (AT, AT - np.array([0.6, 0.2, 0.1]))
    k = np.zeros((3, 3))
    for arm, mass, radius in zip(ends, MASSES, (0.2, 0.3), strict=True):
        cross = np.array([[0, -arm[2], arm[1]], [arm[2], 0, -arm[0]], [-arm[1], arm[0], 0]])
        k += np.eye(3) / mass - cross @ cross / (0.4 * mass * radius**2)
    taken = 0.5 * OFF @ np.linalg.solve(k, OFF)
    states = ran[f"torn {rate}"]
    found = states.energy()
    # The first step has the impulse of its middle: half a turn of 2 rad/s later.
    assert found[0] - found[1] == pytest.approx(taken, rel=10.0 / rate)
    # And no other throws it back: what a torn joint leaves by its turn is of second order.
    assert np.ptp(found[1:]) <= 1e-2 * taken * (60 / rate)
    pulls = np.linalg.norm(forces(states, 1), axis=1)[1:]
    assert pulls.max() <= 1.5 * pulls.min() or abs(np.diff(pulls)).max() <= 0.2 * pulls.max()


@pytest.mark.parametrize("rate", RATES)
def test_linkage_turns_evenly_though_its_joints_have_rows_too_many(
    ran: dict[str, States], rate: int
) -> None:
    """Sides that stay parallel have an energy that does not depend on where they stand."""
    states = ran[f"linkage {rate}"]
    assert states.step["not_converged"].sum() == 0
    spin = states.of("crank")[2]
    # Passes leave 1e-9 m/s a step, at a lever of half a coupler; at worst 2 rate steps add up.
    left = 1e-9 * 2 * rate / (0.5 * COUPLER)
    np.testing.assert_allclose(spin[:, 1], SPEED, atol=left)
    np.testing.assert_allclose(states.of("rocker")[2], spin, atol=left)
    np.testing.assert_allclose(states.of("coupler")[2], 0.0, atol=left)
    place = states.of("coupler")[0] - [COUPLER / 2, 0, 0]
    np.testing.assert_allclose(np.linalg.norm(place, axis=1), CRANK, atol=left)
    # By the Cayley map it turns by 2 atan(w dt/2) a step.
    turned = len(spin[1:]) * 2.0 * math.atan(0.5 * SPEED / rate)
    assert np.unwrap(np.arctan2(place[:, 0], place[:, 2]))[-1] == pytest.approx(
        turned, abs=2.0 * left
    )


def test_chain_at_rest_has_the_weights_below_in_its_joints(ran: dict[str, States]) -> None:
    for joint in range(1, 11):
        last = forces(ran["chain"], joint)[-1]
        # On the upper of the two bodies of a joint, A, the force is down; on B it is up.
        assert np.linalg.norm(last) == pytest.approx(GRAVITY * (1010.0 - joint), rel=1e-8)


def test_joined_bodies_do_not_touch_each_other(ran: dict[str, States]) -> None:
    contact = ran["chain"].contact
    assert (contact["joint"] > 0).all(), "links of 0.06 m overlap those 0.1 m away"


def test_chain_of_a_hundred_carries_a_thousand_times_a_link() -> None:
    """A broad phase finds its pairs, and leaves out what is joined: a plan of its own."""
    states = run_scenes({"chain": chain(100, 1000.0)})["chain"]
    assert states.step["not_converged"].sum() == 0
    assert (states.contact["joint"] > 0).all()
    for joint in range(1, 101):
        # A residual of 1e-9 m/s of a step's g/240.
        found = np.linalg.norm(forces(states, joint)[-1])
        assert found == pytest.approx(GRAVITY * (1100.0 - joint), rel=1e-9 * 240.0 / GRAVITY)
