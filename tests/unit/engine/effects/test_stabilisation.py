"""What penetrates by d beyond the slop is asked to part at beta (d - slop)/dt."""

from __future__ import annotations

import pytest
from interpreted import interpreted
from plain_facts import facts, one_row, pair_facts

from lavendersim.engine.effects.stabilisation import EFFECT, make
from lavendersim.engine.spec import Spec


@pytest.mark.parametrize(
    ("phi", "speed"), [(-0.005, 0.08), (-0.001, 0.0), (-0.0005, 0.0), (0.01, 0.0)]
)
def test_the_bias_takes_a_share_of_the_excess_in_a_step(phi: float, speed: float) -> None:
    """beta 0.2, slop 1 mm, dt 10 ms: 4 mm too deep part at 0.08 m/s. Targets are negative."""
    contact = one_row(phi=phi, target=0.5)
    parameters = one_row(slop=0.001, stabilisation_gain=0.2, dt=0.01)
    interpreted(make(Spec()))(contact, one_row(kind=0), parameters)
    assert contact.target == pytest.approx(0.5 - speed, abs=1e-15)


def test_it_is_on_with_a_gain_and_something_that_can_touch() -> None:
    pairs = (pair_facts("floor", "box"),)
    assert EFFECT.decide(facts(pairs=pairs, stabilisation_gain=0.2)).on
    assert not EFFECT.decide(facts(pairs=pairs)).on
    assert not EFFECT.decide(facts(stabilisation_gain=0.2)).on
