"""Selections as written: scalars, lists of scalars, `any`; kept as they are read."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import TypeAdapter, ValidationError

from lavendersim.measures.specs.selection import ANY, Selection
from lavendersim.quantities.scalars import resolve
from tests.marked_config import assert_refused, config

SELECTION = TypeAdapter(Selection)


@pytest.mark.parametrize("value", [True, 3, 0.5, "red", ANY, resolve("1/480")])
def test_scalars_stay_what_they_are(value: Any) -> None:
    found = SELECTION.validate_python({"a": value})["a"]
    assert found is value


def test_a_list_becomes_a_tuple() -> None:
    assert SELECTION.validate_python({"a": [1, "x"], "b": [2]}) == {
        "a": (1, "x"),
        "b": (2,),
    }


@pytest.mark.parametrize("value", [None, [], [[1]], {"from": 1}, [None]])
def test_what_no_axis_takes_is_refused(value: Any) -> None:
    with pytest.raises(ValidationError, match="a swept value, a list of swept values, or `any`"):
        SELECTION.validate_python({"a": value})


def test_an_axis_is_one_of_the_sweep() -> None:
    sweep = "{mass: {path: scene.bodies.ball.mass, values: [1, 2]}}"
    measure = "{f: {kind: peak_force, body: ball, at: {§mas: 1}}}"
    assert_refused(
        config(sweep=sweep, measure=measure),
        'at: no axis is called "mas"; did you mean "mass"?',
    )
    assert_refused(
        config(sweep=sweep, measure="{f: {kind: peak_force, body: ball, at: {mass: §3}}}"),
        "mass: 3 is not among the swept values 1, 2",
    )
