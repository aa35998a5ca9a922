"""Cells in a few words, made without a file: bodies with every default filled in."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

from lavendersim.cell import CellBody, CellConfig, Convex
from lavendersim.geometry.vectors import Vector3, dot

ORIGIN = [0.0, 0.0, 0.0]
UPRIGHT = [1.0, 0.0, 0.0, 0.0]
NUMERICS: dict[str, Any] = {
    "timestep": "1/240",
    "solver": "projected_gauss_seidel",
    "sweeps": 22,
    "over_relaxation": 1.0,
    "order": "coloured",
    "tolerance": None,
    "warm_start": True,
    "stabilisation_gain": 0.0,
    "slop": 0.0,
    "projection": 0.0,
    "projection_sweeps": 22,
    "restitution_threshold": 2.0,
    "cache_distance": 0.02,
    "cache_normal_cosine": 0.95,
    "speculative": False,
    "impacts": "captured",
    "integrator": "semi_implicit_euler",
    "compliance_law": "regularised",
    "undetermined_forces": "as_solved",
    "simultaneous_impacts": "together",
    "accuracy": None,
    "smallest_timestep": 1e-9,
    "friction_cone": "disc",
    "sleeping": False,
    "sleep_speed": 0.005,
    "sleep_time": 0.5,
}


def body_data(shape: Mapping[str, Any], **given: Any) -> dict[str, Any]:
    """Return one resolved body as data; 1 kg and unit moments of inertia unless given or fixed."""
    fixed = given.get("fixed", given.get("kinematic", False) or shape["kind"] == "plane")
    body = {
        "shape": dict(shape),
        "fixed": fixed,
        "mass": None if fixed else 1.0,
        "density": None,
        "inertia": None if fixed else [1.0, 1.0, 1.0],
        "surface": {},
        "surface_velocity": ORIGIN,
        "position": ORIGIN,
        "release": None,
        "orientation": UPRIGHT,
        "velocity": ORIGIN,
        "angular_velocity": ORIGIN,
        "drag": {},
    }
    return {**body, **given}


def made_body(shape: Mapping[str, Any], **given: Any) -> CellBody:
    """Return one resolved body."""
    return CellBody.model_validate_json(json.dumps(body_data(shape, **given)))


def made_cell(
    bodies: Mapping[str, Mapping[str, Any]],
    gravity: Any = (0.0, 0.0, -9.81),
    numerics: Mapping[str, Any] | None = None,
    **sections: Any,
) -> CellConfig:
    """Return a cell of bodies, each the data of `body_data` or what is given to it.

    sections: `events`, `duration`, `record`, `effects`, `study` in place of those of a plain cell,
    and `forces`, `connections`, `springs`, `periodic` of its scene.
    """
    names = ("connections", "springs", "periodic")
    own = {name: sections.pop(name) for name in names if name in sections}
    cell = {
        "scene": {
            "gravity": list(gravity),
            "bodies": {name: body_data(**body) for name, body in bodies.items()},
            "forces": sections.pop("forces", []),
            **own,
        },
        "events": [],
        "duration": 1.0,
        "numerics": {**NUMERICS, **(numerics or {})},
        "record": {"residuals": "none", "problems": "none"},
        "effects": {"force": False, "switches": {}},
        "study": {"mistake": "none"},
    }
    return CellConfig.from_dict({**cell, **sections})


class MadeShape(Convex):
    """A tetrahedron of a kind that no view has a form of its own for."""

    kind = "made"

    def corners(self) -> tuple[Vector3, ...]:
        """Return its corners [m]."""
        return (
            (-0.25, -0.25, -0.25),
            (0.75, -0.25, -0.25),
            (-0.25, 0.75, -0.25),
            (-0.25, -0.25, 0.75),
        )

    def bounding_radius(self) -> float:
        """Return the distance of its farthest corner [m]."""
        return max(math.hypot(*corner) for corner in self.corners())

    def thickness(self) -> float:
        """Return its width along each axis [m]."""
        return 1.0

    def extent(self, along: Vector3) -> float:
        """Return the distance of its farthest corner along a direction [m]."""
        return max(dot(corner, along) for corner in self.corners())
