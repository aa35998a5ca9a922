"""An impact happens when a free flight reaches the surface, and targets are what follows from it.

phi + v t + a t^2/2 = 0 at tau, v_meet = v + a tau there, -e v_meet + a (dt - tau) at the end.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from interpreted import interpreted, records
from plain_facts import facts, one_row, pair_facts

from lavendersim.engine.effects.impact_time import (
    EFFECT,
    make_foresee,
    make_foresee_impacts,
    make_mark_carried,
    make_predict_impacts,
)
from lavendersim.engine.integrate import AFTERWARDS, AHEAD, ALWAYS, IMPACT
from lavendersim.engine.record_layout import contact_dtype
from lavendersim.engine.records import MOTION, dtype
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("impact_time",))
DT, SLOP = 0.01, 1e-4
PARAMETERS = {"dt": DT, "timestep": DT, "slop": SLOP}


def rows_of(*rows: dict[str, float], spec: Spec = SPEC) -> np.ndarray:
    """Return contacts by gap, rate v and acceleration a at the start, e, and their bodies."""
    contacts = np.zeros(len(rows), contact_dtype(spec))
    for contact, row in zip(contacts, rows, strict=True):
        contact["a"], contact["b"] = row.get("a", 0), row.get("b", 1)
        contact["inv_m_a"] = float(contact["a"] != 0)
        contact["inv_m_b"] = float(contact["b"] != 0)
        contact["phi"], contact["e"] = row["gap"], row.get("e", 0.0)
        contact["dv_n"] = row.get("acceleration", 0.0) * DT
        contact["v_n_pre"] = row["v"] + contact["dv_n"]
    return contacts


def foreseen(spec: Spec = SPEC, **row: float) -> Any:
    contact = records(rows_of(row, spec=spec))[0]
    interpreted(make_foresee(spec))(contact, one_row(**PARAMETERS), False)
    return contact


def first_root(gap: float, v: float, a: float) -> float:
    """Return the first time at which gap + v t + a t^2/2 is 0, by numpy's eigenvalues."""
    roots = np.roots([0.5 * a, v, gap])
    return min(float(r.real) for r in roots if abs(r.imag) < 1e-12 and r.real > 0.0)


@pytest.mark.parametrize(
    ("gap", "v", "a"), [(0.01, -2.0, -9.81), (0.005, -1.0, 30.0), (1e-3, 0.2, -100.0)]
)
def test_surfaces_meet_where_the_flight_ends_and_leave_by_newtons_law(gap, v, a) -> None:
    e = 0.6
    contact = foreseen(gap=gap, v=v, acceleration=a, e=e)
    tau = first_root(gap, v, a)
    assert contact.tau == pytest.approx(tau, rel=1e-9)
    meet = v + a * tau
    assert contact.approach_speed == pytest.approx(-meet, rel=1e-9)
    assert contact.separation_speed == pytest.approx(-e * meet, rel=1e-9)
    assert contact.after == pytest.approx(a * (DT - tau), rel=1e-8)


@pytest.mark.parametrize(
    "row",
    [
        {"gap": 0.05, "v": -2.0, "acceleration": -9.81},  # not in this step
        {"gap": 0.001, "v": 2.0, "acceleration": 9.81},  # it parts
        {"gap": 0.001, "v": -0.1, "acceleration": 30.0},  # it turns back before it is there
        {"gap": 0.0, "v": 0.1, "acceleration": -9.81},  # it parts, from the surface
        {"gap": 0.0, "v": 0.01, "acceleration": -9.81},  # without a rebound it is no flight
        {"gap": 0.0, "v": -1e-4, "acceleration": -9.81, "e": 0.5},  # a flight within the step
    ],
)
def test_what_does_not_meet_or_would_not_fly_is_no_impact(row) -> None:
    assert foreseen(**row).tau == DT


def test_a_fast_plastic_impact_stays_and_a_fast_short_flight_is_plastic() -> None:
    """Four times what forces change in a step; then a contact carries what does not fly on."""
    change = 9.81 * DT
    assert foreseen(gap=0.0, v=-3.9 * change, acceleration=-9.81).tau == DT
    plastic = foreseen(gap=0.0, v=-4.1 * change, acceleration=-9.81)
    assert (plastic.tau, plastic.separation_speed, plastic.after) == (0.0, 0.0, 0.0)
    short = foreseen(gap=0.0, v=-4.1 * change, acceleration=-9.81, e=0.1)  # 2 e v = 0.82 a dt
    assert (short.separation_speed, short.after) == (0.0, 0.0)
    flies = foreseen(gap=0.0, v=-4.1 * change, acceleration=-9.81, e=0.2)
    assert flies.separation_speed == pytest.approx(0.2 * 4.1 * change, rel=1e-12)
    assert flies.after == pytest.approx(-change, rel=1e-14)


def predicted(contacts: np.ndarray) -> np.ndarray:
    motion = np.zeros(3, dtype(MOTION))
    motion["tau"] = DT
    rows, count, bodies, params = (
        records(contacts), len(contacts), records(motion), one_row(**PARAMETERS)
    )  # fmt: skip
    if interpreted(make_foresee_impacts(SPEC))(rows, 0, count, count, bodies, params):
        interpreted(make_predict_impacts(SPEC))(rows, count, bodies, params)
    return motion


