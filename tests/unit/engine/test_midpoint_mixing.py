"""Middles of a linear pass: the velocities that it leaves as they are, spins among them."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted, records

from lavendersim.engine.anderson import NO_ROUND, allocate_fixed_point
from lavendersim.engine.midpoint_mixing import NO_PASS, WORDS, make_mix_velocities
from lavendersim.engine.record_layout import allocate_velocities, body_dtype
from lavendersim.engine.records import PLANE, SPHERE
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("rotation",))
NAMES = ("vx", "vy", "vz", "wx", "wy", "wz")
BOUND = 0.02  # m
# A pass takes the velocities x of body 1 to ALONE + FACTOR x: by itself it parts from the end.
FACTOR = -1.2
ALONE = np.array([0.3, -0.1, 0.0, 7.0, 0.0, -2.0])


def passes(many: int, spec: Spec = SPEC) -> tuple[np.ndarray, list[int]]:
    """Return the velocities after so many passes, and the columns of each; body 0 is a plane."""
    mix = interpreted(make_mix_velocities(spec))
    bodies = np.zeros(2, body_dtype(SPEC))
    bodies["shape"], bodies["bound"] = (PLANE, SPHERE), (np.inf, BOUND)
    velocities, rounds = allocate_velocities(SPEC, 2), allocate_fixed_point(2 * WORDS)
    columns, found = NO_PASS, []
    for name, value in zip(NAMES, ALONE, strict=True):
        velocities[name][1] = value
    for _ in range(many):
        columns = mix(records(bodies), records(velocities), rounds, columns)
        found.append(columns)
        for name, value in zip(NAMES, ALONE, strict=True):
            velocities[name][1] = value + FACTOR * velocities[name][1]
    return np.array([velocities[name] for name in NAMES]), found


def test_the_third_middle_is_that_of_the_passes_before() -> None:
    """Of one eigenvalue: from there on passes leave the velocities as they are, to round-off."""
    velocities, columns = passes(4)
    assert columns == [NO_ROUND, 0, 1, 2]
    assert velocities[:, 1] == pytest.approx(ALONE / (1.0 - FACTOR), rel=1e-13, abs=1e-15)


def test_two_passes_leave_every_bit() -> None:
    velocities, _ = passes(2)
    twice = ALONE + FACTOR * (ALONE + FACTOR * ALONE)
    assert velocities[:, 1].tolist() == twice.tolist()


def test_what_does_not_move_stays_at_rest() -> None:
    velocities, _ = passes(6)
    assert velocities[:, 0].tolist() == [0.0] * WORDS
