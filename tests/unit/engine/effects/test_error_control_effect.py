"""Error control is on where an accuracy is asked for and something moves; it logs its substeps."""

from __future__ import annotations

from interpreted import interpreted
from plain_facts import body_facts, facts, one_row

from lavendersim.engine.effects.error_control import EFFECT, make_step_row
from lavendersim.engine.spec import Spec


def test_it_is_on_with_an_accuracy_and_a_movable_body() -> None:
    ball, floor = body_facts("ball", "sphere"), body_facts("floor", "plane", movable=False)
    assert EFFECT.decide(facts(floor, ball, accuracy=1e-3)).on
    assert not EFFECT.decide(facts(floor, ball)).on
    assert not EFFECT.decide(facts(floor, accuracy=1e-3)).on


def test_a_step_says_what_it_was_made_in() -> None:
    values = {"substeps": 7, "rejected": 2, "shortest": 1e-4, "estimated_error": 3e-6}
    row = one_row(**dict.fromkeys(values, 0.0))
    interpreted(make_step_row(Spec()))(row, None, one_row(**values))
    assert {name: row[name] for name in values} == values
    assert {column.name for column in EFFECT.step_columns} == set(values)
