"""Impulses of least norm are chosen where they are asked for, may be open, and are affordable."""

from __future__ import annotations

import pytest
from plain_facts import body_facts, facts, pair_facts

from lavendersim.engine.effects.least_norm import EFFECT, MOST_BODIES, contact_fields
from lavendersim.engine.spec import Spec

FLOOR = body_facts("floor", "plane", movable=False)
ASKED = {"undetermined_forces": "least_norm"}


def decided(*bodies, pair_count: int = 1, **numerics):
    pair = pair_facts(bodies[0].name, bodies[1].name, friction=0.5)
    return EFFECT.decide(facts(*bodies, pairs=(pair,), pair_count=pair_count, **numerics))


def test_it_is_on_where_contacts_may_be_redundant() -> None:
    box, ball = body_facts("box", "box"), body_facts("ball", "sphere")
    assert decided(FLOOR, box, **ASKED).on
    assert not decided(FLOOR, box).on
    assert not decided(FLOOR, box, **ASKED, solver="jacobi").on
    assert not decided(FLOOR, ball, **ASKED).on  # one point has one impulse
    assert decided(FLOOR, ball, pair_count=2, **ASKED).on


@pytest.mark.parametrize(("movable", "on"), [(MOST_BODIES, True), (MOST_BODIES + 1, False)])
def test_few_bodies_may_move(movable: int, on: bool) -> None:
    boxes = [body_facts(f"box_{k}", "box") for k in range(movable)]
    assert decided(FLOOR, *boxes, pair_count=9, **ASKED).on is on


def test_only_frictional_contacts_slide() -> None:
    assert [name for name, _ in contact_fields(Spec())] == ["face"]
    names = [name for name, _ in contact_fields(Spec(effects=("friction",)))]
    assert names == ["face", "slip_1", "slip_2", "given_1", "given_2"]
