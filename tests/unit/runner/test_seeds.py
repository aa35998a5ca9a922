"""What was drawn at random for a cell, in words: the seeds of grids that are jittered."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.runner.seeds import NONE, Seeds

SCENE = """
scene:
  bodies: {{floor: {{shape: {{kind: plane}}}}}}
  arrangements:
    ball:
      kind: {kind}
      {shape}
      body: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1}}
{more}
duration: 0.1
"""
GRID = "counts: [2, 2, 1]\n      spacing: [1, 1, 1]\n      origin: [0, 0, 1]"


def seeds(kind: str, shape: str, more: str = "") -> list[str]:
    """Return what is said of each cell of a config."""
    experiment = load_experiment_text(SCENE.format(kind=kind, shape=shape, more=more), "a.yaml")
    found = Seeds(experiment)
    return [found.of(cell) for cell in experiment.cells()]


@pytest.mark.parametrize(
    ("kind", "shape", "words"),
    [
        ("grid", GRID, NONE),
        ("grid", GRID + "\n      jitter: 0.1\n      seed: 7", "ball: 7"),
        ("grid", GRID + "\n      jitter: 0\n      seed: 7", NONE),
    ],
)
def test_a_grid_draws_where_it_is_jittered(kind: str, shape: str, words: str) -> None:
    assert seeds(kind, shape) == [words]


def test_a_swept_seed_is_said_cell_by_cell() -> None:
    shape = GRID + "\n      jitter: 0.1\n      seed: 0"
    sweep = "sweep: {seed: {path: scene.arrangements.ball.seed, values: [1, 2]}}"
    assert seeds("grid", shape, sweep) == ["ball: 1", "ball: 2"]
