"""A simulation that is stepped from Python, with Gymnasium's conventions.

```python
sim = Simulator("configs/chapter/impact_telemetry.yaml")
observation, info = sim.reset(seed=0)
observation, reward, terminated, truncated, info = sim.step()
contacts = observation["collision"]["contacts"]
normal_force = sim.body_contact_data()[sim.body_id("ball"), 1]
```
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from os import PathLike
from typing import Any, Final

import numpy as np

from lavendersim.engine.effects import rows_of_surfaces
from lavendersim.engine.engine import Engine, Rows
from lavendersim.engine.records import DIVERGED
from lavendersim.errors import UsageError
from lavendersim.experiment import Experiment, load_experiment
from lavendersim.quantities.found import nearest, quoted
from lavendersim.scene.build import Scene, build
from lavendersim.scene.events import EventQueue
from lavendersim.scene.plan import Plan, plan_of_cell
from lavendersim.simulator.actions import Limits, checked_limits, pushes, with_limits

Observation = dict[str, Any]

# Columns of observation["collision"]["contacts"], float64, one row per contact of the last step.
CONTACT_COLUMNS: Final = (
    "body_a",
    "body_b",
    "x",  # contact point at the start of the step [m]
    "y",
    "z",
    "nx",  # unit normal from body a to body b
    "ny",
    "nz",
    "penetration",  # at the start of the step [m]
    "impulse_n",  # normal impulse on body b [N s]
    "force_n",  # impulse / timestep [N]
    "approach_velocity",  # normal velocity before the solve [m/s]
    "normal_velocity",  # and after it [m/s]
    "residual",  # natural-map residual of the row [m/s]
)
# Columns of body_contact_data(), one row per body.
BODY_CONTACT_COLUMNS: Final = (
    "contacts",  # number of contacts of the body in the last step
    "normal_force",  # sum of their normal forces [N]
    "normal_impulse",  # and impulses [N s]
    "max_penetration",  # [m]
)


class Simulator:
    """One cell of an experiment, advanced a timestep per `step()`.

    config: path of a YAML experiment, its text, a mapping, or an Experiment. cell: which cell of
    its sweep. actions: what `step` may be given, by body the limit of the components of its
    `force` [N], `torque` [N m], `velocity` [m/s] and `angular_velocity` [rad/s]; the plan has what
    a scene requires in which they are reached.
    Raises ConfigError or UsageError where the config, the cell or an action is wrong.
    """

    def __init__(
        self,
        config: str | PathLike[str] | Mapping[str, Any] | Experiment,
        cell: int = 0,
        actions: Limits | None = None,
    ) -> None:
        experiment = config if isinstance(config, Experiment) else load_experiment(config)
        cells = experiment.cells()
        if not 0 <= cell < len(cells):
            raise UsageError(
                f"{experiment.name} has cells 0 to {len(cells) - 1}; there is no cell {cell}"
            )
        self.experiment = experiment
        self._config = cells[cell].config
        self._last_step = self._config.steps
        self.actions = checked_limits(self._config, actions or {})
        planned = cells[cell]
        if self.actions:
            planned = copy(planned)
            planned.keep(with_limits(self._config, self.actions))
        self.plan: Plan = plan_of_cell(planned)
        self.np_random = np.random.default_rng()
        self.reset()

    @property
    def timestep(self) -> float:
        """Length of the last step [s]; before the first, that of the first."""
        return float(self._scene.clock.length(self.steps_done))

    @property
    def body_names(self) -> list[str]:
        """Names of the bodies; a body's id is its place in this list."""
        return list(self._scene.names)

    def body_id(self, name: str) -> int:
        """Return the id of a named body; raises UsageError with the nearest name."""
        if name not in self._scene.names:
            raise UsageError(f"no body is called {quoted(name)}{nearest(name, self._scene.names)}")
        return self._scene.names.index(name)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Return to the initial state; gives (observation, info).

        seed: seeds `np_random`, for callers that draw from it; the simulation itself draws nothing.
        options: none are known; anything but None or an empty dict raises UsageError.
        """
        if options:
            raise UsageError(f"reset knows no options, found {', '.join(map(str, options))}")
        if seed is not None:
            self.np_random = np.random.default_rng(seed)
        self._scene: Scene = build(self._config, self.plan.spec)
        self._engine: Engine = self._scene.engine(self.plan.spec, block_steps=1)
        config = self._config
        self._events = EventQueue(self._engine, self._scene, config.events, config.triggered)
        self._engine.advance(0)
        self._rows: Rows = self._engine.take_rows()
        self._terminated = False
        return self._observation(), self._info()

    def step(
        self, action: Mapping[str, Mapping[str, Any]] | None = None
    ) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Advance one timestep: (observation, reward, terminated, truncated, info).

        action: by body, three components of each input, as `{"cart": {"force": (2.0, 0.0, 0.0)}}`.
        Forces and torques act on the centre of mass, in world axes, over this step; those that are
        not named are 0; without an action those of the last one go on. Velocities are set before
        the step.
        reward is 0. terminated: a body's state is no longer finite. truncated: the duration of the
        config is over. Raises UsageError for an action that was not declared or is beyond its
        limit, and after termination, until `reset`.
        """
        if self._terminated:
            raise UsageError("the simulation has diverged: call reset() before step()")
        if action is not None:
            self._act(action)
        self._events.apply_due(self.steps_done)
        status = self._engine.advance(1)
        self._rows = self._engine.take_rows()
        self._terminated = status == DIVERGED
        truncated = self.steps_done >= self._last_step
        return self._observation(), 0.0, self._terminated, truncated, self._info()

    def _act(self, action: Mapping[str, Mapping[str, Any]]) -> None:
        for one in pushes(action, self.actions):
            if one.force is not None and one.torque is not None:
                self._events.push(one.body, one.force, one.torque)
            if one.velocity is not None or one.angular_velocity is not None:
                self._events.set_velocity(one.body, one.velocity, one.angular_velocity)

    @property
    def steps_done(self) -> int:
        """Steps since the last reset."""
        return int(self._engine.counters["step"][0])

    def body_contact_data(self) -> np.ndarray:
        """Return contact sums of the last step, float64 (bodies, 4), see BODY_CONTACT_COLUMNS."""
        data = np.zeros((len(self._scene.names), len(BODY_CONTACT_COLUMNS)))
        contact = rows_of_surfaces(self._rows.contact)
        for side in ("body_a", "body_b"):
            np.add.at(data[:, 0], contact[side], 1.0)
            np.add.at(data[:, 1], contact[side], contact["force_n"])
            np.add.at(data[:, 2], contact[side], contact["impulse_n"])
            np.maximum.at(data[:, 3], contact[side], contact["penetration"])
        return data

    def close(self) -> None:
        """Do nothing; present because Gymnasium's loops call it."""

    def _observation(self) -> Observation:
        contact = self._rows.contact
        columns = [contact[name].astype(np.float64) for name in CONTACT_COLUMNS]
        # Behind the bodies stand the parts of compounds, which move with their bodies.
        velocities = self._engine.velocities[: len(self._scene.names)]
        turning = "wx" in (velocities.dtype.names or ())
        count = len(velocities)
        pose = self._rows.pose[-1]
        return {
            "collision": {"contacts": np.column_stack(columns)},
            "bodies": {
                "position": pose[:, :3].copy(),  # centre of mass [m]
                "orientation": pose[:, 3:7].copy(),  # quaternion w x y z, body to world
                "velocity": np.column_stack([velocities[n] for n in ("vx", "vy", "vz")]),
                "angular_velocity": np.column_stack([velocities[n] for n in ("wx", "wy", "wz")])
                if turning
                else np.zeros((count, 3)),
            },
        }

    def _info(self) -> dict[str, Any]:
        row = self._rows.step[-1]
        info: dict[str, Any] = {name: row[name].item() for name in row.dtype.names}
        info["time"] = float(self._scene.clock.time(self.steps_done))
        return info
