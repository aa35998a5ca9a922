"""Functions of time: values by numpy's interpolation, means by quadrature, rates by differences."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from interpreted import interpreted, records
from scipy.integrate import quad

from lavendersim.engine import drives
from lavendersim.engine.records import DRIVE, KNOT, STRETCH, dtype
from lavendersim.engine.spec import Spec

value, rates, mean, last_knot, begin = (
    interpreted(make(Spec()))
    for make in (
        drives.make_value,
        drives.make_rates,
        drives.make_mean,
        drives.make_last_knot,
        drives.make_begin_of_part,
    )
)
TIMES, VALUES = np.array([0.5, 1.0, 1.0, 2.5]), np.array([2.0, -1.0, 3.0, 1.0])  # a jump at 1 s
SLOPE, AMPLITUDE, OMEGA, PHASE = -0.7, 0.4, 5.0, 0.3


def drive_of(amplitude=AMPLITUDE, first=2):
    """Return (drive, knots): other knots stand before and behind its own."""
    knots, drive = np.zeros(8, dtype(KNOT)), np.zeros(1, dtype(DRIVE))
    knots["time"], knots["value"] = 77.0, 99.0
    knots["time"][:first] = -5.0
    knots["time"][first : first + 4], knots["value"][first : first + 4] = TIMES, VALUES
    drive["first"], drive["count"], drive["slope"] = first, 4, SLOPE
    drive["amplitude"], drive["omega"], drive["phase"] = amplitude, OMEGA, PHASE
    return records(drive)[0], records(knots)


def exact(t: float, amplitude=AMPLITUDE) -> float:
    """Return f(t), right of the jump at it."""
    if t < 1.0:
        line = np.interp(t, TIMES[:2], VALUES[:2])
    else:
        line = np.interp(t, TIMES[2:], VALUES[2:])
    line += SLOPE * max(t - 2.5, 0.0)
    return float(line + amplitude * np.sin(OMEGA * t + PHASE))


@pytest.mark.parametrize("t", [0.0, 0.5, 0.7, 0.999, 1.0, 1.7, 2.5, 4.0])
def test_values_are_lines_between_knots_and_a_sine(t: float) -> None:
    for amplitude in (0.0, AMPLITUDE):
        assert value(*drive_of(amplitude), t) == pytest.approx(exact(t, amplitude), abs=1e-14)


@pytest.mark.parametrize("time", [-5.0, 77.0])
def test_before_its_first_knot_stands_the_one_before_whatever_that_is(time: float) -> None:
    """Knots of another drive stand there."""
    drive, knots = drive_of()
    knots.array["time"][:2] = time
    assert last_knot(drive, knots, 0.1) == 1


def test_the_last_knot_is_the_last_of_those_at_one_time() -> None:
    drive, knots = drive_of()
    for t, expected in ((0.1, 1), (0.5, 2), (0.9, 2), (1.0, 4), (2.5, 5), (9.0, 5)):
        assert last_knot(drive, knots, t) == expected


@pytest.mark.parametrize(
    ("t", "h"), [(0.0, 0.3), (0.6, 0.2), (0.2, 3.0), (0.9, 0.3), (2.6, 1.0), (0.99999, 1e-4)]
)
def test_means_are_integrals_over_the_step_to_the_last_digit(t: float, h: float) -> None:
    points = [p for p in TIMES if t < p < t + h]
    for amplitude in (0.0, AMPLITUDE):
        total, _ = quad(exact, t, t + h, args=(amplitude,), points=points or None, epsabs=1e-13)
        assert mean(*drive_of(amplitude), t, h) == pytest.approx(total / h, abs=1e-11)


@pytest.mark.parametrize("t", [0.2, 0.7, 1.7, 3.0])
def test_rates_are_the_derivatives_between_bends(t: float) -> None:
    """Central differences over 1e-3 s: second order, errors below 1e-3 of (a omega^5 = 1250)."""
    found, e = rates(*drive_of(), t, True), 1e-3
    f = {k: exact(t + k * e) for k in (-2, -1, 0, 1, 2)}
    first = (f[1] - f[-1]) / (2 * e)
    second = (f[1] - 2 * f[0] + f[-1]) / e**2
    third = (f[2] - 2 * f[1] + 2 * f[-1] - f[-2]) / (2 * e**3)
    assert found == pytest.approx((first, second, third), abs=2e-3)


def test_at_a_bend_rates_are_those_after_it_or_before() -> None:
    for t, before, after in ((0.5, 0.0, -6.0), (1.0, -6.0, -2.0 / 1.5), (2.5, -2.0 / 1.5, SLOPE)):
        swing = AMPLITUDE * OMEGA * np.cos(OMEGA * t + PHASE)
        assert rates(*drive_of(), t, True)[0] == pytest.approx(after + swing, abs=1e-14)
        assert rates(*drive_of(), t, False)[0] == pytest.approx(before + swing, abs=1e-14)


def test_a_part_begins_where_whole_steps_since_the_last_change_and_earlier_parts_end() -> None:
    parameters = np.zeros(1, dtype(STRETCH, [("timestep", "f8")]))
    counters = np.zeros(1, dtype([("step", "i8"), ("elapsed", "f8")]))
    parameters[0], counters[0] = (10, 2.0, 0.01), (15, 0.004)
    assert begin(records(parameters)[0], records(counters)[0]) == pytest.approx(2.054, abs=1e-15)


def test_the_next_knot_is_the_first_of_all_drives_that_is_not_there_yet() -> None:
    """But for round-off: what ends at a knot begins at it, however its time was summed up."""
    knots, pair = np.zeros(8, dtype(KNOT)), np.zeros(2, dtype(DRIVE))
    knots["time"][:2], knots["time"][2:6] = (0.0, 0.75), TIMES
    pair["first"], pair["count"] = (0, 2), (2, 4)
    both = SimpleNamespace(records=records(pair), knots=records(knots))
    find = interpreted(drives.make_next_knot(Spec()))
    for t, expected in ((0.1, 0.5), (0.5 - 1e-13, 0.75), (0.5, 0.75), (0.8, 1.0), (1.0, 2.5)):
        assert find(both, t, 9.0) == expected
    assert find(both, 0.1, 0.4) == 0.4  # what comes first
    assert find(both, 3.0, 9.0) == 9.0


def test_substeps_that_end_at_a_bend_but_for_round_off_have_the_rates_of_their_own_side() -> None:
    """Of steps of one length the sides are those of the times as they are."""
    in_substeps = interpreted(drives.make_rates(Spec(effects=("error_control",))))
    drive, knots = drive_of(0.0)
    before, behind = (-1.0 - 2.0) / 0.5, (1.0 - 3.0) / 1.5
    for t in (1.0 - 1e-13, 1.0, 1.0 + 1e-13):
        assert in_substeps(drive, knots, t, False)[0] == pytest.approx(before)
        assert in_substeps(drive, knots, t, True)[0] == pytest.approx(behind)
    assert rates(drive, knots, 1.0 + 1e-13, False)[0] == pytest.approx(behind)
