"""The cells of a config as worlds are at the states that each has alone, or are refused."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim import Simulator
from lavendersim.errors import UsageError
from lavendersim.experiment import load_experiment_text
from lavendersim.simulator.worlds import worlds_of
from tests.drop_config import SCENE, SIX

STEPS = 90


def test_worlds_of_a_config_have_the_bits_of_its_cells() -> None:
    experiment = load_experiment_text(SIX, "drops.yaml")
    worlds = worlds_of(experiment)
    worlds.advance(STEPS, threads=2)
    assert len(worlds.engines) == 6
    for index, engine in enumerate(worlds.engines):
        alone = Simulator(experiment, index)
        for _ in range(STEPS):
            seen, *_ = alone.step()
        assert np.array_equal(engine.take_rows().pose[-1, :, :3], seen["bodies"]["position"])


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (
            "duration: 1\nevents: [{at: 0.5, body: ball, scale_mass: 2}]\n",
            "events happen between steps",
        ),
        (
            "duration: 1\nsweep: {i: {path: numerics.integrator, values: [semi_implicit_euler, midpoint]}}\n",  # noqa: E501
            "the cells of one sweep share their integrator",
        ),
    ],
)
def test_cells_that_cannot_advance_together_are_refused(more: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        worlds_of(load_experiment_text(SCENE + more, "drops.yaml"))