def test_the_target_of_an_impact_is_its_velocity_at_the_end_of_the_step() -> None:
    contacts = rows_of({"gap": 0.01, "v": -2.0, "acceleration": -9.81, "e": 0.5})
    motion = predicted(contacts)
    tau = first_root(0.01, -2.0, -9.81)
    v_end = 0.5 * (2.0 + 9.81 * tau) - 9.81 * (DT - tau)
    assert contacts["is_impact"][0] == IMPACT
    assert contacts["target"][0] == pytest.approx(-v_end, rel=1e-9)
    # The floor, which nothing moves, has no time of its own.
    assert motion["tau"][:2] == pytest.approx([DT, tau], rel=1e-9)


def test_of_a_body_s_contacts_the_first_is_the_impact_and_later_gaps_may_close_from_there() -> None:
    """After tau the second gap has what is left, and the rest of the step, to close in.

    What flies moves by its mean velocity there, v_n - a rest/2: no farther than the gap.
    """
    contacts = rows_of(
        {"gap": 0.004, "v": -2.0, "e": 0.5}, {"gap": 0.012, "v": -2.0, "acceleration": -9.81},
        {"gap": 0.004 + 0.5 * SLOP, "v": -2.0, "e": 0.5},
    )  # fmt: skip
    motion = predicted(contacts)
    tau = 0.002
    assert motion["tau"][1] == pytest.approx(tau, rel=1e-12)
    assert contacts["is_impact"].tolist() == [IMPACT, AHEAD, IMPACT]
    rest, left = DT - tau, 0.012 - 2.0 * tau - 0.5 * 9.81 * tau**2 - SLOP
    mean = -contacts["target"][1] + 0.5 * 9.81 * rest
    assert mean * rest == pytest.approx(-left, rel=1e-12)


def test_nothing_is_predicted_where_nothing_meets() -> None:
    contacts = rows_of({"gap": 0.05, "v": -2.0, "e": 0.5})
    contacts["target"] = 7.0
    motion = predicted(contacts)
    assert contacts["target"][0] == 7.0
    assert motion["tau"].tolist() == [DT] * 3


def mark_all(contacts: np.ndarray, motion: np.ndarray) -> None:
    mark, bodies = interpreted(make_mark_carried(SPEC)), records(motion)
    for contact in records(contacts):
        mark(contact, bodies, one_row(**PARAMETERS))


def test_bodies_are_carried_by_what_they_lie_on_or_stay_with() -> None:
    """Flies on, lies on it as the step begins, stays with what it met; the most of its contacts."""
    rows = [
        {"gap": 0.0, "v": -2.0}, {"gap": 0.0, "v": 0.0, "a": 1, "b": 2},
        {"gap": 0.01, "v": 0.0, "a": 0, "b": 2},
    ]  # fmt: skip
    for separation, expected in ((1.0, [0, 0, 0]), (0.0, [0, AFTERWARDS, 0])):
        contacts, motion = rows_of(*rows[:1]), np.zeros(3, dtype(MOTION))
        contacts["is_impact"], contacts["separation_speed"] = IMPACT, separation
        mark_all(contacts, motion)
        assert motion["carried"].tolist() == expected
    contacts, motion = rows_of(*rows), np.zeros(3, dtype(MOTION))
    contacts["is_impact"][0] = IMPACT
    mark_all(contacts, motion)
    assert motion["carried"].tolist() == [0, ALWAYS, ALWAYS]


def test_it_is_on_where_impacts_are_not_captured_and_something_can_touch() -> None:
    pairs = (pair_facts("floor", "ball"),)
    assert EFFECT.decide(facts(pairs=pairs, impacts="at_surface")).on
    assert not EFFECT.decide(facts(pairs=pairs)).on
    assert not EFFECT.decide(facts(impacts="at_surface")).on


@pytest.mark.parametrize("e", [0.0, 0.5])
def test_what_resists_the_approach_ends_with_it_and_resists_what_flies_off(e: float) -> None:
    """Of 3 m/s at the surface, slowed by 2 m/s in a step by drag while 0.5 m/s push away."""
    spec = SPEC.including("drag")
    contacts = rows_of({"gap": 0.0, "v": -3.0, "acceleration": 2.5 / DT, "e": e}, spec=spec)
    contacts["slowed_n"] = 2.0
    contact = records(contacts)[0]
    interpreted(make_foresee(spec))(contact, one_row(**PARAMETERS), False)
    assert contact.separation_speed == pytest.approx(e * 3.0)
    assert contact.after == pytest.approx(0.5 - e * 2.0)


def test_a_flight_from_a_surface_that_ends_in_the_step_ends_in_an_impact() -> None:
    """By a rebound before: it comes down after 2 v/a, as fast as it left."""
    v, a = 0.03, -9.81
    contact = foreseen(gap=0.0, v=v, acceleration=a, e=0.9)
    assert contact.tau == pytest.approx(2.0 * v / -a, rel=1e-12)
    assert contact.separation_speed == pytest.approx(0.9 * v, rel=1e-12)
