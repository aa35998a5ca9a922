"""Measures of motion between two times: the second later, along a direction that is one."""

from __future__ import annotations

import pytest

from lavendersim.measures.specs.kinematics import Displacement
from lavendersim.quantities.readings import POSES
from tests.marked_config import assert_refused, config, refusals

ALONG = "along: [0, 0, 2]"


def with_measure(words: str) -> str:
    return config(measure=f"{{m: §{{kind: mean_velocity, body: ball, {words}}}}}")


@pytest.mark.parametrize("times", ["", ", from: 0.5", ", to: 0.5", ", from: 0.5, to: 0.75"])
def test_times_may_be_left_out(times: str) -> None:
    assert refusals(with_measure(ALONG + times).replace("§", "")) == []


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (f"{ALONG}, from: 0.5, to: 0.5", "m: expected `from` before `to`"),
        (f"{ALONG}, to: 0", "m: expected `from` before `to`"),
        ("along: [0, 0, 0]", "m: expected a direction `along` that is not zero"),
    ],
)
def test_no_stretch_of_time_and_no_direction_are_refused(words: str, sentence: str) -> None:
    assert_refused(with_measure(words), sentence)


def test_a_threshold_of_rest_is_above_zero() -> None:
    assert_refused(
        config(measure="{m: {kind: rest_time, slower_than: §0}}"),
        "slower_than: expected a number above 0 [m/s], found 0",
    )


def test_keys_of_times_are_those_of_the_file() -> None:
    given = {"kind": "displacement", "body": "ball", "along": (1.0, 0.0, 0.0)}
    spec = Displacement.model_validate({**given, "from": 1.0, "to": 2.0})
    assert (spec.begin, spec.end) == (1.0, 2.0)
    assert spec.reads({}) == POSES
