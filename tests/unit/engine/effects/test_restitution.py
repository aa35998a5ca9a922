"""Newton's law: a target of e times the approach speed, above the threshold, captured once."""

from __future__ import annotations

import pytest
from interpreted import interpreted
from plain_facts import facts, one_row, pair_facts

from lavendersim.engine.effects.restitution import EFFECT, make
from lavendersim.engine.spec import Spec


@pytest.mark.parametrize(
    ("v_n", "target"), [(-2.0, -1.0), (-0.51, -0.255), (-0.5, 0.0), (-0.1, 0.0), (3.0, 0.0)]
)
def test_what_approaches_faster_than_the_threshold_leaves_at_e_times_its_speed(v_n, target) -> None:
    """The row asks v_n + target >= 0: after the solve v_n = e |v_n_pre|."""
    contact = one_row(v_n_pre=v_n, target=0.125)
    interpreted(make(Spec()))(contact, one_row(restitution=0.5), one_row(restitution_speed=0.5))
    assert contact.target == pytest.approx(0.125 + target, abs=1e-15)


@pytest.mark.parametrize("elsewhere", ["impact_time", "capture_in_sweeps"])
def test_where_another_effect_applies_the_law_only_the_coefficient_is_taken(elsewhere) -> None:
    contact = one_row(v_n_pre=-2.0, target=0.0, e=0.0)
    kernel = interpreted(make(Spec((elsewhere,))))
    kernel(contact, one_row(restitution=0.5), one_row(restitution_speed=0.5))
    assert (contact.target, contact.e) == (0.0, 0.5)


def test_it_is_on_where_a_pair_rebounds_and_a_pair_takes_the_larger() -> None:
    dull, bouncing = pair_facts("floor", "box"), pair_facts("floor", "ball", restitution=0.5)
    assert not EFFECT.decide(facts(pairs=(dull,))).on
    found = EFFECT.decide(facts(pairs=(dull, bouncing)))
    assert found.on
    assert "floor and ball: coefficient 0.5" in found.reason
    assert [key.mix(0.2, 0.7) for key in EFFECT.surface_keys] == [0.7]
