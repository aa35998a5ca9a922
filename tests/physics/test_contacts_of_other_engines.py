"""What engines report of contacts, by hand: impulses on a body are what its momentum changed by.

The sign convention is lavender's: a normal points from A to B, impulses are those on B.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any, NamedTuple

import numpy as np
import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.geometry.rotations import rotation_matrices
from lavendersim.peers.catalogue import PEERS, peer_of
from lavendersim.peers.declaration import TANGENTIAL
from lavendersim.peers.description import Scene
from tests.engines import needs

TELLING = [
    pytest.param(variant, marks=needs(name))
    for name, peer in PEERS.items()
    for variant in peer.variants
    if "impulse_n" in peer.reports(variant)
]
DT, STEPS = 1.0 / 240.0, 40
ONE_POINT = ("drake", "drake-sap", "drake-stiff")  # of a pair of bodies: a box on a face tilts
CREEP = {"mujoco-discrete": 0.05}  # [m/s] it chatters: no push in one step, twice in the next
# The upper box comes before the floor, the lower one after it: who is A differs from pair to pair.
# Gravity leans, so that friction is due; the boxes slide off where there is none.
STACK = """
scene:
  gravity: [{along}, {across}, -10]
  surfaces: {{s: {{friction: {friction}}}}}
  bodies:
    upper: {{shape: {{kind: box, size: [0.4, 0.4, 0.2]}}, mass: 3, surface: s,
            position: [0, 0, 0.3], velocity: [{speed}, 0, 0]}}
    floor: {{shape: {{kind: plane}}, surface: s}}
    lower: {{shape: {{kind: box, size: [0.4, 0.4, 0.2]}}, mass: 2, surface: s,
            position: [0, 0, 0.1]}}
numerics: {{timestep: 1/240}}
duration: 1
engine: {engine}
"""


class Step(NamedTuple):
    """What a step did to each body, and what its contacts say they did."""

    linear: np.ndarray  # (bodies, 3) change of momentum beside gravity's [N s]
    turning: np.ndarray  # (bodies, 3) change of angular momentum about the centre [N m s]
    pushed: np.ndarray  # (bodies, 3) sum of impulses
    twisted: np.ndarray  # (bodies, 3) sum of their moments about the centre at the step's start
    least: float  # of the normal impulses: contacts push [N s]


def steps_of(engine: str, **values: float) -> list[Step]:
    given = {"along": 0.0, "across": 0.0, "friction": 0.5, "speed": 0.0} | values
    config = load_experiment_text(STACK.format(engine=engine, **given), "s.yaml").cells()[0].config
    scene = Scene(config)
    made: Any = import_module(f"lavendersim.peers.adapters.{peer_of(engine).name}")
    assert config.engine is not None
    world = made.World(scene, dict(config.engine.settings))
    mass = np.array([body.mass for body in scene.movable])[:, None]
    inertia = np.array([body.inertia for body in scene.movable])
    rows = {body.row: k for k, body in enumerate(scene.movable)}
    found = []
    for _ in range(STEPS):
        before = world.poses(), world.velocities()
        world.step()
        after = world.poses(), world.velocities()
        linear = mass * (after[1][:, :3] - before[1][:, :3] - DT * np.array(scene.gravity))
        turning = spin_of(*after, inertia) - spin_of(*before, inertia)
        pushed, twisted, least = np.zeros_like(linear), np.zeros_like(linear), 0.0
        for a, b, *reported in world.contacts():
            impulse, least = reported[7] * np.array(reported[3:6]), min(least, reported[7])
            if TANGENTIAL[0] in peer_of(engine).reports(engine):
                impulse = impulse + reported[8:11]
            for body, sign in ((a, -1.0), (b, 1.0)):
                if body in rows:
                    pushed[rows[body]] += sign * impulse
                    lever = np.array(reported[:3]) - before[0][rows[body], :3]
                    twisted[rows[body]] += np.cross(lever, sign * impulse)
        found.append(Step(linear, turning, pushed, twisted, least))
    return found


def spin_of(poses: np.ndarray, velocities: np.ndarray, inertia: np.ndarray) -> np.ndarray:
    """Return R I R^T w of each body [N m s]."""
    turn = rotation_matrices(poses[:, 3:])
    local = np.einsum("bji,bj->bi", turn, velocities[:, 3:])
    return np.asarray(np.einsum("bij,bj->bi", turn, local * inertia))


# Relative to the momenta of a step. Round-off of 53 and of 24 bits through a hundred sums; but some
# solvers stop before that (Drake's at 1e-5 of its terms), and report impulses of another iterate
# than the velocities they leave.
ROUNDING = {True: 1e-9, False: 1e-4}
STOPPED_EARLY = {"mujoco-cg": 1e-3, "mujoco-discrete": 1e-4, **dict.fromkeys(ONE_POINT, 1e-5)}


def rounding(engine: str) -> float:
    """Return what sums of a step's impulses are off by [N s]: of 50 N for 1/240 s, 0.2 N s."""
    return 0.2 * STOPPED_EARLY.get(engine, ROUNDING[peer_of(engine).double])


