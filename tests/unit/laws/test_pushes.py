"""What impulses should not have done, and what the unknown order of a step's impacts excuses."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.laws.pushes import NONE, Pushes

FAST = 2.0  # [m/s]


def pushes(count: int = 1, **changed: object) -> Pushes:
    """Return contacts of a body of 1 kg with floors; each pushes with 1 N s along its normal."""
    rows = np.zeros((count, 2, 3, 6))
    rows[:, 1, :, :3] = np.eye(3)
    values = {
        "impulses": np.tile([1.0, 0.0, 0.0], (count, 1)),
        "approach": np.zeros(count),
        "before": np.zeros((count, 3)),
        "free": np.zeros((count, 3)),
        "after": np.zeros((count, 3)),
        "softness": np.ones(count),
        "mu": np.full(count, 0.5),
        "restitution": np.full(count, 0.5),
        "rigid": np.ones(count, bool),
        "a": np.zeros(count, int),
        "b": np.ones(count, int),
        "names": np.arange(count),
        "rows": rows,
        "size": np.full(count, 2.0),
        "energy_at_play": 4.0,
    }
    return Pushes(**(values | changed))  # type: ignore[arg-type]


def test_what_parts_faster_than_restitution_is_pushed_in_vain() -> None:
    """It may leave with e times the approach; the rest, or all of the impulse, is too much."""
    after = np.array([[0.8, 0.0, 0.0]])
    found = pushes(approach=np.array([1.0]), after=after).complementarity()
    assert found.number == pytest.approx(0.3, abs=1e-15)
    assert (found.share, found.bodies) == (pytest.approx(0.15), (0, 1))
    assert pushes(after=10 * after).complementarity().number == 1.0
    assert pushes(approach=np.array([1.7]), after=after).complementarity() == NONE


def test_a_spring_pushes_what_parts() -> None:
    after = np.array([[0.8, 0.0, 0.0]])
    assert pushes(after=after, rigid=np.array([False])).complementarity() == NONE


def test_what_another_contact_kicked_away_may_part() -> None:
    """The second pushes along the first one's normal: it may have come later, by 1 m/s."""
    after = np.array([[0.8, 0.0, 0.0], [0.0, 0.0, 0.0]])
    assert pushes(2, after=after).complementarity() == NONE
    same = pushes(2, after=after, names=np.zeros(2, int))  # one contact, in two poses
    assert same.complementarity().number == pytest.approx(0.8)


def test_friction_takes_what_slip_requires() -> None:
    """-mu n |w| of a slip that stays: half of it is 0.5 J too little at 2 m/s, and none 1 J."""
    slip = np.array([[0.0, FAST, 0.0]])
    for share in (0.0, 0.5, 1.0):
        impulses = np.array([[1.0, -share * 0.5, 0.0]])
        found = pushes(impulses=impulses, before=slip, after=slip).dissipation()
        assert found.number == pytest.approx((1.0 - share) * 0.5 * FAST)


def test_where_slip_may_have_stopped_friction_is_free() -> None:
    slip = np.array([[0.0, FAST, 0.0]])
    assert pushes(before=slip, after=-0.5 * slip).dissipation() == NONE


def test_energy_is_what_contacts_gave_before_or_after_forces() -> None:
    """1 N s through (0.5 + 1.5)/2 m/s; with forces first the bodies came towards it."""
    first, last = np.array([[0.5, 0.0, 0.0]]), np.array([[1.5, 0.0, 0.0]])
    assert pushes(before=first, free=first, after=last).energy().number == pytest.approx(1.0)
    assert pushes(before=first, free=-last, after=last).energy() == NONE


def test_impulses_are_chosen_where_several_may_break_less() -> None:
    after = np.array([[0.8, 0.0, 0.0]])
    assert not pushes(after=after).chooses()
    assert pushes(2, after=np.tile(after, (2, 1)), names=np.zeros(2, int)).chooses()
