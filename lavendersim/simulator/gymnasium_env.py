"""A Gymnasium environment of one cell: `gymnasium` is imported with this module alone.

```python
env = ContactEnv("cart.yaml", actions={"cart": {"force": 20.0}}, steps_per_action=4)
observation, info = env.reset(seed=0)
observation, reward, terminated, truncated, info = env.step({"cart": {"force": (2.0, 0.0, 0.0)}})
```
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from os import PathLike
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from lavendersim.errors import UsageError
from lavendersim.experiment import Experiment
from lavendersim.simulator.actions import Limits
from lavendersim.simulator.simulator import BODY_CONTACT_COLUMNS, Simulator

Observation = dict[str, np.ndarray]
Judgement = Callable[[Observation, dict[str, Any]], Any]  # of an observation and its info


class ContactEnv(gymnasium.Env[Any, Any]):
    """Bodies in contact, acted on by forces, torques and velocities within declared limits.

    config, cell, actions: those of `Simulator`. steps_per_action: timesteps that an action acts
    over. normalised: actions are shares of their limits, from -1 to 1, as most learners expect
    them; else they have their units. reward: of an observation and its info, 0 without it.
    terminated: whether an episode ends there, beside where a body's state is no longer finite.

    An observation has, a row per body in the config's order, `position` [m], `orientation` (w x y
    z), `velocity` [m/s], `angular_velocity` [rad/s] and `contact`, the sums of
    `BODY_CONTACT_COLUMNS` over the last step; all float64. Contacts one by one are in
    `simulator.step`'s observation, and here in `info["contacts"]`: their number changes.
    """

    def __init__(
        self,
        config: str | PathLike[str] | Mapping[str, Any] | Experiment,
        actions: Limits,
        *,
        cell: int = 0,
        steps_per_action: int = 1,
        normalised: bool = False,
        reward: Judgement | None = None,
        terminated: Judgement | None = None,
    ) -> None:
        if not any(actions.values()):
            raise UsageError("an environment takes actions: declare one, such as ball: {force: 1}")
        if steps_per_action < 1:
            raise UsageError(f"steps_per_action: expected at least 1, got {steps_per_action}")
        self.simulator = Simulator(config, cell, actions)
        self._steps, self._reward, self._ends = steps_per_action, reward, terminated
        self._is_normalised = normalised

        def box(limit: float) -> spaces.Box:
            bound = 1.0 if normalised else limit
            return spaces.Box(-bound, bound, (3,), np.float64)

        self.action_space = spaces.Dict(
            {
                body: spaces.Dict({key: box(limit) for key, limit in one.items()})
                for body, one in self.simulator.actions.items()
            }
        )
        count = len(self.simulator.body_names)
        widths = {"position": 3, "orientation": 4, "velocity": 3, "angular_velocity": 3}
        self.observation_space = spaces.Dict(
            {
                name: spaces.Box(-np.inf, np.inf, (count, width), np.float64)
                for name, width in {**widths, "contact": len(BODY_CONTACT_COLUMNS)}.items()
            }
        )

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Return to the initial state; seed: of `np_random`, of which the simulation draws nothing.

        Raises UsageError for options: there are none.
        """
        super().reset(seed=seed)
        return self._seen(*self.simulator.reset(seed=seed, options=options))

    def step(
        self, action: Mapping[str, Mapping[str, Any]]
    ) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Let an action act for `steps_per_action` timesteps, or to the end of the episode.

        Velocities are set before the first of them. Raises UsageError as `Simulator.step` does.
        """
        given = self._in_units(action) if self._is_normalised else action
        seen, _, diverged, truncated, info = self.simulator.step(given)
        for _ in range(self._steps - 1):
            if diverged or truncated:
                break
            seen, _, diverged, truncated, info = self.simulator.step()
        observation, info = self._seen(seen, info)
        ended = diverged or bool(self._ends and self._ends(observation, info))
        reward = float(self._reward(observation, info)) if self._reward else 0.0
        return observation, reward, ended, truncated, info

    def _in_units(
        self, action: Mapping[str, Mapping[str, Any]]
    ) -> dict[str, dict[str, np.ndarray]]:
        """Return shares of limits times these; a name that has none is left to be refused."""
        limits = self.simulator.actions
        return {
            body: {
                key: np.asarray(share, float) * limits.get(body, {}).get(key, 1.0)
                for key, share in one.items()
            }
            for body, one in action.items()
        }

    def _seen(
        self, seen: dict[str, Any], info: dict[str, Any]
    ) -> tuple[Observation, dict[str, Any]]:
        bodies = {**seen["bodies"], "contact": self.simulator.body_contact_data()}
        return bodies, {**info, "contacts": seen["collision"]["contacts"]}
