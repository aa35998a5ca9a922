"""Gravity adds g dt to every velocity, whatever the mass, and is on where it is ever not zero."""

from __future__ import annotations

from interpreted import interpreted
from plain_facts import facts, one_row

from lavendersim.engine.effects.gravity import EFFECT, make
from lavendersim.engine.spec import Spec


def test_a_velocity_changes_by_g_dt() -> None:
    velocity = one_row(vx=1.0, vy=2.0, vz=3.0)
    parameters = one_row(gx=0.5, gy=-1.0, gz=-8.0, dt=0.25)
    interpreted(make(Spec()))(one_row(inv_m=0.5), velocity, parameters)
    assert (velocity.vx, velocity.vy, velocity.vz) == (1.125, 1.75, 1.0)


def test_it_is_on_with_any_component_now_or_later() -> None:
    assert not EFFECT.decide(facts()).on
    assert not EFFECT.decide(facts(later_gravity=((0.0, 0.0, 0.0),))).on
    for axis in range(3):
        g = tuple(-9.81 if k == axis else 0.0 for k in range(3))
        now, later = EFFECT.decide(facts(gravity=g)), EFFECT.decide(facts(later_gravity=(g,)))
        assert now.on
        assert later.on
        assert "-9.81" in now.reason
        assert "later" in later.reason
