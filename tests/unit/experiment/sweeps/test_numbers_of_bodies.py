"""Axes that vary nothing but numbers of bodies, and cells that differ in these alone."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.cell import alike
from lavendersim.experiment.sweeps.numbers_of_bodies import _is_of_mass, _is_of_start

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


@pytest.mark.parametrize(
    ("path", "mass"),
    [
        ((*BALL, "mass"), True),
        ((*BALL, "density"), True),
        ((*BALL, "inertia"), False),  # what is uneven has another plan
        ((*BALL, "surface", "mass"), False),
        (("scene", "mass"), False),
    ],
)
def test_paths_that_say_how_heavy_a_body_is(path: tuple[str | int, ...], mass: bool) -> None:
    assert _is_of_mass(path) is mass


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


def test_cells_that_start_otherwise_or_are_heavier_are_alike() -> None:
    cells = load_experiment_text(SWEPT, "a.yaml").cells()
    few = alike(cells, masses=False)
    classes = [sorted(cell.coordinates["height"] for cell in one) for one in few]
    assert classes == [[1, 2, 3], [1, 2, 3]]
    masses = [{cell.coordinates["mass"] for cell in one} for one in few]
    assert masses == [{1}, {2}]
    assert alike(cells) == [list(cells)]
