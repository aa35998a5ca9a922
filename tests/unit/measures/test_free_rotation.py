"""Jacobi's solution against scipy's functions and an integrator of high order."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipj, ellipkinc, ellipkm1

from lavendersim.measures.elliptic import integral, jacobi, quarter_period
from lavendersim.measures.free_rotation import free_rotation

# sorted and unsorted, near both stable axes and the unstable one, both senses, equal moments
CASES = [
    ((1.0, 2.0, 3.0), (0.01, 5.0, 0.01)),
    ((1.0, 2.0, 3.0), (0.01, -5.0, -0.01)),
    ((2.0, 1.0, 3.0), (5.0, 0.01, 0.01)),
    ((3.0, 2.0, 1.0), (0.01, 5.0, -0.01)),
    ((2.0, 3.0, 1.0), (0.3, -0.2, 1.5)),
    ((1.0, 2.0, 3.0), (2.0, 0.3, 0.1)),
    ((1.0, 2.0, 3.0), (0.1, 0.3, -2.0)),
    ((1.0, 2.0, 3.0), (0.0, 1.0, 2.0)),
    ((1.0, 1.0, 2.0), (1.0, 2.0, 3.0)),
    ((1.0, 2.0, 2.0), (1.0, 2.0, 3.0)),
    ((1.0, 2.0, 2.0), (0.0, 2.0, 3.0)),
    ((2.0, 2.0, 2.0), (1.0, 2.0, 3.0)),
    ((1.0, 2.0, 3.0), (0.0, 2.0, 0.0)),
    ((1.0, 2.0, 2.25), (0.75, 0.5, 1.0)),  # on the separatrix, without round-off
    ((1.0, 2.0, 2.25), (-0.75, 0.5, 1.0)),
    ((1.0, 2.0, 2.25), (0.75, 0.5, -1.0)),
]


@pytest.mark.parametrize("m1", [1.0, 0.9, 0.5, 0.1, 1e-3, 1e-5, 8e-6])
def test_elliptic_functions_are_those_of_scipy(m1: float) -> None:
    period = quarter_period(m1)
    assert period == pytest.approx(ellipkm1(m1), rel=5e-16)
    u = np.linspace(-5.0 * period, 5.0 * period, 1001)
    # scipy takes m = 1 - m1, whose last digit is 1.1e-16: that moves its period by 1.1e-16/(2 m1)
    # and its functions by ten times that over five periods
    lost = 1e-14 + 5.0 * 1.1e-16 / m1
    for ours, theirs in zip(jacobi(u, m1), ellipj(u, 1.0 - m1)[:3], strict=True):
        np.testing.assert_allclose(ours, theirs, atol=lost)
    phases = np.linspace(-3.1, 3.1, 41)
    ours = [integral(float(phase), m1) for phase in phases]
    np.testing.assert_allclose(ours, ellipkinc(phases, 1.0 - m1), atol=lost * period)


@pytest.mark.parametrize("m1", [0.7, 1e-3, 1e-6, 1e-9])
def test_integral_and_functions_are_inverse_to_each_other(m1: float) -> None:
    period = quarter_period(m1)
    u = np.linspace(-1.99 * period, 1.99 * period, 101)
    sn, cn, dn = jacobi(u, m1)
    back = [integral(math.atan2(s, c), m1) for s, c in zip(sn, cn, strict=True)]
    # near u = K the phase is blind to u: du = dphase/dn, and dn is as small as sqrt(m1)
    np.testing.assert_allclose(np.abs(back - u) * dn, 0.0, atol=1e-15 * period)


@pytest.mark.parametrize(("moments", "omega"), CASES)
def test_the_solution_solves_eulers_equations(
    moments: tuple[float, ...], omega: tuple[float, ...]
) -> None:
    i1, i2, i3 = moments

    def rates(_: float, w: Any) -> list[float]:
        return [
            (i2 - i3) * w[1] * w[2] / i1,
            (i3 - i1) * w[2] * w[0] / i2,
            (i1 - i2) * w[0] * w[1] / i3,
        ]

    times = np.linspace(0.0, 6.0, 61)
    found = solve_ivp(rates, (0.0, 6.0), omega, "DOP853", times, rtol=1e-13, atol=1e-15).y.T
    exact = free_rotation(np.array(moments), np.array(omega)).angular_velocity(times)
    # the integrator's own error, grown by exp(rate t) < 1e5 beside the unstable axis
    np.testing.assert_allclose(exact, found, atol=2e-9)


def test_flips_are_where_the_middle_component_vanishes_once_each_half_period() -> None:
    exact = free_rotation(np.array([1.0, 2.0, 3.0]), np.array([0.01, 5.0, 0.01]))
    flips = exact.flip_times(12)
    assert np.all(np.diff(flips) > 0.0)
    assert flips[0] > 0.0
    around = np.concatenate([flips - 1e-4, flips, flips + 1e-4])
    before, at, after = exact.angular_velocity(around)[:, 1].reshape(3, 12)
    np.testing.assert_allclose(at, 0.0, atol=1e-11)  # 14 rad/s^2 times round-off of 60 s
    assert np.all(before * after < 0.0)
    scan = exact.angular_velocity(np.linspace(0.0, flips[-1] + 1e-4, 5001))[:, 1]
    assert np.count_nonzero(np.diff(np.sign(scan))) == 12
    # K = ln(4/sqrt(m1)) for small m1, and a flip every 2 K/rate
    rate = math.sqrt(50.0006 / 6.0)
    half = 2.0 * math.log(4.0 / math.sqrt(8e-6)) / rate
    assert np.diff(flips) == pytest.approx(np.full(11, half), rel=1e-5)  # next term: m1 K/4


@pytest.mark.parametrize(("moments", "omega"), CASES)
@pytest.mark.parametrize("of_omega", [-1000, -500, 500, 1000])
@pytest.mark.parametrize("of_moments", [-500, 0, 500])
def test_other_units_change_no_bit(
    moments: tuple[float, ...], omega: tuple[float, ...], of_omega: int, of_moments: int
) -> None:
    # moments of 1e150 kg m^2 are of the largest box there is; a spin may be any double
    plain = free_rotation(np.array(moments), np.array(omega))
    seen = free_rotation(np.ldexp(moments, of_moments), np.ldexp(omega, of_omega))
    assert (seen.order, seen.phase, seen.m1) == (plain.order, plain.phase, plain.m1)
    assert seen.rate == math.ldexp(plain.rate, of_omega)
    assert np.array_equal(seen.amplitudes, np.ldexp(plain.amplitudes, of_omega))


def test_the_solution_begins_as_asked_whatever_the_sizes() -> None:
    random = np.random.default_rng(3)
    for number in range(400):
        last = 1.0 + 2.2e-16 * random.integers(-3, 4)  # equal to another one but for round-off
        moments = [1.0, last, random.uniform(0.1, 1.9)] if number % 2 else [0.5, 0.8, 1.0]
        sizes = 10.0 ** random.uniform(-60.0, 60.0, 3) if number % 3 else np.ones(3)
        omega = random.normal(size=3) * sizes
        exact = free_rotation(random.permutation(moments), omega)
        largest = float(np.abs(omega).max())
        # near the separatrix digits are lost, as `elliptic` says: no more than half of them
        np.testing.assert_allclose(
            exact.angular_velocity(np.zeros(1))[0] / largest, omega / largest, atol=1e-7
        )


@pytest.mark.parametrize(
    ("phase", "m1"),
    [(math.nan, 0.5), (1.0, math.nan), (2.0, math.nan), (1.0, math.inf), (math.inf, 0.5), (1, -1)],
)
def test_the_integral_of_what_is_no_number_is_none(phase: float, m1: float) -> None:
    assert math.isnan(integral(phase, m1))


def test_rates_beyond_all_numbers_leave_what_is_none() -> None:
    """Pytest makes errors of numpy's warnings."""
    motion = free_rotation(np.array([1e-3, 0.5, 1.0]), np.array([1e308] * 3))
    assert motion.rate == math.inf
    assert np.isnan(motion.angular_velocity(np.array([1.0]))).all()
