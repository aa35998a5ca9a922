"""A Gymnasium environment: the library's own check, spaces, episodes, and Newton's second law."""

from __future__ import annotations

import warnings
from fractions import Fraction

import numpy as np
import pytest

from lavendersim.errors import UsageError

pytest.importorskip("gymnasium", reason="gymnasium is not installed")

from gymnasium.utils.env_checker import check_env

from lavendersim.simulator.gymnasium_env import ContactEnv

CART = {
    "scene": {
        "gravity": [0, 0, -10],
        "bodies": {
            "floor": {"shape": {"kind": "plane"}},
            "cart": {
                "shape": {"kind": "sphere", "radius": 0.1},
                "mass": 2.0,
                "position": [0, 0, 0.1],
            },
        },
    },
    "numerics": {"timestep": Fraction(1, 100)},
    "duration": 1,
}
LIMITS = {"cart": {"force": 20.0, "velocity": 3.0}}


def test_the_librarys_own_check_passes() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # what it finds strange it warns of
        warnings.filterwarnings("ignore", message=".*infinity.*")  # positions have no bound
        warnings.filterwarnings("ignore", message=".*normalized space.*")  # forces are in newtons
        warnings.filterwarnings("ignore", message=".*render.*|.*spec.*")  # there is nothing to see
        check_env(ContactEnv(CART, LIMITS), skip_render_check=True)


def test_a_normalised_environment_is_warned_of_by_nothing_about_its_actions() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*infinity.*")  # positions have no bound
        warnings.filterwarnings("ignore", message=".*render.*|.*spec.*")  # there is nothing to see
        check_env(ContactEnv(CART, LIMITS, normalised=True), skip_render_check=True)


def test_normalised_actions_are_shares_of_their_limits() -> None:
    """0.2 of 20 N on 2 kg over 0.01 s: 0.02 m/s, to round-off."""
    env = ContactEnv(CART, LIMITS, normalised=True)
    assert env.action_space["cart"]["force"].high.tolist() == [1.0, 1.0, 1.0]
    env.reset(seed=1)
    observation, *_ = env.step({"cart": {"force": (0.2, 0.0, 0.0)}})
    assert observation["velocity"][1, 0] == pytest.approx(0.02, rel=1e-12)
    with pytest.raises(UsageError, match="force"):
        env.step({"cart": {"force": (1.01, 0.0, 0.0)}})
    with pytest.raises(UsageError, match="card"):
        env.step({"card": {"force": (0.1, 0.0, 0.0)}})


def test_a_force_accelerates_over_every_step_of_its_action() -> None:
    """a = F/m from rest: x = a t^2/2 to round-off, for the force is constant over the steps."""
    env = ContactEnv(CART, LIMITS, steps_per_action=10)
    env.reset(seed=1)
    for _ in range(5):
        observation, reward, ended, truncated, info = env.step({"cart": {"force": (4.0, 0, 0)}})
    assert info["time"] == 0.5
    assert observation["position"][1, 0] == pytest.approx(2.0 * 0.5**2 / 2, rel=1e-12)
    assert observation["velocity"][1] == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)
    assert observation["contact"][1, 1] == pytest.approx(20.0, rel=1e-9)  # its weight [N]
    assert info["contacts"].shape[0] == 1
    assert (reward, ended, truncated) == (0.0, False, False)
    observation, *_ = env.step({"cart": {}})  # no force: it goes on as it is
    assert observation["velocity"][1, 0] == pytest.approx(1.0, rel=1e-12)


def test_reward_and_end_are_the_callers() -> None:
    env = ContactEnv(
        CART,
        LIMITS,
        reward=lambda seen, info: seen["position"][1, 0],
        terminated=lambda seen, info: seen["position"][1, 0] > 0.055,
    )
    env.reset()
    ends = [env.step({"cart": {"velocity": (2.0, 0.0, 0.0)}})[1:3] for _ in range(3)]
    assert [end for _, end in ends] == [False, False, True]
    assert [reward for reward, _ in ends] == pytest.approx([0.02, 0.04, 0.06], rel=1e-12)


def test_an_episode_is_truncated_at_the_duration_within_an_action() -> None:
    env = ContactEnv(CART, LIMITS, steps_per_action=70)
    env.reset()
    assert not env.step({})[3]
    *_, truncated, info = env.step({})
    assert (truncated, info["time"]) == (True, 1.0)


def test_actions_are_drawn_from_the_limits() -> None:
    space = ContactEnv(CART, LIMITS).action_space
    space.seed(3)
    drawn = np.array([space.sample()["cart"]["force"] for _ in range(200)])
    assert 10.0 < np.abs(drawn).max() <= 20.0


@pytest.mark.parametrize("words", [{"actions": {}}, {"actions": LIMITS, "steps_per_action": 0}])
def test_what_cannot_be_is_refused(words: dict) -> None:
    with pytest.raises(UsageError):
        ContactEnv(CART, **words)
