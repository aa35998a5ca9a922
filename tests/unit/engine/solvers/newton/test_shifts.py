"""Shifts that answer each other through their slips are brought to their fixed point together."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.engine.anderson import NO_ROUND, allocate_fixed_point
from lavendersim.engine.record_layout import allocate_velocities, contact_dtype
from lavendersim.engine.solvers.newton.response import update_shift
from lavendersim.engine.solvers.newton.shifts import make_shift_together
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("friction", "newton", "rotation"), solver="adaptive")
CONTACTS = 4
MU = 0.5
# Slips 0.1 + A s of all contacts, by the shifts of all. Of A the largest eigenvalue is 0.95: rounds
# alone leave 95 % of the error each. The others are all 0.35.
ANSWER = 0.35 * np.eye(CONTACTS) + 0.15 * np.ones((CONTACTS, CONTACTS))
ALONE = np.full(CONTACTS, 0.1) * np.array([1.0, 0.5, 0.8, 0.3])


class Rounds:
    """Contacts of a fixed body with others, one each, that slip at mu |v| = ALONE + A s."""

    def __init__(self) -> None:
        self.contacts = np.zeros(CONTACTS, contact_dtype(SPEC)).view(np.recarray)
        self.contacts.b = np.arange(CONTACTS) + 1
        self.contacts.mu, self.contacts.t1x, self.contacts.nz = MU, 1.0, 1.0
        self.contacts.t2y = 1.0
        self.velocities = allocate_velocities(SPEC, CONTACTS + 1).view(np.recarray)
        self.shifts = allocate_fixed_point(CONTACTS)
        self.together, self.kept = make_shift_together(SPEC), NO_ROUND

    def slip(self) -> np.ndarray:
        return ALONE + ANSWER @ self.contacts.shift

    def plain(self) -> None:
        for contact, slip in zip(self.contacts, self.slip(), strict=True):
            update_shift(contact, slip, False)

    def joint(self) -> None:
        self.velocities.vx[1:] = self.slip() / MU
        self.kept = self.together(self.contacts, CONTACTS, self.velocities, self.shifts, self.kept)


END = np.linalg.solve(np.eye(CONTACTS) - ANSWER, ALONE)


def test_rounds_alone_leave_a_share_of_the_error() -> None:
    rounds = Rounds()
    for _ in range(10):
        rounds.plain()
    off = np.abs(rounds.contacts.shift - END).max()
    assert off > 0.9 * 0.95**10 * END.min()


def test_columns_of_two_rounds_end_a_linear_answer_of_two_eigenvalues() -> None:
    """Defects of a linear answer lie in a space of as many directions as it has eigenvalues: two.
    Two columns leave none of them, to round-off over 1 - 0.95.
    """
    rounds = Rounds()
    rounds.plain()
    for _ in range(4):
        rounds.joint()
    assert rounds.contacts.shift == pytest.approx(END, rel=1e-10)


def test_no_shift_falls_below_zero_and_none_is_lost_at_the_end() -> None:
    """At the fixed point defects are zero: nothing is divided by them, and nothing moves."""
    rounds = Rounds()
    rounds.plain()
    rounds.plain()
    for _ in range(12):
        rounds.joint()
        assert (rounds.contacts.shift >= 0.0).all()
    assert rounds.contacts.shift == pytest.approx(END, rel=1e-10)


def test_without_friction_there_are_no_shifts() -> None:
    assert make_shift_together(Spec(effects=("newton", "rotation"), solver="adaptive")) is None
