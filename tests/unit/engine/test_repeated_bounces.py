"""Bounces within a step as one impact: the same impulse, place and velocity at its end."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from interpreted import interpreted, records
from plain_facts import one_row

from lavendersim.engine.record_layout import contact_dtype
from lavendersim.engine.repeated_bounces import bounces_repeat, make_bounce_on
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("impact_time", "restitution"))
BOUNCE_ON = interpreted(make_bounce_on(SPEC))
DT, G, SLOP = 0.01, 10.0, 1e-7


def bounced(first: float, speed: float, e: float, gap: float = 1e-3) -> Any:
    contact = records(np.zeros(1, contact_dtype(SPEC)))[0]
    contact.dv_n, contact.phi, contact.e, contact.tau = -G * DT, gap, e, DT
    BOUNCE_ON(contact, first, speed, e, one_row(dt=DT, slop=SLOP))
    return contact


def test_one_impact_leads_to_the_place_and_velocity_of_three() -> None:
    """Met at 1 ms with 20 mm/s, e = 0.8: flights of 3.2, 2.56, 2.048 and 1.638 ms, in 9 ms left."""
    first, speed, e = 1e-3, 0.02, 0.8
    contact = bounced(first, speed, e)
    last = first + 2.0 / G * speed * (e + e**2 + e**3)
    leaves, left = speed * e**4, DT - last
    v_end = leaves - G * left
    assert contact.separation_speed + contact.after == pytest.approx(v_end, rel=1e-12)
    begin = -speed + G * first  # the velocity at which the step began
    rest = DT - contact.tau
    moved = begin * contact.tau - 0.5 * G * contact.tau**2 + v_end * rest + 0.5 * G * rest**2
    to_surface = begin * first - 0.5 * G * first**2
    assert moved == pytest.approx(to_surface + leaves * left - 0.5 * G * left**2, rel=1e-12)


def test_bounces_that_end_within_the_step_stay_where_they_met() -> None:
    contact = bounced(1e-3, 0.02, 0.3)  # flights of 1.2, 0.36, 0.108 ms; the next is contact
    assert (contact.tau, contact.separation_speed, contact.after) == (1e-3, 0.0, 0.0)


@pytest.mark.parametrize(("gap", "tau"), [(0.0, DT), (0.5 * SLOP, DT), (2.0 * SLOP, 1e-3)])
def test_what_lies_on_its_contact_has_no_impact(gap: float, tau: float) -> None:
    """It approaches by what solves leave, and its rebound would be over in no time."""
    assert bounced(1e-3, 1e-9, 0.5, gap).tau == tau


def test_a_ball_that_loses_nothing_never_rests() -> None:
    contact = bounced(0.0, 1e-3, 1.0)  # flights of 0.2 ms: 50 of them
    assert contact.separation_speed == pytest.approx(1e-3, rel=1e-12)


@pytest.mark.parametrize("other", ["impact_order", "drag", "cohesion", "compliance", "spring"])
def test_they_are_found_one_by_one_or_not_at_all_beside_other_laws(other: str) -> None:
    assert bounces_repeat(SPEC)
    assert not bounces_repeat(SPEC.including(other))
