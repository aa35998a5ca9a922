"""A compliant row at rest carries F at the penetration c F: gamma = c/dt^2, springs in series."""

from __future__ import annotations

import pytest
from interpreted import interpreted
from plain_facts import facts, one_row, pair_facts

from lavendersim.engine.effects.compliance import EFFECT, make
from lavendersim.engine.spec import Spec


def test_a_resting_row_has_the_penetration_of_its_load() -> None:
    """The row asks v_n + target + gamma lambda = 0 with target = phi/dt: at rest phi = -c F."""
    c, dt, force = 2e-5, 0.004, 150.0
    contact = one_row(gamma=0.0)
    interpreted(make(Spec()))(contact, one_row(compliance=c), one_row(dt=dt))
    assert -contact.gamma * (force * dt) * dt == pytest.approx(-c * force, rel=1e-15)


def test_it_adds_to_what_others_bring_and_two_surfaces_add() -> None:
    contact = one_row(gamma=3.0)
    interpreted(make(Spec()))(contact, one_row(compliance=1e-4), one_row(dt=0.01))
    assert contact.gamma == pytest.approx(4.0, rel=1e-15)
    assert [key.mix(1e-5, 3e-5) for key in EFFECT.surface_keys] == [4e-5]


def test_it_is_on_where_a_pair_is_compliant() -> None:
    hard, soft = pair_facts("floor", "box"), pair_facts("floor", "ball", compliance=1e-5)
    assert not EFFECT.decide(facts(pairs=(hard,))).on
    found = EFFECT.decide(facts(pairs=(hard, soft)))
    assert found.on
    assert "floor and ball: compliance 1e-05 m/N" in found.reason
