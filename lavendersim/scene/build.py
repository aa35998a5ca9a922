"""A resolved config and a spec enter; the engine's arrays leave, filled at this one door."""

from __future__ import annotations

from fractions import Fraction
from math import inf, sqrt
from typing import Any, NamedTuple

import numpy as np

from lavendersim.clock import Clock, written
from lavendersim.engine.collide.convex.hull_geometry import HullGeometry
from lavendersim.engine.engine import Engine
from lavendersim.engine.record_layout import allocate_parameters, allocate_velocities
from lavendersim.engine.spec import Spec

from .body_rows import body_table, pose_of
from .colliders import colliders
from .pair_tables import pair_tables

# Where nothing of a run is to be recorded: a window of steps that is empty.
_NO_STEPS = (1, 0)


class Scene(NamedTuple):
    """The arrays of one scene, as the engine takes them, and the names of its bodies.

    Behind the rows of the bodies stand those of the parts of compounds; `names` and `poses` end
    before them.
    """

    names: list[str]
    bodies: np.ndarray
    velocities: np.ndarray
    pairs: np.ndarray
    parameters: np.ndarray
    poses: np.ndarray  # (bodies, 7) initial x y z qw qx qy qz
    clock: Clock  # exact times of its steps
    templates: np.ndarray  # (classes, classes) what their pairs have in common; see `pair_tables`
    hulls: HullGeometry
    forces: list[dict[str, Any]]  # resolved; `events` lets them act
    numerics: dict[str, Any]  # resolved

    def engine(self, spec: Spec, block_steps: int | None = None) -> Engine:
        """Return an engine at the scene's initial state."""
        extra = {} if block_steps is None else {"block_steps": block_steps}
        return Engine(
            spec,
            self.bodies,
            self.velocities,
            self.pairs,
            self.parameters,
            self.poses,
            self.templates,
            self.hulls,
            **extra,
        )


def _parameters(resolved: dict[str, Any], clock: Clock) -> np.ndarray:
    numerics = resolved["numerics"]
    parameters = allocate_parameters()
    p = parameters[0]
    gravity = [float(g) for g in resolved["scene"]["gravity"]]
    p["gx"], p["gy"], p["gz"] = gravity
    for name in p.dtype.names or ():
        if name in numerics and name not in ("tolerance",):
            p[name] = numerics[name]
    if not numerics["warm_start"]:
        # An engine shared with warm cells: no cosine is this large, so nothing is carried over.
        p["cache_normal_cosine"] = 2.0
    if not numerics["projection_sweeps"]:
        p["projection"] = 0.0
    if not numerics["sleeping"]:
        p["sleep_time"] = inf
    set_timestep(parameters, numerics, clock.timestep)
    # A residual is never negative, so this tolerance never stops a cell that states none.
    p["tolerance"] = -1.0 if numerics["tolerance"] is None else float(numerics["tolerance"])
    p["residuals_from"], p["residuals_to"] = residual_window(resolved, clock)
    return parameters


def set_timestep(parameters: np.ndarray, numerics: dict[str, Any], timestep: Fraction) -> None:
    """Write a timestep [s] and what is made of it into parameters that have their gravity.

    Kernels make the rest of `dt` in each step; cached impulses know the step they belong to.
    """
    p = parameters[0]
    p["dt"] = float(timestep)
    gravity = (float(p[f"g{axis}"]) for axis in "xyz")
    magnitude = sqrt(sum(g * g for g in gravity))  # a power raises where this is infinite
    p["restitution_speed"] = float(numerics["restitution_threshold"]) * magnitude * p["dt"]


def residual_window(resolved: dict[str, Any], clock: Clock) -> tuple[int, int]:
    """Return the first and last step whose sweeps are recorded, by the time a step ends at."""
    asked = resolved["record"]["residuals"]
    if asked == "none":
        return _NO_STEPS
    if asked == "all":
        return 1, np.iinfo(np.int64).max
    # By the number as written: 0.1 s is a step of 1/10 s, its binary value lies beside it.
    begin, end = (written(asked[side]) for side in ("from", "to"))
    return max(1, clock.steps_until(begin)), clock.steps_within(end)


def build(resolved: dict[str, Any], spec: Spec) -> Scene:
    """Fill the engine's arrays for one cell; `spec` may have effects the cell does not call for."""
    config = resolved["scene"]["bodies"]
    rows = colliders(list(config.values()))
    poses = np.array([pose_of(body) for body in config.values()]).reshape(-1, 7)
    bodies, hulls = body_table(spec, rows, poses)
    velocities = allocate_velocities(spec, len(rows))
    turns = "wx" in (velocities.dtype.names or ())
    for velocity, body in zip(velocities, config.values(), strict=False):  # parts have none
        velocity["vx"], velocity["vy"], velocity["vz"] = body["velocity"]
        if turns:
            velocity["wx"], velocity["wy"], velocity["wz"] = body["angular_velocity"]
    pairs, templates = pair_tables(spec, rows, bodies)
    clock = Clock.of(resolved)
    return Scene(
        names=list(config),
        bodies=bodies,
        velocities=velocities,
        pairs=pairs,
        parameters=_parameters(resolved, clock),
        poses=poses,
        clock=clock,
        templates=templates,
        hulls=hulls,
        forces=resolved["scene"]["forces"],
        numerics=resolved["numerics"],
    )
