"""Forces, torques and velocities from Python, within limits that the plan knows."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim import Simulator, load_experiment
from lavendersim.errors import UsageError
from lavendersim.scene.plan import plan_of
from lavendersim.simulator.actions import with_limits

BOX = {
    "scene": {
        "gravity": [0, 0, 0],
        "bodies": {
            "wall": {"shape": {"kind": "plane"}},
            "box": {
                "shape": {"kind": "box", "size": [0.1, 0.2, 0.3]},
                "mass": 2.0,
                "position": [0, 0, 1],
            },
        },
        "forces": [{"body": "box", "from": 0.0, "to": 0.25, "force": [0, 6, 0]}],
    },
    "numerics": {"timestep": "1/200"},
    "duration": 1,
}
LIMITS = {"box": {"force": 10.0, "torque": 1.0, "velocity": 2.0, "angular_velocity": 50.0}}
# Of a box of 2 kg about its x: m (b^2 + c^2) / 12.
INERTIA = 2.0 * (0.2**2 + 0.3**2) / 12


def box_of(observation: dict, name: str) -> np.ndarray:
    return observation["bodies"][name][1]


def test_a_force_acts_beside_those_of_the_config_and_ends_with_its_action() -> None:
    """Newton: 4 N along x for 0.25 s, the config's 6 N along y for as long; then none."""
    sim = Simulator(BOX, actions=LIMITS)
    for _ in range(50):
        observation, *_ = sim.step({"box": {"force": [4, 0, 0]}})
    assert box_of(observation, "velocity") == pytest.approx([0.5, 0.75, 0.0], rel=1e-12)
    for _ in range(10):
        observation, *_ = sim.step({})
    assert box_of(observation, "velocity") == pytest.approx([0.5, 0.75, 0.0], rel=1e-12)


def test_without_an_action_the_last_one_goes_on() -> None:
    sim = Simulator(BOX, actions=LIMITS)
    sim.step({"box": {"force": [4, 0, 0]}})
    for _ in range(9):
        observation, *_ = sim.step()
    assert box_of(observation, "velocity")[0] == pytest.approx(2.0 * 10 / 200, rel=1e-12)


def test_a_torque_about_a_principal_axis_turns_as_euler_says() -> None:
    sim = Simulator(BOX, actions=LIMITS)
    for _ in range(20):
        observation, *_ = sim.step({"box": {"torque": [0.5, 0, 0]}})
    # Along one axis the gyroscopic term is 0: omega = T t / I.
    spin = 0.5 * 0.1 / INERTIA
    assert box_of(observation, "angular_velocity") == pytest.approx([spin, 0, 0], rel=1e-9)


def test_velocities_are_set_before_the_step() -> None:
    sim = Simulator(BOX, actions=LIMITS)
    for _ in range(50):  # until the config's force has ended
        sim.step()
    start = box_of(sim.step({"box": {"velocity": [1, 0, 0]}})[0], "position")
    observation, *_ = sim.step({"box": {"velocity": [-1, 0, 0], "angular_velocity": [7, 0, 0]}})
    assert box_of(observation, "position")[0] == pytest.approx(start[0] - 1 / 200, rel=1e-9)
    assert box_of(observation, "angular_velocity") == pytest.approx([7, 0, 0], rel=1e-9)


def test_the_plan_has_what_the_limits_require_and_nothing_else() -> None:
    def plan(**inputs: float) -> set[str]:
        target = {
            "shape": {"kind": "box", "size": [0.1, 0.1, 0.1]},
            "position": [5, 0, 1],
            "fixed": True,
        }
        bodies = {**BOX["scene"]["bodies"], "target": target}
        scene = {"gravity": [0, 0, 0], "bodies": bodies}
        (cell,) = load_experiment({**BOX, "scene": scene}).cells()
        config = with_limits(cell.config, {"box": inputs}) if inputs else cell.config
        return {*plan_of(config).spec.effects}

    bare = plan()
    assert "external_force" not in bare
    assert "external_force" in plan(force=1.0) & plan(torque=1.0)
    assert "external_force" not in plan(velocity=1.0)
    # Nothing bounds what pushes give, so bodies may come to close in fast.
    assert ("fast_bodies" in bare, "fast_bodies" in plan(velocity=1.0)) == (False, True)


def test_a_sleeping_body_wakes_when_it_is_pushed() -> None:
    bodies = {
        "floor": {"shape": {"kind": "plane"}},
        "ball": {"shape": {"kind": "sphere", "radius": 0.1}, "mass": 2, "position": [0, 0, 0.1]},
    }
    config = {
        "scene": {"bodies": bodies},
        "numerics": {"timestep": "1/100", "sleeping": True},
        "duration": 9,
    }
    sim = Simulator(config, actions={"ball": {"force": 10.0}})
    for _ in range(300):
        sim.step({})
    observation, *_ = sim.step({"ball": {"force": [4, 0, 0]}})
    assert observation["bodies"]["velocity"][1, 0] == pytest.approx(0.02, rel=1e-9)


def test_a_reset_forgets_what_was_pushed() -> None:
    sim = Simulator(BOX, actions=LIMITS)
    sim.step({"box": {"force": [4, 0, 0]}})
    sim.reset()
    observation, *_ = sim.step()
    assert box_of(observation, "velocity")[0] == 0.0


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        ({"bax": {"force": 1.0}}, 'no body is called "bax"; did you mean "box"?'),
        ({"wall": {"force": 1.0}}, "wall does not move by forces"),
        ({"box": {"forces": 1.0}}, 'no "forces"; did you mean "force"?'),
        ({"box": {"force": 0.0}}, "box.force: expected a limit above 0"),
        ({"box": {"force": float("inf")}}, "expected a limit above 0"),
    ],
)
def test_limits_that_cannot_be_are_refused(limits: dict, message: str) -> None:
    with pytest.raises(UsageError) as caught:
        Simulator(BOX, actions=limits)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("action", "message"),
    [
        ({"bax": {}}, '"bax" takes none; did you mean "box"?'),
        ({"box": {"torque": [1, 0, 0]}}, "box.torque: it is not among the actions"),
        ({"box": {"force": [11, 0, 0]}}, "three numbers of at most 10 N"),
        ({"box": {"force": [float("nan"), 0, 0]}}, "three numbers of at most 10 N"),
        ({"box": {"force": 3.0}}, "three numbers of at most 10 N"),
        (3.0, "expected a mapping by body"),
    ],
)
def test_actions_beyond_what_was_declared_are_refused(action: dict, message: str) -> None:
    sim = Simulator(BOX, actions={"box": {k: v for k, v in LIMITS["box"].items() if k != "torque"}})
    before = sim.steps_done
    with pytest.raises(UsageError) as caught:
        sim.step(action)
    assert message in str(caught.value)
    assert sim.steps_done == before
