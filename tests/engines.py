"""Scenes that are run by other engines in tests, and what skips a test without them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from lavendersim.experiment import load_experiment_text
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
