"""Jacobi's functions and the integral of the first kind against their limits and identities."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import special

from lavendersim.measures.elliptic import integral, jacobi, quarter_period

PARAMETERS = [1.0, 0.7, 0.1, 1e-4, 1e-9]


@pytest.mark.parametrize("m1", PARAMETERS)
def test_quarter_period_is_scipys(m1: float) -> None:
    assert quarter_period(m1) == pytest.approx(special.ellipkm1(m1), rel=1e-14)


def test_quarter_period_of_the_lemniscate_by_the_gamma_function() -> None:
    known = math.gamma(0.25) ** 2 / (4.0 * math.sqrt(math.pi))  # K(1/2), Gauss
    assert quarter_period(0.5) == pytest.approx(known, rel=1e-15)


@pytest.mark.parametrize("m1", PARAMETERS)
def test_squares_sum_to_one(m1: float) -> None:
    sn, cn, dn = jacobi(np.linspace(-9.0, 9.0, 41), m1)
    assert sn**2 + cn**2 == pytest.approx(np.ones(41), abs=1e-15)
    assert dn**2 + (1.0 - m1) * sn**2 == pytest.approx(np.ones(41), abs=1e-14)


def test_limits_are_circular_and_hyperbolic() -> None:
    u = np.linspace(-3.0, 3.0, 13)
    assert jacobi(u, 1.0)[0] == pytest.approx(np.sin(u), abs=1e-15)
    assert jacobi(u, 0.0)[0] == pytest.approx(np.tanh(u), abs=1e-15)
    assert jacobi(u, 0.0)[1] == pytest.approx(1.0 / np.cosh(u), abs=1e-15)


@pytest.mark.parametrize("m1", PARAMETERS[1:4])
@pytest.mark.parametrize("phase", [0.1, 1.2, math.pi / 2.0, 2.5, -1.9])
def test_sine_of_the_amplitude_is_inverse_to_the_integral(phase: float, m1: float) -> None:
    u = integral(phase, m1)
    sn, cn, _ = jacobi(np.array([u]), m1)
    # du/dphi = 1 / dn, at most 100 of these: u's round-off, some 1e-15, is felt a hundredth of it.
    assert (sn[0], cn[0]) == pytest.approx((math.sin(phase), math.cos(phase)), abs=1e-14)


def test_integral_to_a_half_turn_is_two_quarter_periods() -> None:
    assert integral(math.pi, 0.3) == pytest.approx(2.0 * quarter_period(0.3), rel=1e-14)
