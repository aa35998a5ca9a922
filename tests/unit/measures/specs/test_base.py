"""What every measure may carry: cells, and one closed form beside the value."""

from __future__ import annotations

from typing import get_args

import pytest
from pydantic import ValidationError

from lavendersim.measures.closed_forms import FORMS
from lavendersim.measures.specs.base import ClosedForm, FormName, PairMeasure
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
