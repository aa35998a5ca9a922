"""The engine's arrays for one cell: bodies, velocities, pairs, parameters."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from math import inf, sqrt
from typing import Any, NamedTuple

import numpy as np

from lavendersim.cell import CellBody, CellConfig, CellForce, CellRecord, Numerics
from lavendersim.clock import Clock
from lavendersim.engine.collide.convex.hull_geometry import HullGeometry
from lavendersim.engine.collide.mesh_tables import MeshTables
from lavendersim.engine.effects import effects_of
from lavendersim.engine.engine import Engine
from lavendersim.engine.record_layout import (
    allocate_links,
    allocate_parameters,
    allocate_velocities,
)
from lavendersim.engine.spec import Spec
from lavendersim.quantities.quantity import Vector3
from lavendersim.quantities.scalars import exact

from .body_rows import body_table, fill_periods, pose_of
from .classes import RowClass
from .colliders import colliders
from .drive_tables import drive_tables
from .joints import joined_bodies, with_joint_ends, with_joints
from .pair_tables import pair_tables
from .ropes import with_ends, with_ropes
from .stages import later_forms
from .trigger_table import trigger_table

# Where nothing of a run is to be recorded: a window of steps that is empty.
_NO_STEPS = (1, 0)


class Scene(NamedTuple):
    """The arrays of one scene, as the engine takes them, and the names of its bodies.

    Behind the rows of the bodies stand those of the parts of compounds and of the ends of ropes and
    joints; `names` and `poses` end before them.
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
    meshes: MeshTables | None
    forces: tuple[CellForce, ...]  # `events` lets them act
    links: np.ndarray  # what effects join bodies by
    drives: Any  # functions of time that act on bodies: `memory.Drives`, or ()
    triggers: Any  # states that make events happen, or ()
    numerics: Numerics
    described: Mapping[str, CellBody]  # the bodies as the run begins
    classes: tuple[RowClass, ...]  # of the rows of `templates`

    def engine(self, spec: Spec, block_steps: int | None = None) -> Engine:
        """Return an engine at the scene's initial state."""
        extra: dict[str, int] = {} if block_steps is None else {"block_steps": block_steps}
        return Engine(
            spec,
            self.bodies,
            self.velocities,
            self.pairs,
            self.parameters,
            self.poses,
            templates=self.templates,
            hulls=self.hulls,
            meshes=self.meshes,
            links=self.links,
            drives=self.drives,
            triggers=self.triggers,
            **extra,
        )


def _parameters(config: CellConfig, clock: Clock) -> np.ndarray:
    numerics = config.numerics
    parameters = allocate_parameters()
    p = parameters[0]
    p["gx"], p["gy"], p["gz"] = config.scene.gravity
    for name in _of_numerics(p.dtype):
        value = getattr(numerics, name)
        if value is not None:  # null is written where it means something, below
            p[name] = value
    p["duration"] = config.duration
    if not numerics.warm_start:
        # An engine shared with warm cells: no cosine is this large, so nothing is carried over.
        p["cache_normal_cosine"] = 2.0
    if not numerics.projection_sweeps:
        p["projection"] = 0.0
    if not numerics.sleeping:
        p["sleep_time"] = inf
    set_timestep(parameters, numerics, clock.timestep)
    # A residual is never negative, so this tolerance never stops a cell that has none.
    p["tolerance"] = -1.0 if numerics.tolerance is None else numerics.tolerance
    p["residuals_from"], p["residuals_to"] = residual_window(config.record, clock)
    return parameters


@cache
def _of_numerics(row: np.dtype) -> tuple[str, ...]:
    """Return the parameters that are keys of the numerics."""
    return tuple(name for name in row.names or () if name in Numerics.model_fields)


