"""Rows have levers where a contact may push a body past its centre of mass."""

from __future__ import annotations

import pytest
from plain_facts import body_facts, facts, pair_facts

from lavendersim.engine.effects.contact_torque import EFFECT, contact_fields
from lavendersim.engine.records import LEVER
from lavendersim.engine.spec import Spec


@pytest.mark.parametrize(
    ("body", "surface", "on"),
    [
        (body_facts("b", "sphere"), {}, False),
        (body_facts("b", "box"), {}, True),
        (body_facts("b", "box", movable=False), {}, False),
        (body_facts("b", "box", movable=False, kinematic=True, spins=True), {}, True),
        (body_facts("b", "box", movable=False, kinematic=True), {}, False),
        (body_facts("b", "sphere"), {"friction": 0.1}, True),
        (body_facts("b", "sphere"), {"rolling_friction": 0.1}, True),
    ],
)
def test_who_is_pushed_past_its_centre(body, surface, on: bool) -> None:
    assert EFFECT.decide(facts(body, pairs=(pair_facts("floor", "b", **surface),))).on is on
    assert not EFFECT.decide(facts(body)).on  # nothing can touch


def test_a_normal_alone_has_the_levers_and_a_block_of_friction_its_own() -> None:
    assert contact_fields(Spec()) == LEVER
    assert contact_fields(Spec(("friction",))) == []
    assert contact_fields(Spec(("friction", "frictionless_contact"))) == LEVER
    assert EFFECT.needs == ("rotation",)
