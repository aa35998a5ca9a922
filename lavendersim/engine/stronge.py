"""Stronge's law of restitution: the separation speed of one impact, from the work of compression.

The impulse grows from nothing, and with it the contact's velocity, friction being Coulomb's:
    du = K (dlambda_t, dlambda_n),   dlambda_t = -mu dlambda_n u_t / |u_t| while it slips,
                                     what keeps u_t = 0 while friction can.
Compression lasts until u_n = 0 and does the work W_c < 0 along the normal; the surfaces leave when
restitution has given back e^2 |W_c|. Work is shared out, so no friction can make it a gain. Other
contacts of the two bodies are taken to give nothing meanwhile.
"""

from __future__ import annotations

from math import sqrt

from .compile import kernel
from .spec import Spec

# Parts of the impulse that would stop the approach without friction; a slip that turns is followed
# to second order in one part, one that does not turn exactly.
PARTS = 256
# Parts until restitution ends; friction that jams the contact lengthens its compression.
MOST_PARTS = 64 * PARTS
# Slower than this share of the approach is no slip [-].
STILL = 1e-12
# A slip that comes this near to 0, squared, of what it changes in one part has stopped [-].
STOPPED = 1e-6


def make_direction(spec: Spec):
    """Return `kernel(contact, u_1, u_2, still) -> (s_1, s_2)`: dlambda_t per dlambda_n."""

    def direction(contact, u_1, u_2, still):
        speed = sqrt(u_1 * u_1 + u_2 * u_2)
        if speed > still:
            return -contact.mu * u_1 / speed, -contact.mu * u_2 / speed
        # What holds the point: K_tt s = -k_tn, with the inverse of K_tt that the row keeps.
        s_1 = -(contact.i_11 * contact.k_n1 + contact.i_12 * contact.k_n2)
        s_2 = -(contact.i_12 * contact.k_n1 + contact.i_22 * contact.k_n2)
        size = sqrt(s_1 * s_1 + s_2 * s_2)
        if size > contact.mu:
            s_1, s_2 = s_1 * contact.mu / size, s_2 * contact.mu / size
        return s_1, s_2

    return kernel(direction, spec)


def make_leave(spec: Spec):
    """Return `kernel(contact, u_1, u_2) -> (u_n, ended)`: the separation speed [m/s].

    u_1, u_2: slip when they meet; contact.approach_speed: how fast they do. 0.0 and False where
    restitution has not ended after MOST_PARTS.
    """
    direction = make_direction(spec)

    def leave(contact, u_1, u_2):
        det = contact.i_11 * contact.i_22 - contact.i_12 * contact.i_12
        k_11, k_12, k_22 = contact.i_22 / det, -contact.i_12 / det, contact.i_11 / det
        u_n = -contact.approach_speed
        part = contact.approach_speed / (contact.k_n * PARTS)
        still = STILL * contact.approach_speed
        work, back = 0.0, 0.0
        compressing = True
        for _ in range(MOST_PARTS):
            s_1, s_2 = direction(contact, u_1, u_2, still)
            rate_1 = contact.k_n1 + k_11 * s_1 + k_12 * s_2
            rate_2 = contact.k_n2 + k_12 * s_1 + k_22 * s_2
            if u_1 * u_1 + u_2 * u_2 > still * still:
                half_1, half_2 = u_1 + 0.5 * part * rate_1, u_2 + 0.5 * part * rate_2
                if half_1 * u_1 + half_2 * u_2 > 0.0:
                    s_1, s_2 = direction(contact, half_1, half_2, still)
                    rate_1 = contact.k_n1 + k_11 * s_1 + k_12 * s_2
                    rate_2 = contact.k_n2 + k_12 * s_1 + k_22 * s_2
            rate = contact.k_n + contact.k_n1 * s_1 + contact.k_n2 * s_2
            step = part
            # A slip that would turn round within the part stops where it is slowest.
            stops = False
            closing = u_1 * rate_1 + u_2 * rate_2
            squared = rate_1 * rate_1 + rate_2 * rate_2
            if closing < 0.0:
                if -closing <= squared * part:
                    step, stops = -closing / squared, True
            if compressing:
                if u_n + rate * step >= 0.0:
                    step, stops = -u_n / rate, False
                    work += 0.5 * u_n * step
                    u_n, compressing = 0.0, False
                    u_1, u_2 = u_1 + rate_1 * step, u_2 + rate_2 * step
                    if contact.e == 0.0:
                        return 0.0, True
                    continue
                work += (u_n + 0.5 * rate * step) * step
            else:
                gain = (u_n + 0.5 * rate * step) * step
                left = -contact.e * contact.e * work - back
                if gain >= left:
                    return sqrt(max(u_n * u_n + 2.0 * rate * left, 0.0)), True
                back += gain
            u_n += rate * step
            u_1, u_2 = u_1 + rate_1 * step, u_2 + rate_2 * step
            if stops:
                if u_1 * u_1 + u_2 * u_2 <= STOPPED * squared * part * part:
                    u_1, u_2 = 0.0, 0.0
        return 0.0, False

    return kernel(leave, spec)
