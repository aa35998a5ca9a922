"""Jacobi's elliptic functions and the incomplete integral of the first kind, by means.

The complementary parameter m1 = 1 - m goes in, not m: near the separatrix (m1 = 1e-6 and less) m
has lost the digits that decide the period. Descending Landen steps are those of the arithmetic-
geometric mean (Abramowitz and Stegun 16.4), the integral is Carlson's R_F by duplication (Carlson
1995, "Numerical computation of real or complex elliptic integrals"). To round-off down to
m1 = 1e-9; nearer the separatrix the last descending step loses digits.
"""

from __future__ import annotations

import math

import numpy as np

from lavendersim.measures.interfaces import Floats

MOST_HALVINGS = 30  # each step of the mean squares the distance; 6 are typical, 10 much


def quarter_period(m1: float) -> float:
    """Return K(m) for m1 = 1 - m in (0, 1]."""
    return math.pi / 2.0 / _means(m1)[0][-1]


def jacobi(u: Floats, m1: float) -> tuple[Floats, Floats, Floats]:
    """Return sn, cn, dn of u for m1 = 1 - m in [0, 1]; at m1 = 0 tanh, sech, sech."""
    u = np.asarray(u, dtype=np.float64)
    if m1 == 0.0:
        return np.tanh(u), 1.0 / np.cosh(u), 1.0 / np.cosh(u)
    means, gaps = _means(m1)
    # one period only: the phase below is doubled with every step, and its round-off with it
    period = 2.0 * math.pi / means[-1]
    u = np.remainder(u + period / 2.0, period) - period / 2.0
    phase = 2.0 ** (len(means) - 1) * means[-1] * u
    for mean, gap in zip(means[:0:-1], gaps[:0:-1], strict=True):
        phase = 0.5 * (phase + np.arcsin(np.clip(gap / mean * np.sin(phase), -1.0, 1.0)))
    sn, cn = np.sin(phase), np.cos(phase)
    # dn^2 = 1 - m sn^2, without the cancelling near sn = 1
    return sn, cn, np.sqrt(m1 * sn * sn + cn * cn)


def integral(phase: float, m1: float) -> float:
    """Return F(phase | m), the u whose amplitude is this phase, for |phase| <= pi.

    NaN of what is not finite, and of m1 < 0.
    """
    if not (math.isfinite(phase) and 0.0 <= m1 < math.inf):
        return math.nan  # the means below would never meet
    if abs(phase) > math.pi / 2.0:
        return math.copysign(2.0 * quarter_period(m1), phase) - integral(
            math.copysign(math.pi, phase) - phase, m1
        )
    sine, cosine = math.sin(phase), math.cos(phase)
    return sine * _carlson(cosine * cosine, m1 * sine * sine + cosine * cosine, 1.0)


def _means(m1: float) -> tuple[list[float], list[float]]:
    """Return the arithmetic means and half differences on the way to their common limit."""
    a, b = 1.0, math.sqrt(m1)
    means, gaps = [a], [math.sqrt(1.0 - m1)]
    for _ in range(MOST_HALVINGS):
        if abs(gaps[-1]) <= 1e-17 * a:
            break
        a, b, gap = 0.5 * (a + b), math.sqrt(a * b), 0.5 * (a - b)
        means.append(a)
        gaps.append(gap)
    return means, gaps


def _carlson(x: float, y: float, z: float) -> float:
    """Return R_F(x, y, z), at most one argument 0."""
    while True:
        mean = (x + y + z) / 3.0
        # the series below is cut at sixth order: (1e-3)^6 is below round-off
        if max(abs(x - mean), abs(y - mean), abs(z - mean)) < 1e-3 * mean:
            break
        root = math.sqrt(x * y) + math.sqrt(y * z) + math.sqrt(z * x)
        x, y, z = 0.25 * (x + root), 0.25 * (y + root), 0.25 * (z + root)
    dx, dy, dz = 1.0 - x / mean, 1.0 - y / mean, 1.0 - z / mean
    e2, e3 = dx * dy - dz * dz, dx * dy * dz
    return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / math.sqrt(mean)
