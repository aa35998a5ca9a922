"""Axes that vary nothing but how bodies start, and cells that differ in that alone."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.cell import alike
from lavendersim.experiment.sweeps.starts import _is_of_start

BALL = ("scene", "bodies", "ball")


@pytest.mark.parametrize(
    ("path", "start"),
    [
        ((*BALL, "position"), True),
        ((*BALL, "position", 2), True),
        ((*BALL, "velocity", 0), True),
        ((*BALL, "release", "phase"), True),
        ((*BALL, "release", "clearance"), True),
        ((*BALL, "release", "above"), False),
        ((*BALL, "angular_velocity", 0), False),  # what turns has another plan
        ((*BALL, "mass"), False),
        (("scene", "gravity"), False),
    ],
)
def test_paths_that_say_how_a_body_starts(path: tuple[str | int, ...], start: bool) -> None:
    assert _is_of_start(path) is start


SWEPT = """
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1]}
duration: 0.1
sweep:
  height: {path: scene.bodies.ball.position.2, values: [1, 2, 3]}
  mass: {path: scene.bodies.ball.mass, values: [1, 2]}
"""


def test_cells_that_start_otherwise_alone_are_alike() -> None:
    cells = load_experiment_text(SWEPT, "a.yaml").cells()
    classes = [sorted(cell.coordinates["height"] for cell in one) for one in alike(cells)]
    assert classes == [[1, 2, 3], [1, 2, 3]]
    masses = [{cell.coordinates["mass"] for cell in one} for one in alike(cells)]
    assert masses == [{1}, {2}]
