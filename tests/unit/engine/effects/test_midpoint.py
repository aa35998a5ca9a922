"""The mean velocity is needed where the integrator asks for it and something accelerates bodies."""

from __future__ import annotations

from plain_facts import body_facts, facts

from lavendersim.engine.effects.midpoint import EFFECT

DOWN = (0.0, 0.0, -9.81)


def test_it_is_on_with_gravity_and_the_integrator_that_is_not_euler() -> None:
    ball = body_facts("ball", "sphere")
    assert EFFECT.decide(facts(ball, gravity=DOWN, integrator="midpoint")).on
    assert "gravity" in EFFECT.decide(facts(ball, gravity=DOWN, integrator="midpoint")).reason
    assert not EFFECT.decide(facts(ball, gravity=DOWN)).on


def test_where_nothing_accelerates_every_integrator_moves_alike() -> None:
    fixed = body_facts("wall", movable=False)
    assert not EFFECT.decide(facts(fixed, integrator="midpoint")).on
    assert "any integrator" in EFFECT.decide(facts(fixed, integrator="midpoint")).reason
