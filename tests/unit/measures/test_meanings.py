"""Meanings and units of measures, from the sentence of their model."""

from __future__ import annotations

import pytest

from lavendersim.measures.meanings import described_kinds, meaning_of, meaning_of_kind
from lavendersim.measures.specs.base import ClosedForm, Measure
from lavendersim.measures.specs.catalogue import KINDS
from lavendersim.measures.specs.states import FirstPassage


class Fast(Measure):
    """Largest speed [m/s] of a body at 1.5 m. What is left is not said."""

    body: str = "ball"


class Ratio(Measure):
    """Speed [m/s] over force [N]."""


def test_the_first_sentence_is_the_meaning_and_its_bracket_the_unit() -> None:
    assert meaning_of_kind(Fast) == ("Largest speed of a body at 1.5 m", "m/s")


def test_two_units_are_none() -> None:
    assert meaning_of_kind(Ratio)[1] == ""


def test_a_count_of_bodies_has_not_the_unit_of_their_numbers() -> None:
    spec = FirstPassage(kind="first_passage", along=(0, 0, 1), level=1.0, reduce="count")
    assert meaning_of(spec)[1] == "-"
    assert meaning_of(spec.model_copy(update={"reduce": "max"}))[1] == "s"


def test_beside_a_closed_form_it_is_a_ratio() -> None:
    form = next(iter(ClosedForm.model_fields["form"].annotation.__args__))  # type: ignore[union-attr]
    over = Fast.model_construct(over=ClosedForm.model_construct(form=form), against=None)
    meaning, unit = meaning_of(over)
    assert meaning.endswith(f"; over {form}")
    assert unit == "-"
    against = Fast.model_construct(over=None, against=ClosedForm.model_construct(form=form))
    assert meaning_of(against)[0].endswith(f"; relative distance from {form}")


@pytest.mark.parametrize("kind", sorted(set(KINDS) - {"from_file"}))
def test_every_kind_is_described_with_its_parameters(kind: str) -> None:
    found = described_kinds()
    assert found[kind].meaning
    assert found[kind].package == ""
    own = set(KINDS[kind].model_fields) - set(Measure.model_fields) - {"kind"}
    assert len(found[kind].parameters) == len(own)
