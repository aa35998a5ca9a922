"""Restitution captured in every sweep: the first visit bounces, the second takes it back."""

from __future__ import annotations

import pytest
from interpreted import interpreted
from plain_facts import facts, one_row, pair_facts

from lavendersim.engine.effects.capture_in_sweeps import EFFECT, make
from lavendersim.engine.spec import Spec


@pytest.mark.parametrize(("e", "speed"), [(1.0, 2.0), (0.5, 2.0), (0.5, 0.05)])
def test_one_row_ends_at_rest_whatever_its_restitution(e: float, speed: float) -> None:
    """v += -(v + e min(v, 0)), clamped at no impulse: e v after one visit, 0 after two."""
    capture = interpreted(make(Spec()))
    v, impulse, found = -speed, 0.0, []
    for _ in range(3):
        w = capture(one_row(target=0.25, e=e), v + 0.25, one_row(restitution_speed=0.1)) - 0.25
        change = max(impulse - w, 0.0) - impulse
        impulse, v = impulse + change, v + change
        found.append(v)
    bounce = e * speed if speed > 0.1 else 0.0
    assert found == pytest.approx([bounce, 0.0, 0.0], abs=1e-15)


def test_it_is_on_where_the_mistake_is_asked_for_and_shows() -> None:
    flat, bouncing = pair_facts("floor", "box"), pair_facts("floor", "ball", restitution=0.5)
    assert not EFFECT.decide(facts(pairs=(bouncing,))).on
    assert not EFFECT.decide(facts(pairs=(flat,), mistake="capture_in_sweeps")).on
    assert EFFECT.decide(facts(pairs=(flat, bouncing), mistake="capture_in_sweeps")).on
