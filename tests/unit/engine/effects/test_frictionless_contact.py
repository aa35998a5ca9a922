"""Pairs without friction of any kind have rows of their own, marked where both occur."""

from __future__ import annotations

import pytest
from plain_facts import facts, pair_facts

from lavendersim.engine.effects.frictionless_contact import EFFECT, contact_fields, is_frictionless
from lavendersim.engine.spec import Spec


@pytest.mark.parametrize("kind", ["friction", "torsional_friction", "rolling_friction"])
def test_any_kind_of_friction_makes_a_pair_frictional(kind: str) -> None:
    frictionless, frictional = pair_facts("a", "b"), pair_facts("a", "c", **{kind: 0.1})
    assert is_frictionless(frictionless)
    assert not is_frictionless(frictional)
    assert EFFECT.decide(facts(pairs=(frictional, frictionless))).on
    assert "a and b" in EFFECT.decide(facts(pairs=(frictional, frictionless))).reason
    assert not EFFECT.decide(facts(pairs=(frictional,))).on
    assert not EFFECT.decide(facts()).on


def test_contacts_say_which_they_are_only_where_both_kinds_occur() -> None:
    assert contact_fields(Spec(("frictionless_contact",))) == []
    both = contact_fields(Spec(("friction", "frictionless_contact")))
    assert [name for name, _ in both] == ["frictional"]
