"""A quick grid has the ends of the whole one, and settings of it alone."""

from __future__ import annotations

import pytest

from lavendersim.experiment import Experiment, load_experiment_text
from lavendersim.experiment.models.cost import FEWEST_REPEATS
from lavendersim.experiment.sweeps.cost_grid import settings_of
from lavendersim.experiment.sweeps.quick import quick, thinned
from tests.bouncing_ball_config import BOUNCING_BALL

ONE_CELL = "\n".join(line for line in BOUNCING_BALL.split("\n") if "phase: {path" not in line)
ONE_CELL = ONE_CELL.replace("sweep:\n", "")
GRID = BOUNCING_BALL + "cost: {error: {measure: apex}, repeats: 30}\n"


def loaded(text: str) -> Experiment:
    return load_experiment_text(text, "ball.yaml")


@pytest.mark.parametrize(
    ("values", "left"),
    [((), ()), ((1,), (1,)), ((1, 2), (1, 2)), ((1, 2, 3, 4), (1, 3, 4)), ((1, 2, 3), (1, 3))],
)
def test_every_other_value_is_left_and_the_last(
    values: tuple[int, ...], left: tuple[int, ...]
) -> None:
    assert thinned(values) == left


def test_a_quick_grid_is_part_of_the_whole_one_with_its_ends() -> None:
    experiment = loaded(GRID)
    whole, few = settings_of(experiment), settings_of(quick(experiment))
    assert set(few) < set(whole)
    assert len(few) < 0.6 * len(whole)
    for end in (min, max):
        assert end(one.timestep for one in few) == end(one.timestep for one in whole)
        assert end(one.sweeps for one in few) == end(one.sweeps for one in whole)
    roles = {one.role for one in whole}
    assert {one.role for one in few} == roles  # what the config specifies, and the chapter's
    spec = quick(experiment).config.cost
    assert spec is not None
    assert spec.repeats == FEWEST_REPEATS


@pytest.mark.parametrize(
    ("section", "effects", "repeats"),
    [
        ("{}", "required", FEWEST_REPEATS),
        ("{repeats: 3}", "required", 3),
        ("{effects: [restitution], repeats: 25}", ("restitution",), FEWEST_REPEATS),
    ],
)
def test_of_overheads_those_of_required_effects_are_left(
    section: str, effects: str | tuple[str, ...], repeats: int
) -> None:
    spec = quick(loaded(f"{ONE_CELL}overhead: {section}\n")).config.overhead
    assert spec is not None
    assert (spec.effects, spec.repeats) == (effects, repeats)


def test_what_has_neither_section_is_left_alone() -> None:
    experiment = loaded(BOUNCING_BALL)
    assert quick(experiment) == experiment
