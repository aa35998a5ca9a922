"""A resolved config and a spec enter; the engine's arrays leave, filled at this one door."""

from __future__ import annotations

from fractions import Fraction
from math import ceil, sqrt
from typing import Any, NamedTuple

import numpy as np

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.engine import (
    Engine,
    allocate_bodies,
    allocate_pairs,
    allocate_parameters,
    allocate_velocities,
)
from lavendersim.engine.records import BOX, PLANE, SPHERE
from lavendersim.engine.spec import Spec

from .mass_properties import bounding_radius, mass_properties
from .plan import candidate_pairs, is_movable

_SHAPES = {"plane": PLANE, "sphere": SPHERE, "box": BOX}
# Where nothing of a run is to be recorded: a window of steps that is empty.
_NO_STEPS = (1, 0)


class Scene(NamedTuple):
    """The arrays of one scene, as the engine takes them, and the names of its bodies."""

    names: list[str]
    bodies: np.ndarray
    velocities: np.ndarray
    pairs: np.ndarray
    parameters: np.ndarray
    poses: np.ndarray  # (bodies, 7) initial x y z qw qx qy qz
    timestep: Fraction  # [s], exact

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
            **extra,
        )


def rotation_matrix(q: np.ndarray) -> np.ndarray:
    """Return the (3, 3) body-to-world matrix of a unit quaternion w x y z."""
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _fill_shape(row: np.void, shape: dict[str, Any]) -> None:
    row["shape"] = _SHAPES[shape["kind"]]
    if shape["kind"] == "plane":
        normal = np.asarray(shape["normal"], float)
        row["hx"], row["hy"], row["hz"] = normal / np.linalg.norm(normal)
        row["offset"] = float(shape["offset"])
    elif shape["kind"] == "sphere":
        row["hx"] = float(shape["radius"])
    else:
        row["hx"], row["hy"], row["hz"] = (0.5 * float(edge) for edge in shape["size"])
    row["bound"] = bounding_radius(shape)


def _fill_mass(row: np.void, body: dict[str, Any], turns: bool) -> None:
    if not is_movable(body):
        return
    properties = mass_properties(body["shape"], body["mass"])
    row["inv_m"] = 1.0 / properties.mass
    if turns:
        for axis, inertia in zip("xyz", properties.inertia, strict=True):
            row[f"inv_i{axis}"] = 1.0 / inertia


def _parameters(resolved: dict[str, Any], timestep: Fraction) -> np.ndarray:
    numerics = resolved["numerics"]
    dt = float(timestep)
    parameters = allocate_parameters()
    p = parameters[0]
    p["dt"] = dt
    gravity = [float(g) for g in resolved["scene"]["gravity"]]
    p["gx"], p["gy"], p["gz"] = gravity
    for name in (
        "stabilisation_gain",
        "slop",
        "projection",
        "cache_distance",
        "cache_normal_cosine",
    ):
        p[name] = float(numerics[name])
    if not numerics["warm_start"]:
        # An engine shared with warm cells: no cosine is this large, so nothing is carried over.
        p["cache_normal_cosine"] = 2.0
    if not numerics["projection_sweeps"]:
        p["projection"] = 0.0
    magnitude = sqrt(sum(g * g for g in gravity))
    p["restitution_speed"] = float(numerics["restitution_threshold"]) * magnitude * dt
    # A residual is never negative, so this tolerance never stops a cell that states none.
    p["tolerance"] = -1.0 if numerics["tolerance"] is None else float(numerics["tolerance"])
    p["sweeps"] = numerics["sweeps"]
    p["projection_sweeps"] = numerics["projection_sweeps"]
    p["residuals_from"], p["residuals_to"] = residual_window(resolved, timestep)
    return parameters


def residual_window(resolved: dict[str, Any], timestep: Fraction) -> tuple[int, int]:
    """Return the first and last step whose sweeps are recorded, by the time a step ends at."""
    asked = resolved["record"]["residuals"]
    if asked == "none":
        return _NO_STEPS
    if asked == "all":
        return 1, np.iinfo(np.int64).max
    # By the number as written: 0.1 s is a step of 1/10 s, its binary value lies beside it.
    begin, end = (Fraction(repr(float(asked[side]))) for side in ("from", "to"))
    return max(1, ceil(begin / timestep)), int(end / timestep)


def build(resolved: dict[str, Any], spec: Spec) -> Scene:
    """Fill the engine's arrays for one cell; `spec` may have effects the cell does not call for."""
    config = resolved["scene"]["bodies"]
    names, described = list(config), list(config.values())
    turns = spec.has("rotation")
    bodies = allocate_bodies(spec, len(names))
    velocities = allocate_velocities(spec, len(names))
    poses = np.zeros((len(names), 7))
    poses[:, 3] = 1.0
    oriented = "qw" in (bodies.dtype.names or ())
    for row, velocity, pose, body in zip(bodies, velocities, poses, described, strict=True):
        _fill_shape(row, body["shape"])
        _fill_mass(row, body, turns)
        if body["shape"]["kind"] != "plane":
            pose[:3] = body["position"]
            pose[3:] = np.asarray(body["orientation"], float)
            pose[3:] /= np.linalg.norm(pose[3:])
            row["x"], row["y"], row["z"] = pose[:3]
        velocity["vx"], velocity["vy"], velocity["vz"] = body["velocity"]
        if turns:
            velocity["wx"], velocity["wy"], velocity["wz"] = body["angular_velocity"]
        if oriented:
            row["qw"], row["qx"], row["qy"], row["qz"] = pose[3:]
            matrix = rotation_matrix(pose[3:])
            for i in range(3):
                for j in range(3):
                    row[f"r{i}{j}"] = matrix[i, j]
    candidates = candidate_pairs(described)
    pairs = allocate_pairs(spec, len(candidates))
    for row, pair in zip(pairs, candidates, strict=True):
        row["a"], row["b"] = pair.a, pair.b
        row["kind"] = SHAPE_PAIRS[pair.shape_pair][0]
        for surface_property in ("restitution", "compliance"):
            if spec.has(surface_property):
                row[surface_property] = getattr(pair, surface_property)
    timestep = Fraction(resolved["numerics"]["timestep"])
    return Scene(names, bodies, velocities, pairs, _parameters(resolved, timestep), poses, timestep)
