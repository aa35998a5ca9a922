"""Sliding stops: a step is made in parts where surfaces stop sliding on each other, or turning.

Friction is against the slip, so at the instant at which that vanishes it changes at once: what slid
rests, rolls, or slides back. Impulses of one step have one friction; a step across that instant is
of first order, and exact under constant forces if it ends there. It is foreseen from the slip s as
a part begins, and its rate in the last part, a:
    s + a t = 0,   t = -(s . a)/|a|^2
Only what passes through 0 is a stop: a slip that turns aside has no instant. Spins that rolling or
torsional friction resists stop likewise. A stop missed by a change of forces is of second order;
what is left of the slip then stops by itself.

Contacts of a whole pile stop in every step: in a step of more than MOST_ROWS rows nothing is
looked at, and its stops may cost SPENT rows.
"""

from __future__ import annotations

from typing import Any

from ..spec import Spec
from .decision import Decision, Facts, by_pair
from .effect import Effect, Fields, Hooks, kernel
from .impact_order import decide as has_parts

# Of a step with more rows no stop is looked for.
MOST_ROWS = 64
# So many rows of contacts may be solved again in a step, for its stops.
SPENT = 128
# What is left of a slip where it is least, as a share of it, if that is a stop.
LEFT_OVER = 0.01


def decide(facts: Facts) -> Decision:
    """On when impacts are in order, contact is at the middle of the step, and something slides."""
    parts = has_parts(facts)
    if not parts.on:
        return Decision(False, f"steps have one part: {parts.reason}")
    if facts.integrator != "midpoint_contact":
        return Decision(False, f"the integrator is {facts.integrator}")
    if any(pair.surface.friction > 0.0 or pair.resists_turning for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _described))
    return Decision(False, "nothing has friction")


def _described(pair: Any) -> str:
    if pair.surface.friction > 0.0:
        return "sliding may stop"
    return "turning may stop" if pair.resists_turning else ""


def make_note_rate(spec: Spec) -> Any:
    """Return `kernel(body, v, m, dt)`: the rate of its spin in a part of a step, once solved."""

    def note_rate(body, v, m, dt):
        body.spin_ax = (v.wx - m.wx) / dt
        body.spin_ay = (v.wy - m.wy) / dt
        body.spin_az = (v.wz - m.wz) / dt

    return kernel(note_rate, spec)


def make_vanishes(spec: Spec) -> Any:
    """Return `kernel(s, a, least, left, shortest) -> when` s + a t passes through 0, or NEVER [s].

    least: what counts as 0 as the part begins; shortest: part of a step.
    """
    from ..approach import NEVER
    from ..vectors import dot, plus_scaled

    def vanishes(s, a, least, left, shortest):
        squared, along = dot(s, s), dot(s, a)
        if squared <= least * least or along >= 0.0:
            return NEVER
        t = -along / dot(a, a)
        if not shortest < t < left - shortest:
            return NEVER
        rest = plus_scaled(s, t, a)
        if dot(rest, rest) > LEFT_OVER * LEFT_OVER * squared:
            return NEVER
        return t

    return kernel(vanishes, spec)


