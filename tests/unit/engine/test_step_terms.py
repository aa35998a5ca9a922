"""Terms of steps follow from what effects declare, and from nothing else."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import pytest

from lavendersim.engine.effects import EFFECTS, Effect
from lavendersim.engine.record_layout import body_dtype, contact_dtype, pair_dtype
from lavendersim.engine.repeated_bounces import bounces_repeat
from lavendersim.engine.spec import Spec
from lavendersim.engine.step_terms import step_terms
from lavendersim.engine.terms import StepTerms

# A field that each term is written in, and the record that has it.
WRITTEN_IN: dict[str, tuple[Any, str]] = {
    "turns": (body_dtype, "qw"),
    "kinematic": (body_dtype, "kinematic"),
    "mean_flight": (contact_dtype, "dv_n"),
    "centred": (contact_dtype, "lasts"),
    "rebounds": (pair_dtype, "restitution"),
    "timed_impacts": (contact_dtype, "tau"),
    "ordered_impacts": (contact_dtype, "due"),
    "overlooks": (pair_dtype, "whole"),
}


def test_without_effects_a_step_reckons_with_nothing() -> None:
    assert step_terms(Spec()) == StepTerms()


@pytest.mark.parametrize("effect", EFFECTS, ids=lambda effect: effect.name)
def test_an_engine_has_the_terms_of_its_effects(effect: Effect) -> None:
    assert step_terms(Spec((effect.name,))) == effect.step


@pytest.mark.parametrize("term", [term.name for term in fields(StepTerms)])
def test_an_effect_brings_each_term(term: str) -> None:
    assert any(getattr(effect.step, term) for effect in EFFECTS)


@pytest.mark.parametrize("term", WRITTEN_IN)
def test_a_term_comes_with_its_field(term: str) -> None:
    dtype, field = WRITTEN_IN[term]
    for effect in EFFECTS:
        if getattr(effect.step, term):
            assert field in dtype(Spec((effect.name,))).names


@pytest.mark.parametrize("name", ["drag", "cohesion", "compliance", "spring"])
def test_where_flights_are_no_parabolas_or_contacts_take_time_bounces_vary(name: str) -> None:
    """Each is shorter by e than the one before where gravity alone acts between instants."""
    assert not bounces_repeat(Spec(("impact_time",)).including(name))


def test_terms_of_several_effects_stand_side_by_side() -> None:
    both = step_terms(Spec(("drag", "rotation")))
    assert both == StepTerms(bounces_vary=True, turns=True)


@pytest.mark.parametrize("effect", EFFECTS, ids=lambda effect: effect.name)
def test_bounces_repeat_but_where_an_effect_varies_or_orders_them(effect: Effect) -> None:
    """Bounces are powers of e with the time of impacts alone; who declares otherwise ends it."""
    varied = effect.step.bounces_vary or effect.step.ordered_impacts
    assert bounces_repeat(Spec(("impact_time",)).including(effect.name)) == (not varied)
    assert not bounces_repeat(Spec((effect.name,))) or effect.name == "impact_time"
