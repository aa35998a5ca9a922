"""Kinematic bodies are marked in the body table, and named."""

from __future__ import annotations

from types import SimpleNamespace

from plain_facts import body_facts, facts

from lavendersim.engine.effects.kinematic import EFFECT, body_values


def test_it_is_on_where_a_body_is_kinematic() -> None:
    still, belt = (
        body_facts("floor", movable=False),
        body_facts("belt", movable=False, kinematic=True),
    )
    assert not EFFECT.decide(facts(still)).on
    found = EFFECT.decide(facts(still, belt))
    assert found.on
    assert "belt" in found.reason
    assert "floor" not in found.reason


def test_the_value_of_the_config_is_the_field_of_the_body() -> None:
    for value in (False, True):
        assert body_values(SimpleNamespace(kinematic=value)) == {"kinematic": value}
    assert {name for name, _ in EFFECT.fields.body} == {"kinematic"}
    (key,) = EFFECT.body_keys
    assert key.default is False
    assert key.prescribes_motion
