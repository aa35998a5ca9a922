"""Cells in a few words: a resolved config with what a test does not say filled in."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from lavendersim.cell import CellConfig

BODY: dict[str, Any] = {
    "fixed": False,
    "kinematic": False,
    "mass": None,
    "density": None,
    "inertia": None,
    "surface": {},
    "surface_velocity": [0.0, 0.0, 0.0],
    "position": [0.0, 0.0, 0.0],
    "release": None,
    "orientation": [1.0, 0.0, 0.0, 0.0],
    "velocity": [0.0, 0.0, 0.0],
    "angular_velocity": [0.0, 0.0, 0.0],
    "drag": {},
}
EVENT: dict[str, Any] = {
    "scale_mass": None,
    "teleport": None,
    "velocity": None,
    "angular_velocity": None,
    "contact_cache": "keep",
    "remove": False,
}
NUMERICS: dict[str, Any] = {
    "timestep": "1/100",
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
    "friction_cone": "disc",
    "sleeping": False,
    "sleep_speed": 0.005,
    "sleep_time": 0.5,
}


def inertia(shape: Mapping[str, Any], mass: float) -> list[float]:
    """Moments of a homogeneous box, ball or cylinder (m^2 kg); of others those of a ball of 1 m."""
    if shape["kind"] == "box":
        x, y, z = (edge**2 for edge in shape["size"])
        return [mass / 12.0 * both for both in (y + z, x + z, x + y)]
    square = shape.get("radius", 1.0) ** 2
    if shape["kind"] == "cylinder":
        across = mass * (square / 4.0 + shape["length"] ** 2 / 12.0)
        return [across, across, 0.5 * mass * square]
    return [0.4 * mass * square] * 3


def body(entry: Mapping[str, Any]) -> dict[str, Any]:
    """Return one body; a plane, and a body without a mass, is fixed."""
    filled = BODY | {"fixed": "mass" not in entry} | dict(entry)
    shape = filled["shape"] = dict(filled["shape"])
    if shape["kind"] in ("hull", "compound"):
        shape |= {"centre": [0.0, 0.0, 0.0], "axes": [1.0, 0.0, 0.0, 0.0]} | shape
    if shape["kind"] == "hull":
        shape.setdefault("faces", [])
    for part in shape.get("parts", ()):
        part["shape"] = body({"shape": part["shape"]})["shape"]
    if shape["kind"] == "plane":
        filled["fixed"] = True
    elif filled["inertia"] is None and filled["mass"] is not None:
        filled["inertia"] = inertia(shape, filled["mass"])
    return filled


def cell(said: Mapping[str, Any]) -> CellConfig:
    """Return the cell of a config that says little more than `scene: {bodies: ...}`."""
    scene = {"gravity": [0.0, 0.0, -9.81], "forces": []} | dict(said["scene"])
    scene["bodies"] = {name: body(entry) for name, entry in scene["bodies"].items()}
    scene["forces"] = [{"from": 0.0, "to": math.inf} | dict(force) for force in scene["forces"]]
    return CellConfig.from_dict(
        {
            "scene": scene,
            "events": [
                event if "timestep" in event else EVENT | dict(event)
                for event in said.get("events", ())
            ],
            "duration": 1.0,
            "numerics": NUMERICS | dict(said.get("numerics", {})),
            "record": {"residuals": "all", "problems": "none"},
            "effects": {"force": False, "switches": {}},
            "study": {"mistake": "none"},
        }
    )
