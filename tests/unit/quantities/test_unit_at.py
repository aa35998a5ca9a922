"""Units of numbers of a config are those that their models declare."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.quantities.unit_at import unit_at
from tests.drop_config import DROP

CONFIG = load_experiment_text(DROP, "drop.yaml").config


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        ("scene.bodies.ball.mass", "kg"),
        ("scene.bodies.ball.shape.radius", "m"),
        ("scene.bodies.ball.position", "m"),
        ("scene.bodies.ball.position.2", "m"),
        ("scene.bodies.ball.velocity", "m/s"),
        ("scene.gravity.2", "m/s^2"),
        ("scene.bodies.ball.surface.restitution", ""),  # a ratio
        ("numerics.timestep", "s"),
        ("duration", "s"),
        ("numerics.solver", ""),  # a word
        ("scene.bodies.cube.mass", ""),  # not there
        ("nothing.at.all", ""),
    ],
)
def test_a_number_has_the_unit_of_its_model(path: str, unit: str) -> None:
    assert unit_at(CONFIG, path) == unit
