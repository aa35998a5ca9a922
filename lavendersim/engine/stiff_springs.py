"""Contact springs that a step does not resolve: what meets there has an impact, by their damping.

    x = dt/sqrt(m c) > 2
A bounce on a spring lasts less than pi sqrt(m c), half a step or so, and bodies that move by the
mean of the velocities at a step's ends would stop, or be thrown, by where in the step they meet.
With a spring and a damper alone,
    d'' + 2 zeta w d' + w^2 d = 0,   d = 0, d' = v as they meet,   they part where d'' = 0:
nothing pulls. Each derivative of exp(-zeta w t) sin(w_d t) turns its phase by -a, cos a = zeta, so
they part at w_d t = 2 a, and with
    e = exp(-2 a cot a),   a = acos zeta;   zeta > 1: exp(-2 a coth a), a = acosh zeta
of their speed: 1 without damping, exp(-2) = 0.135 at zeta = 1. An impact lasts an instant, in which
nothing is pressed in. Slower than an impact is the spring's own law has them (`foreseen_impacts`),
and so has what is pressed: it rests at its load times c.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from .compile import inner, kernel
from .effects import made_once
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms

# dt^2/(m c) above which steps do not resolve a swing, as in `spring_midpoint`.
FAST = 4.0
# How often an angle is halved, and an exponent, until a few terms of their series have all digits.
HALVINGS, SQUARINGS = 6, 10


@inner
def decay(y):
    """Return exp(-y), y >= 0, by sums and products, whose bits are the same on every machine."""
    x = -y / 1024.0  # 2^SQUARINGS
    part = 1.0 + x / 5.0 * (1.0 + x / 6.0 * (1.0 + x / 7.0))
    power = 1.0 + x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0 * part)))
    for _ in range(SQUARINGS):
        power *= power
    return power


@inner
def rebound(ratio):
    """Return e, the share of the speed that a damped spring gives back; ratio: zeta [-].

    By u = 1 - cos a, of any zeta: u/2/(1 + sqrt(1 - u/2)) is that of the half of the angle, and
    a^2 = 2 u + u^2/3 + 4 u^3/45 + u^4/35 + ...
    """
    u, squared = 1.0 - ratio, 1.0  # a^2 in first u's
    for _ in range(HALVINGS):
        share = 1.0 + sqrt(1.0 - 0.5 * u)
        u, squared = 0.5 * u / share, 2.0 * squared / share
    squared *= 2.0 + u * (1.0 / 3.0 + u * (4.0 / 45.0 + u * (1.0 / 35.0 + u * 16.0 / 1575.0)))
    return decay(2.0 * ratio * sqrt(squared / (1.0 + ratio)))


def has_impacts(spec: Spec) -> bool:
    """Whether springs of contacts may have impacts: the engine makes these in their order.

    An accuracy is asked of the springs themselves: its substeps resolve them.
    """
    terms = step_terms(spec)
    return row_terms(spec).elastic and terms.ordered_impacts and not terms.substeps


def may_rebound(spec: Spec) -> bool:
    """Whether some pairs give back of the speed that they meet with."""
    return step_terms(spec).rebounds or has_impacts(spec)


def make_takes_time(spec: Spec) -> Any:
    """Return `kernel(contact, pair, bodies, params) -> whether` its impulse has no instant.

    A spring that steps resolve, by the masses of its bodies as points: levers leave less.
    """
    curved, may = row_terms(spec).curved, has_impacts(spec)

    def takes_time(contact, pair, bodies, params):
        if curved:
            if pair.hertz_stiffness > 0.0:
                return True
        if may:
            light = bodies[contact.a].inv_m + bodies[contact.b].inv_m
            if params.timestep * params.timestep * light > FAST * pair.compliance:
                return False
        return pair.compliance > 0.0

    return kernel(takes_time, spec)


def make_restitution_of(spec: Spec) -> Any:
    """Return `kernel(pair, speed) -> e` of an impact at that speed [m/s]."""
    springs, surfaces = has_impacts(spec), step_terms(spec).rebounds
    falls, restitution_at = made_once(spec, "restitution_at")

    def restitution_of(pair, speed):
        if springs:
            if pair.compliance > 0.0:
                return rebound(pair.damping_ratio)
        e = 0.0
        if surfaces:
            e = pair.restitution
        if falls:
            e = restitution_at(e, pair, speed)
        return e

    return kernel(restitution_of, spec)
