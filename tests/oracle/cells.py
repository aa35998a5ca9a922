"""Cells in a few words: a resolved config with what a test does not say filled in."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from lavendersim.cell import CellConfig
from tests.made_cells import body_data, made_cell

EVENT: dict[str, Any] = {
    "scale_mass": None,
    "teleport": None,
    "velocity": None,
    "angular_velocity": None,
    "contact_cache": "keep",
    "remove": False,
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
    given = {"fixed": "mass" not in entry, "inertia": None, "mass": None} | dict(entry)
    filled = body_data(**given)
    shape = filled["shape"]
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
    events = [
        event if "body" not in event else EVENT | dict(event) for event in said.get("events", ())
    ]
    numerics = {"timestep": "1/100"} | dict(said.get("numerics", {}))
    return made_cell(**scene, numerics=numerics, events=events)