def set_gravity(parameters: np.ndarray, numerics: Numerics, gravity: Vector3) -> None:
    """Write gravity [m/s^2] and what is made of it into parameters that have their timestep."""
    p = parameters[0]
    p["gx"], p["gy"], p["gz"] = gravity
    _set_restitution_speed(p, numerics)


def set_timestep(parameters: np.ndarray, numerics: Numerics, timestep: Fraction) -> None:
    """Write a timestep [s] and what is made of it into parameters that have their gravity.

    Kernels make the rest of `dt` in each step; cached impulses know the step they belong to.
    """
    p = parameters[0]
    p["dt"] = float(timestep)
    _set_restitution_speed(p, numerics)


def _set_restitution_speed(p: np.void, numerics: Numerics) -> None:
    """Write the approach speed below which nothing rebounds, in multiples of |g| dt."""
    gravity = (float(p[f"g{axis}"]) for axis in "xyz")
    magnitude = sqrt(sum(g * g for g in gravity))  # a power raises where this is infinite
    p["restitution_speed"] = numerics.restitution_threshold * magnitude * p["dt"]


def residual_window(record: CellRecord, clock: Clock) -> tuple[int, int]:
    """Return the first and last step whose sweeps are recorded, by the time a step ends at."""
    window = record.residuals
    if window == "none":
        return _NO_STEPS
    if window == "all":
        return 1, np.iinfo(np.int64).max
    # By the number as written: 0.1 s is a step of 1/10 s, its binary value lies beside it.
    begin, end = exact(window.begin), exact(window.end)
    return max(1, clock.steps_until(begin)), clock.steps_within(end)


def build(config: CellConfig, spec: Spec) -> Scene:
    """Fill the engine's arrays for one cell; `spec` may have effects the cell does not require."""
    described = list(config.scene.bodies.values())
    rows = colliders(described)
    poses = np.array([pose_of(body) for body in described]).reshape(-1, 7)
    bodies, hulls, meshes = body_table(spec, rows, poses)
    fill_periods(bodies, config.scene)
    bodies = with_ends(spec, bodies, config)
    first_joint = len(bodies)
    bodies = with_joint_ends(spec, bodies, config)
    velocities = allocate_velocities(spec, len(bodies))
    turns = "wx" in (velocities.dtype.names or ())
    for velocity, body in zip(velocities, described, strict=False):  # parts have none
        velocity["vx"], velocity["vy"], velocity["vz"] = body.velocity
        if turns:
            velocity["wx"], velocity["wy"], velocity["wz"] = body.angular_velocity
    later = [one for forms in later_forms(config).values() for one in forms]
    tables = pair_tables(spec, rows, bodies, later, joined_bodies(config.scene))
    pairs = with_ropes(spec, tables.pairs, bodies[:first_joint], config.scene)
    clock = config.clock
    return Scene(
        names=list(config.scene.bodies),
        bodies=bodies,
        velocities=velocities,
        pairs=with_joints(spec, pairs, bodies, first_joint, config),
        parameters=_parameters(config, clock),
        poses=poses,
        clock=clock,
        templates=tables.templates,
        hulls=hulls,
        meshes=meshes,
        forces=config.scene.forces,
        links=link_table(config, spec, bodies),
        drives=drive_tables(config, spec, clock),
        triggers=trigger_table(config, spec),
        numerics=config.numerics,
        described=config.scene.bodies,
        classes=tables.classes,
    )


def link_table(config: CellConfig, spec: Spec, bodies: np.ndarray) -> np.ndarray:
    """Return the records of what effects join bodies by; none where no effect does."""
    places = {name: row for row, name in enumerate(config.scene.bodies)}
    joining = [effect.links for effect in effects_of(spec) if effect.links]
    described = [one for links in joining for one in links(config.scene, places)]
    table = allocate_links(spec, len(described))
    for record, one in zip(table, described, strict=True):
        record["active"] = 1
        for name, value in one.items():
            record[name] = value
        bodies["joined"][[one["a"], one["b"]]] = 1
    return table
