"""What every measure may carry: cells, and one closed form beside the value."""

from __future__ import annotations

from typing import get_args

import pytest
from pydantic import ValidationError

from lavendersim.measures.closed_forms import FORMS
from lavendersim.measures.specs.base import BODIES_OF, ClosedForm, FormName, PairMeasure
from lavendersim.quantities.readings import CONTACTS
from tests.marked_config import assert_refused, config, refusals

FORM = "{form: weight, bodies: [ball]}"


def with_measure(words: str) -> str:
    return config(measure=f"{{f: §{{kind: peak_force, body: ball, {words}}}}}")


def test_every_form_that_can_be_named_is_there_and_no_other() -> None:
    assert set(get_args(FormName)) == set(FORMS)


def test_one_form_beside_a_value() -> None:
    assert refusals(with_measure(f"over: {FORM}").replace("§", "")) == []
    assert_refused(
        with_measure(f"over: {FORM}, against: {FORM}"),
        "f: expected at most one of over, against",
    )


def test_the_name_of_a_form_is_one_of_them() -> None:
    with pytest.raises(ValidationError):
        ClosedForm(form="wait")
    text = config(measure="{f: {kind: peak_force, body: ball, over: {form: §wait}}}")
    (found,) = refusals(text.replace("§", ""))
    assert found.endswith('did you mean "weight"?')


def test_bodies_of_a_pair_exist() -> None:
    assert_refused(
        config(measure="{f: {kind: peak_force, body: §bal}}"),
        'body: no body is called "bal"; did you mean "ball"?',
    )
    assert PairMeasure.READS == CONTACTS


@pytest.mark.parametrize(
    ("form", "sentence"),
    [
        ("impact_speed", "expected bodies: [body, plane] of impact_speed, found 0"),
        ("newton_impulse, bodies: [ball]", "expected bodies: [A, B] of newton_impulse, found 1"),
        ("slop, bodies: [ball]", "expected no bodies of slop, found 1"),
        ("weight", "weight is of bodies, and none is named; write bodies"),
        (
            "drop_impulse, bodies: [floor, ball]",
            'bodies of drop_impulse: "ball" is a sphere, expected the name of a plane',
        ),
    ],
)
def test_a_form_is_refused_other_bodies_than_it_is_of(form: str, sentence: str) -> None:
    (found,) = refusals(with_measure(f"over: {{form: {form}}}").replace("§", ""))
    assert found.endswith(sentence)


def test_every_form_but_one_says_what_its_bodies_are() -> None:
    assert {*FORMS} - {*BODIES_OF} == {"weight"}
