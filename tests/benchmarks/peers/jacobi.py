"""Euler's exact angular velocity of a free body, from its moments and spin, by Jacobi's functions.

    I1 w1' = (I2 - I3) w2 w3   and cyclic, I1 < I2 < I3

Jacobi's functions sn, cn, dn of parameter m solve it (Landau and Lifshitz, Mechanics, section 37).
They are computed by the arithmetic-geometric mean (Abramowitz and Stegun, 16.4).
"""

from __future__ import annotations

import numpy as np

MEANS = 12  # the mean converges quadratically: far below round-off


def elliptic(u: np.ndarray, m: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return sn, cn and dn of `u` for the parameter 0 <= m < 1."""
    a, b, c = [1.0], np.sqrt(1.0 - m), [np.sqrt(m)]
    for _ in range(MEANS):
        a_new, c_new = 0.5 * (a[-1] + b), 0.5 * (a[-1] - b)
        b = np.sqrt(a[-1] * b)
        a.append(a_new)
        c.append(c_new)
    phi = 2.0**MEANS * a[-1] * u
    for k in range(MEANS, 0, -1):
        phi = 0.5 * (phi + np.arcsin(c[k] / a[k] * np.sin(phi)))
    sn = np.sin(phi)
    return sn, np.cos(phi), np.sqrt(1.0 - m * sn * sn)


def incomplete(s: float, c: float, m: float) -> float:
    """Return u with sn u = s and cn u = c, c >= 0: Legendre's F by Carlson's R_F."""
    x, y, z = c * c, 1.0 - m * s * s, 1.0
    for _ in range(60):
        shift = np.sqrt(x * y) + np.sqrt(y * z) + np.sqrt(z * x)
        x, y, z = (0.25 * (value + shift) for value in (x, y, z))
    return float(s / np.sqrt((x + y + z) / 3.0))


def body_rates(moments: np.ndarray, spin: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return the angular velocity in the body's frame, shape (times, 3) [rad/s].

    moments: ascending, all different [kg m^2]; spin: at t = 0, body frame, with positive first and
    third part and not on the separatrix [rad/s]; times [s].
    """
    i1, i2, i3 = moments
    energy2 = float(moments @ spin**2)
    momentum2 = float((moments * spin) @ (moments * spin))
    swapped = momentum2 < energy2 * i2  # the spin circles the first axis, not the third
    if swapped:
        i1, i3 = i3, i1
    w1 = np.sqrt((energy2 * i3 - momentum2) / (i1 * (i3 - i1)))
    w2 = np.sqrt((energy2 * i3 - momentum2) / (i2 * (i3 - i2)))
    w3 = np.sqrt((momentum2 - energy2 * i1) / (i3 * (i3 - i1)))
    rate = np.sqrt((i3 - i2) * (momentum2 - energy2 * i1) / (i1 * i2 * i3))
    m = (i2 - i1) * (energy2 * i3 - momentum2) / ((i3 - i2) * (momentum2 - energy2 * i1))
    first, second = (spin[2], spin[1]) if swapped else (spin[0], spin[1])
    # w2' = (I3 - I1) w3 w1 / I2 > 0 at the start: sn grows.
    start = incomplete(second / w2, first / w1, m)
    sn, cn, dn = elliptic(start + rate * times, m)
    along = (w3 * dn, w2 * sn, w1 * cn) if swapped else (w1 * cn, w2 * sn, w3 * dn)
    return np.column_stack(along)
