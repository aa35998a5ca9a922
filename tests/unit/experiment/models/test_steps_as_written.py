"""Rules of steps: at least one, not too many, counted over changes; an accuracy needs order 2."""

from __future__ import annotations

from fractions import Fraction

import pytest

from lavendersim.cell.numerics import Numerics
from lavendersim.experiment.models.steps import MOST_STEPS, is_of_order_two
from lavendersim.experiment.resolve.presets import PRESETS
from tests.marked_config import assert_refused, config, refusals


def test_the_longest_run_has_exactly_as_many_steps_as_there_may_be() -> None:
    most = Fraction(MOST_STEPS, 240)  # of 1/240 s
    timestep = "{timestep: 1/240}"
    assert refusals(config(duration=str(most), numerics=timestep)) == []
    beyond = config(duration="416667", numerics="{timestep: §1/240}")
    assert_refused(beyond, "416667 s in steps of 1/240 s are 1e8 steps, expected at most 1e8")


def test_a_run_of_less_than_half_a_step_is_none() -> None:
    assert refusals(config(duration="0.003", numerics="{timestep: 1/240}")) == []  # 0.72: one
    assert_refused(
        config(duration="0.002", numerics="{timestep: §1/240}"),
        "a duration of 0.002 s is less than one step of 1/240 s",
    )
    assert_refused(
        config(duration="1", numerics="{timestep: §240}"),
        "a duration of 1 s is less than one step of 240 s; did you mean timestep: 1/240?",
    )


def test_steps_are_counted_over_changes_of_the_timestep() -> None:
    """Half a second of 1/100 s, then 9.5 s of 1e-7 s: 50 + 9.5e7, and 9.5 s more are too many."""
    changes = {
        "numerics": "{timestep: 1/100}",
        "events": "[{at: 0.5, timestep: 1e-7}]",
    }
    assert refusals(config(duration="10", **changes)) == []
    found = refusals(config(duration="20", **changes))
    assert len(found) == 1
    said = "20 s in steps of changing length are 1.9"
    assert said in found[0]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (
            "{accuracy: 1e-3, impacts: §captured}",
            "accuracy: needs impacts: in_order, found captured",
        ),
        (
            "{integrator: midpoint, accuracy: §1e-3}",
            "accuracy: needs integrator: midpoint_contact, found midpoint",
        ),
        (
            "{accuracy: 1e-3, stabilisation_gain: §0.2}",
            "accuracy: needs stabilisation_gain: 0, found 0.2",
        ),
        (
            "{accuracy: 1e-3, tolerance: §null}",
            "accuracy: needs a tolerance, by which steps are solved; found null",
        ),
        (
            "{accuracy: 1e-3, timestep: 1/100, smallest_timestep: §0.02}",
            "smallest_timestep: expected at most the timestep, 0.01 s, found 0.02",
        ),
    ],
)
def test_an_accuracy_beside_laws_that_spoil_it_is_refused_at_the_later(
    words: str, sentence: str
) -> None:
    assert_refused(config(numerics=words), sentence)


def test_which_presets_are_of_order_two() -> None:
    orders = {name: is_of_order_two(dict(values)) for name, values in PRESETS.items()}
    assert orders == {"default": True, "chapter": False}
    stabilised = {**dict(Numerics()), "stabilisation_gain": 0.1}
    assert not is_of_order_two(stabilised)
