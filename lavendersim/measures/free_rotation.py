"""Free rotation of a rigid body, exactly: Jacobi's solution of Euler's equations.

Euler's equations I1 w1' = (I2 - I3) w2 w3 (cyclic), I1 <= I2 <= I3, have with the invariants
2E = sum I w^2, L^2 = sum I^2 w^2 and L^2 >= 2 E I2 the solution (Landau and Lifshitz, section 37)
    w1 = s A1 cn(tau), w2 = A2 sn(tau), w3 = s A3 dn(tau),   s = sign of w3, tau = rate t + tau0,
    A1^2 = P/(I1 (I3 - I1)), A2^2 = P/(I2 (I3 - I2)), A3^2 = Q/(I3 (I3 - I1)),
    rate^2 = (I3 - I2) Q/(I1 I2 I3),  1 - m = (I3 - I1) D/((I3 - I2) Q),
    P = 2 E I3 - L^2,  Q = L^2 - 2 E I1,  D = L^2 - 2 E I2.
P, Q and D are summed as differences of moments, which do not cancel. They are taken in units in
which the largest moment and the largest |w| are about 1, powers of two apart, so that no product of
them is beyond the numbers of 64 bits. For D < 0 the axes 1 and 3
change places, and s w1 its sign. An exchange of two axes is a reflection, in which angular
velocities change their sign.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from lavendersim.measures.elliptic import integral, jacobi, quarter_period
from lavendersim.measures.interfaces import Floats

# Rates beyond all numbers are infinite, and what turns by them is no number: a measure says so.
_beyond_numbers = np.errstate(over="ignore", invalid="ignore")


@dataclass(frozen=True)
class FreeRotation:
    """The exact motion of a torque-free body in its own principal axes."""

    order: tuple[int, int, int]  # the body's axes in the order 1, 2, 3 of the formula
    amplitudes: Floats  # (3,) [rad/s], with their signs
    rate: float  # [1/s]
    phase: float  # tau at time 0
    m1: float  # complementary parameter 1 - m

    @_beyond_numbers
    def angular_velocity(self, time: Floats) -> Floats:
        """Return omega in body axes [rad/s] (n, 3) at these times [s]."""
        sn, cn, dn = jacobi(self.rate * np.asarray(time) + self.phase, self.m1)
        omega = np.empty((len(sn), 3))
        for axis, amplitude, shape in zip(self.order, self.amplitudes, (cn, sn, dn), strict=True):
            omega[:, axis] = amplitude * shape
        return omega

    def flip_times(self, count: int) -> Floats:
        """Return the first times [s] > 0 at which omega about the middle axis is 0 (sn = 0)."""
        if self.m1 == 0.0 or self.rate == 0.0 or self.amplitudes[1] == 0.0:
            return np.zeros(0)  # omega is constant, or the motion has no period
        half = 2.0 * quarter_period(self.m1)
        first = math.floor(self.phase / half) + 1
        turns = half * np.arange(first, first + count, dtype=np.float64)
        times: Floats = (turns - self.phase) / self.rate
        return times

    @property
    def middle_axis(self) -> int:
        """Index of the body's axis with the middle moment."""
        return self.order[1]


@_beyond_numbers
def free_rotation(moments: Floats, omega: Floats) -> FreeRotation:
    """Return the motion that starts with omega in body axes [rad/s], all moments above 0."""
    exponent = math.frexp(float(np.max(np.abs(omega))))[1]
    # of moments only their ratios count, a time is in turns of omega
    moments = np.ldexp(moments, -math.frexp(float(np.max(moments)))[1])
    scaled = _scaled_rotation(moments, np.ldexp(omega, -exponent))
    return replace(
        scaled,
        amplitudes=np.ldexp(scaled.amplitudes, exponent),
        rate=float(np.ldexp(scaled.rate, exponent)),
    )


def _scaled_rotation(moments: Floats, omega: Floats) -> FreeRotation:
    """Return the motion; the largest moment and the largest |omega| are from 1/2 to 1."""
    order = [int(axis) for axis in np.argsort(moments, kind="stable")]
    middle = float(moments[order[1]])
    if float(np.sum(moments * (moments - middle) * omega**2)) < 0.0:
        order.reverse()
    i1, i2, i3 = (float(moments[axis]) for axis in order)
    side = 1.0 if (order[1] - order[0]) % 3 == 1 else -1.0  # -1 where the axes are a reflection
    w1, w2, w3 = (side * float(omega[axis]) for axis in order)
    # with axes 1 and 3 exchanged every difference of moments, and so P, Q, D, changes its sign
    p = i1 * (i3 - i1) * w1**2 + i2 * (i3 - i2) * w2**2
    q = i2 * (i2 - i1) * w2**2 + i3 * (i3 - i1) * w3**2
    d = i1 * (i1 - i2) * w1**2 + i3 * (i3 - i2) * w3**2
    still = p == 0.0 or q == 0.0 or i3 == i2 or (w1 == 0.0 and w3 == 0.0)  # omega is constant
    if still:  # sn and cn of a constant phase, dn = 1
        a1 = a2 = math.hypot(w1, w2)
        a3, rate, m1 = abs(w3), 0.0, 1.0
    else:
        a1 = math.sqrt(p / (i1 * (i3 - i1)))
        a2 = math.sqrt(p / (i2 * (i3 - i2)))
        a3 = math.sqrt(q / (i3 * (i3 - i1)))
        rate = math.sqrt((i3 - i2) * q / (i1 * i2 * i3))
        m1 = min((i3 - i1) * d / ((i3 - i2) * q), 1.0)  # round-off, where i1 = i2 but for it
    # I1 w1' = (I2 - I3) w2 w3 requires this product of the three signs
    product = math.copysign(1.0, i3 - i2)
    s3 = math.copysign(1.0, w3)
    # on the separatrix cn = dn > 0: the sign of w1 is its own, and that of w2 follows
    s2 = product * math.copysign(1.0, w1 * w3) if m1 == 0.0 else 1.0
    s1 = product * s2 * s3
    start = math.atan2(s2 * w2 / a2, s1 * w1 / a1) if a2 > 0.0 else 0.0
    return FreeRotation(
        (order[0], order[1], order[2]),
        side * np.array([s1 * a1, s2 * a2, s3 * a3]),
        rate,
        integral(start, m1),
        m1,
    )
