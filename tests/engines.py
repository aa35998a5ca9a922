"""Scenes that are run by other engines in tests, and what skips a test without them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lavendersim.cell import CellBody, CellCompound
from lavendersim.experiment import load_experiment_text
from lavendersim.geometry.bodies import rotation_of
from lavendersim.geometry.rotations import rotation_matrix, unit_quaternion
from lavendersim.geometry.shapes import extent
from lavendersim.peers.catalogue import installed_version
from lavendersim.runner import Finished, run

BALL = """
scene:
  bodies:
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 2, position: [0, 0, 3],
           velocity: [1, 0, 2], angular_velocity: [0, 3, 0]}
numerics: {timestep: 1/100}
duration: 0.5
"""
BOX = """
scene:
  gravity: [4.905, 0, -8.495709211125343]
  surfaces: {rubber: {friction: 0.3}}
  bodies:
    floor: {shape: {kind: plane}, surface: rubber}
    box: {shape: {kind: box, size: [0.4, 0.4, 0.2]}, mass: 2, position: [0, 0, 0.1],
          surface: rubber}
numerics: {timestep: 1/240}
duration: 0.5
"""
SHAPES = {
    "sphere": "{kind: sphere, radius: 0.3}",
    "box": "{kind: box, size: [0.2, 0.4, 0.6]}",
    "capsule": "{kind: capsule, radius: 0.1, length: 0.5}",
    "cylinder": "{kind: cylinder, radius: 0.2, length: 0.3}",
    "ellipsoid": "{kind: ellipsoid, semi_axes: [0.2, 0.4, 0.3]}",
    "hull": "{kind: hull, points: [[0, 0, 0], [0.5, 0, 0], [0, 0.4, 0], [0, 0, 0.9]]}",
    "compound": "{kind: compound, parts: [{shape: {kind: sphere, radius: 0.3}},"
    " {shape: {kind: box, size: [0.2, 0.4, 0.6]}, position: [0.5, 0, 0.1]}]}",
}


def needs(engine: str) -> pytest.MarkDecorator:
    """Skip where an engine is not installed."""
    return pytest.mark.skipif(not installed_version(engine), reason=f"{engine} is not installed")


def run_by(text: str, engine: str, root: Path, *more: str) -> Finished:
    """Run a config by an engine; more: lines of it."""
    config = "\n".join((text, f"engine: {engine}", *more))
    return run(load_experiment_text(config, "scene.yaml"), root)


def log_of(finished: Finished, cell: int = 0) -> Any:
    """Return the log of a cell."""
    return finished.run.cells[cell].trace()


def lowest(body: CellBody) -> float:
    """Return the height of the lowest point of a body, part by part [m]."""
    turn = rotation_of(body)
    parts = [(body.shape, turn, np.zeros(3))]
    if isinstance(body.shape, CellCompound):
        parts = [
            (part.shape, turn @ rotation_matrix(unit_quaternion(part.orientation)), part.position)
            for part in body.shape.parts
        ]
    down = np.array([0.0, 0.0, -1.0])
    return min(
        float(body.position[2] + (turn @ np.asarray(place))[2] - extent(shape, own, down))
        for shape, own, place in parts
    )


# A body turned above the floor; its height is of its centre of mass.
ABOVE = """
scene:
  gravity: [0, 0, 0]
  bodies:
    floor: {{shape: {{kind: plane, normal: [0, 0, 1], offset: 0.25}}}}
    body: {{shape: {shape}, mass: 2, position: [0, 0, {height}], orientation: [1, 0.3, -0.2, 0.5]}}
duration: 1
"""


def placed(shape: str, gap: float) -> Any:
    """Return the cell of a body whose lowest point is so far above the floor [m]."""
    first = load_experiment_text(ABOVE.format(shape=shape, height=1.0), "shape").cells()[0].config
    height = 1.25 + gap - lowest(first.scene.bodies["body"])
    return load_experiment_text(ABOVE.format(shape=shape, height=height), "s").cells()[0].config
