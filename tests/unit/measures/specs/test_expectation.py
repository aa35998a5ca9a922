"""Expectations: exactly one judgement, tolerances where they count, controls by themselves."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import ValidationError

from lavendersim.measures.cell_judgements import JUDGES
from lavendersim.measures.specs.expectation import (
    CELL_JUDGEMENTS,
    SWEEP_JUDGEMENTS,
    Equals,
    ExpectSpec,
)
from tests.marked_config import assert_refused, config

GIVEN: dict[str, Any] = {
    "between": (1.0, 2.0),
    "at_most": 1.0,
    "at_least": 1.0,
    "exactly": 1.0,
    "equals": {"value": 1.0, "absolute": 0.1},
    "row": "increasing",
    "increasing": {"along": "a"},
    "decreasing": {"along": "a"},
    "ratio": {"of": {"a": 1}, "to": {"a": 2}, "at_most": 1.0},
    "order": {"along": "a", "at_least": 1.0},
    "crosses": {"along": "a", "level": 1.0, "between": (1.0, 2.0)},
}


def spec(**given: Any) -> ExpectSpec:
    return ExpectSpec.model_validate({"name": "claim", "measure": "m", **given})


@pytest.mark.parametrize("key", GIVEN)
def test_a_judgement_is_known_by_its_key(key: str) -> None:
    one = spec(**{key: GIVEN[key]})
    assert one.judgement == key
    assert one.per_cell == (key in JUDGES)
    assert {*CELL_JUDGEMENTS, *SWEEP_JUDGEMENTS} == GIVEN.keys()


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({}, "expected exactly one judgement of .*; found none"),
        ({"at_most": 1.0, "exactly": 0.0}, "found at_most, exactly"),
        ({"between": (2.0, 1.0)}, "expected the lower bound first in `between`"),
        ({"crosses": GIVEN["crosses"] | {"between": (2.0, 1.0)}}, "expected the lower bound first"),
        ({"equals": 1.0}, "expected relative or absolute above 0"),
        ({"equals": GIVEN["equals"], "relative": 0.1}, "relative and absolute stand inside it"),
        ({"at_most": 1.0, "absolute": 0.1}, "relative and absolute stand beside `equals`"),
        ({"equals": {"value": 1.0}}, "use `exactly` for no tolerance"),
        ({"equals": {"absolute": 1.0}}, "expected exactly one of value, closed_form"),
        ({"ratio": {"of": {"a": 1}, "to": {"a": 2}}}, "expected at_most or at_least"),
        ({"measure": "", "at_most": 1.0}, 'missing key "measure"'),
        (
            {"fails": "energy", "at_most": 1.0},
            "nothing beside fails but name and at; found measure",
        ),
    ],
)
def test_what_is_no_one_claim_is_refused(given: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ValidationError, match=sentence):
        spec(**given)


def test_equals_is_the_same_in_both_of_its_forms() -> None:
    inner = Equals(value="2 * $a", relative=0.1, absolute=0.0)
    assert spec(equals="2 * $a", relative=0.1).agreement == inner
    assert spec(equals={"value": "2 * $a", "relative": 0.1}).agreement == inner
    assert spec(at_most=1.0).agreement is None


def test_a_control_of_what_should_hold_and_does_not_yet_says_so_in_its_name() -> None:
    names = ("known failure: it tips", "a gain wins energy")
    controls = [ExpectSpec(name=name, fails="energy") for name in names]
    assert [one.known_failure for one in controls] == [True, False]
    assert not ExpectSpec(name="known failure", measure="m", at_most=1.0).known_failure


def test_a_refusal_stands_at_the_claim() -> None:
    measure = "{m: {kind: apex_error, body: ball, above: floor}}"
    claim = "[§{name: it, measure: m, between: [2, 1]}]"
    assert_refused(
        config(measure=measure, expect=claim),
        "expect[0]: expected the lower bound first in `between`",
    )