@pytest.mark.parametrize("engine", TELLING)
def test_impulses_of_a_step_are_the_change_of_momentum_of_each_body(engine: str) -> None:
    """Where friction is not reported, without it."""
    reported = TANGENTIAL[0] in peer_of(engine).reports(engine)
    friction = {"friction": 0.5, "along": 2.0, "across": 1.0} if reported else {"friction": 0.0}
    for step in steps_of(engine, **friction):
        np.testing.assert_allclose(step.pushed, step.linear, atol=rounding(engine))
        assert step.least >= -rounding(engine)


@pytest.mark.parametrize("engine", [one for one in TELLING if one.values[0] not in ONE_POINT])
def test_a_stack_at_rest_is_held_by_its_weight_without_a_moment(engine: str) -> None:
    """Upper: 3 kg, 30 N up. Lower: 20 N in sum, 50 N from the floor. Of the last 20 steps the mean:
    a box that creeps or chatters at v gains m v in them, and 5 mm/s of 5 kg over 20 steps are 0.6 %
    of a step's weight; levers of 0.2 m.
    """
    last = steps_of(engine)[-20:]
    weight = np.array([[0.0, 0.0, 30.0], [0.0, 0.0, 20.0]]) * DT
    unsteady = 5.0 * CREEP.get(engine, 0.005) / len(last)
    pushed = np.mean([step.pushed for step in last], axis=0)
    np.testing.assert_allclose(pushed, weight, atol=unsteady)
    twisted = np.mean([step.twisted for step in last], axis=0)
    np.testing.assert_allclose(twisted, 0.0, atol=0.2 * unsteady)


@pytest.mark.parametrize("engine", TELLING)
def test_moments_of_impulses_are_the_change_of_spin(engine: str) -> None:
    """Held by friction on a slant, where friction is reported: the load leans, the boxes stay."""
    reported = TANGENTIAL[0] in peer_of(engine).reports(engine)
    steps = steps_of(engine, **({"along": 2.0, "across": 1.0} if reported else {}))
    for step in steps[-10:]:
        # points and levers of the step's start or end: they part by the millimetre that a soft
        # contact moves in a step at most, of 50 N for 1/240 s
        np.testing.assert_allclose(step.twisted, step.turning, atol=50.0 * DT * 1e-3)


COUNTING = [
    pytest.param(variant, marks=needs(name))
    for name, peer in PEERS.items()
    for variant in peer.variants
    if peer.counted
]


@pytest.mark.parametrize("engine", COUNTING)
def test_iterations_are_counted_from_the_first_step_on_and_change_nothing(engine: str) -> None:
    """Of two worlds, one asked for its iterations and one not, states are the same bits. No step of
    a stack in contact is solved without an iteration, nor by more than its engine may take.
    """
    given = {"along": 0.0, "across": 0.0, "friction": 0.5, "speed": 0.0}
    config = load_experiment_text(STACK.format(engine=engine, **given), "s.yaml").cells()[0].config
    assert config.engine is not None
    made: Any = import_module(f"lavendersim.peers.adapters.{peer_of(engine).name}")
    settings = dict(config.engine.settings)
    asked, alone = (made.World(Scene(config), settings) for _ in range(2))
    assert asked.iterations() == 0
    counts = []
    for _ in range(STEPS):
        asked.step()
        alone.step()
        counts.append(asked.iterations())
    most = int(settings.get("iterations", 100))  # Bullet's own is 50, MuJoCo's 100
    assert max(counts) <= most
    assert min(counts[5:]) >= (0 if engine == "mujoco-discrete" else 1)  # that one chatters
    np.testing.assert_array_equal(asked.poses(), alone.poses())
    np.testing.assert_array_equal(asked.velocities(), alone.velocities())