def make_first_stop(spec: Spec) -> Any:
    """Return `kernel(state, count, params, counters) -> when` sliding first stops, or NEVER [s].

    params.dt: what is left of the step. Of rows that take part in it.
    """
    from ..approach import (
        CREEP,
        NEVER,
        SHORT,
        make_gap_acceleration,
        make_slowest,
        normal,
        relative_velocity,
    )
    from ..block import set_tangents
    from ..collide.nearest_image import place_beside
    from ..records import PLANE
    from ..row_terms import make_is_soft, row_terms
    from ..vectors import Vec3, cross, dot, minus, plus, plus_scaled, position
    from . import made_once

    slowest, vanishes, beside = make_slowest(spec), make_vanishes(spec), place_beside(spec)
    gap_acceleration = make_gap_acceleration(spec)
    terms = row_terms(spec)
    rolling, torsional, yielding = terms.rolling, terms.torsional, terms.yielding
    is_soft: Any = make_is_soft(spec) if yielding else None
    moving_surface, surface_velocity = made_once(spec, "surface_velocity")

    def across(n, v):
        return plus_scaled(v, -dot(n, v), n)

    across = kernel(across, spec)

    def slip(contact, bodies, motion):
        # As the part begins [m/s].
        a, b = bodies[contact.a], bodies[contact.b]
        ma, mb, at = motion[contact.a], motion[contact.b], position(contact)
        v = relative_velocity(ma, mb)
        v = plus(v, cross(Vec3(mb.wx, mb.wy, mb.wz), minus(at, beside(a, b))))
        v = minus(v, cross(Vec3(ma.wx, ma.wy, ma.wz), minus(at, position(a))))
        if moving_surface:
            set_tangents(contact)
            surface_velocity(contact, a, b)
            one, two = contact.surface_1, contact.surface_2
            v = plus_scaled(v, one, Vec3(contact.t1x, contact.t1y, contact.t1z))
            v = plus_scaled(v, two, Vec3(contact.t2x, contact.t2y, contact.t2z))
        return across(normal(contact), v)

    slip = kernel(slip, spec)

    def slip_rate(contact, bodies):
        # In the last part [m/s^2].
        a, b, at = bodies[contact.a], bodies[contact.b], position(contact)
        rate = Vec3(b.ax - a.ax, b.ay - a.ay, b.az - a.az)
        rate = plus(rate, cross(Vec3(b.spin_ax, b.spin_ay, b.spin_az), minus(at, beside(a, b))))
        rate = minus(rate, cross(Vec3(a.spin_ax, a.spin_ay, a.spin_az), minus(at, position(a))))
        return across(normal(contact), rate)

    slip_rate = kernel(slip_rate, spec)

    def when_turning_stops(contact, pair, bodies, motion, least, span):
        left, shortest = span
        a, b, ma, mb = bodies[contact.a], bodies[contact.b], motion[contact.a], motion[contact.b]
        spin = Vec3(mb.wx - ma.wx, mb.wy - ma.wy, mb.wz - ma.wz)
        rate = Vec3(b.spin_ax - a.spin_ax, b.spin_ay - a.spin_ay, b.spin_az - a.spin_az)
        n, when = normal(contact), NEVER
        size = a.bound if b.shape == PLANE else b.bound
        if rolling:
            if pair.rolling_friction > 0.0:
                when = vanishes(across(n, spin), across(n, rate), least / size, left, shortest)
        if torsional:
            if pair.torsional_friction > 0.0:
                s, change = dot(n, spin), dot(n, rate)
                one = vanishes(
                    Vec3(s, 0.0, 0.0), Vec3(change, 0.0, 0.0), least / size, left, shortest
                )
                when = min(when, one)
        return when

    turning = rolling or torsional
    turning_stops: Any = None
    if turning:
        turning_stops = kernel(when_turning_stops, spec)

    def first_stop(state, count, params, counters):
        if count > MOST_ROWS or counters.spent + 1 + count > SPENT:
            return NEVER
        bodies, motion, pairs, first = state.bodies, state.motion, state.pairs, NEVER
        left, shortest = params.dt, SHORT * params.timestep
        for c in range(count):
            contact = state.contacts[c]
            if contact.waits == 1 or contact.phi > params.slop:
                continue
            pair, s = pairs[contact.pair], Vec3(0.0, 0.0, 0.0)
            slides = pair.friction > 0.0
            if yielding:  # what gives way has no jump
                slides = slides and not (pair.tangential_stiffness > 0.0 and is_soft(pair))
            if slides:
                s = slip(contact, bodies, motion)
            if not turning:
                if dot(s, s) <= CREEP * CREEP:
                    continue
            least = slowest(contact, bodies, motion)
            # What nears or leaves is not pressed as the part begins: no friction of it can change.
            # But what is pressed at the middle of a step, where normals turn, nears or leaves by
            # what they turn in half a step; and what rolls there slips by as much. A plane's normal
            # is the same wherever it is touched.
            if abs(contact.rate) > least:
                if bodies[contact.a].shape == PLANE or bodies[contact.b].shape == PLANE:
                    continue
                turned = 0.5 * params.timestep * gap_acceleration(contact, bodies, motion)
                if abs(contact.rate) > least + turned or dot(s, s) <= turned * turned:
                    continue
            if dot(s, s) > least * least:
                rate = slip_rate(contact, bodies)
                first = min(first, vanishes(s, rate, least, left, shortest))
            if turning:
                when = turning_stops(contact, pair, bodies, motion, least, (left, shortest))
                first = min(first, when)
        if first < left:
            counters.spent += 1 + count
        return first

    return kernel(first_stop, spec)


EFFECT = Effect(
    name="sliding_stops",
    decide=decide,
    per="contact",
    needs=("impact_order", "contact_midpoint", "friction"),
    overhead_with="friction",
    fields=Fields(
        body=[  # rate of its spin in the last part of a step [rad/s^2]
            ("spin_ax", "f8"),
            ("spin_ay", "f8"),
            ("spin_az", "f8"),
        ],
    ),
    hooks=Hooks(first_stop=make_first_stop, note_rate=make_note_rate),
)
