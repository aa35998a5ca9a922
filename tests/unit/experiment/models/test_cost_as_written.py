"""The section `cost` as written: forms of its truth, and a sweep that leaves numerics to it."""

from __future__ import annotations

from fractions import Fraction

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.models.cost import CostSpec
from tests.marked_config import assert_refused, config, refusals

APEX = "{a: {kind: apex_error, body: ball, above: floor}}"


def with_cost(words: str, **sections: str) -> str:
    return config(measure=APEX, cost=f"{{error: {{measure: a}}{words}}}", **sections)


def read_cost(words: str) -> CostSpec:
    cost = load_experiment_text(with_cost(words), "cost.yaml").config.cost
    assert cost is not None
    return cost


def test_ratios_of_the_grid_are_kept_exactly() -> None:
    assert read_cost(", timesteps: [1/60, 1/7]").timesteps == (Fraction(1, 60), Fraction(1, 7))


@pytest.mark.parametrize("truth", ["2", "finest", "{form: weight, bodies: [ball]}"])
def test_a_truth_has_one_of_three_forms(truth: str) -> None:
    text = with_cost("").replace("{measure: a}", f"{{measure: a, truth: {truth}}}")
    found = refusals(text)
    assert not any("a number, {form, bodies}, or finest" in line for line in found)
    bad = with_cost("").replace("{measure: a}", "{measure: a, truth: §true}")
    expected = "truth: expected a number, {form, bodies}, or finest, found true"
    assert_refused(bad, expected)


def test_medians_of_fewer_than_seven_samples_say_nothing_and_are_refused() -> None:
    """Of n samples the extremes hold the median with 1 - 2^(1-n): 97 % for six, 98.4 % for 7."""
    assert refusals(with_cost(", repeats: 7")) == []
    found = refusals(with_cost(", repeats: 6"))
    assert len(found) == 1
    assert "repeats: expected a whole number from 7 to 1000, found 6" in found[0]


def test_the_sweep_leaves_numerics_and_the_grids_names_alone() -> None:
    other = {"sweep": "{dt: {path: §numerics.timestep, values: [1/60]}}"}
    varied = "path: numerics are varied by the section cost; leave them to that"
    assert_refused(with_cost("", **other), varied)
    named = {"sweep": "{§sweeps: {path: scene.bodies.ball.mass, values: [1, 2]}}"}
    assert_refused(
        with_cost("", **named),
        "sweeps: the section cost has an axis of this name; rename this one",
    )
    both = {"sweep": "[{m: {path: scene.bodies.ball.mass, values: [1, 2]}}, "
            "{§preset: {path: duration, values: [1, 2]}}]"}  # fmt: skip
    assert_refused(
        with_cost("", **both),
        "preset: the section cost has an axis of this name; rename this one",
    )
    assert refusals(with_cost("", sweep="{m: {path: duration, values: [1, 2]}}")) == []
