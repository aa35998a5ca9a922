"""Terms of contacts' rows follow from what effects declare, and from nothing else."""

from __future__ import annotations

from dataclasses import fields

import pytest

from lavendersim.engine.effects import EFFECTS, Effect
from lavendersim.engine.record_layout import contact_dtype
from lavendersim.engine.row_terms import row_terms
from lavendersim.engine.spec import Spec
from lavendersim.engine.terms import RowTerms

# A field of the contact's record that each term is written in.
WRITTEN_IN = {
    "frictional": "lambda_1",
    "compliant": "gamma",
    "torsional": "psi_n",
    "rolling": "psi_1",
    "levers": "lever_ax",
    "shifted": "surface_1",
}


def test_without_effects_rows_are_of_a_normal_alone() -> None:
    assert row_terms(Spec()) == RowTerms(frictionless=True)


@pytest.mark.parametrize("effect", EFFECTS, ids=lambda effect: effect.name)
def test_an_engine_has_the_terms_of_its_effects(effect: Effect) -> None:
    terms = row_terms(Spec().including(effect.name))
    for term in fields(RowTerms):
        alone = term.name == "frictionless" and not effect.row.frictional
        assert getattr(terms, term.name) == (getattr(effect.row, term.name) or alone)


def test_frictional_and_frictionless_rows_may_stand_side_by_side() -> None:
    assert not row_terms(Spec(("friction",))).frictionless
    both = row_terms(Spec(("friction", "frictionless_contact")))
    assert both.frictional
    assert both.frictionless


@pytest.mark.parametrize("term", WRITTEN_IN)
def test_a_term_comes_with_its_field(term: str) -> None:
    bringing = [effect for effect in EFFECTS if getattr(effect.row, term)]
    assert bringing
    for effect in bringing:
        frictional = ("friction",) if term == "shifted" else ()
        names = contact_dtype(Spec().including(effect.name, *frictional)).names
        assert WRITTEN_IN[term] in names
