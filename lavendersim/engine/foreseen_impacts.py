"""Impacts that the rest of a step may have, foreseen row by row (`effects.impact_order`).

foresee      by the rate of a row's own gap: which rows wait, and when the next is due
rebounds     whether a pair of the rows gives back of the speed it meets with
let_rebound  which of those that fly between rebounds do so as pairs
follow       pairs of which no row lasts: bodies that turn may meet with any of their features
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from .approach import (
    CREEP,
    ELSEWHERE,
    NEVER,
    OVERLAP,
    ahead,
    gained,
    make_change_ahead,
    make_forced,
    make_gap_acceleration,
    make_gap_acceleration_of_rope,
    make_nearest_rate,
    make_relative_speed,
    make_slowest,
)
from .cavity_flight import make_closing
from .collide.pairs import SHAPE_PAIRS
from .collide.shapes import make_is_inside
from .compile import kernel
from .effects import has_hook, made_once
from .records import CAPSULE, PLANE, TOUCHING
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms
from .stiff_springs import make_restitution_of, make_takes_time, may_rebound
from .vectors import Vec3, length, minus

# Shortest flight after an impact, in timesteps: shorter ones are contact.
FLIGHT = 1.0 / 64.0
# Slowest impact without a rebound, in what forces change in a step.
SLOW = 1.0
# Where a gap accelerates by more than this share of what forces change, it is the motion that
# brings surfaces together: they meet at a slower speed, in the same measure.
CURVED, GLANCING = 0.05, 1.0 / 64.0
# So it is where more than this closes [m]: what solves that do not converge leave open is less.
FALL = 1e-5
# A contact that lasts has a gap of this share of what going round moves its surfaces by, at most.
CLOSED = 1.0 / 64.0
# CONTACT.waits of what flies between rebounds, until it is known whether its pair does.
REBOUNDS = 2
# Slowest impact of a spring that is pressed, in what forces change in what is left of the step: it
# swings by its load as fast, which is no impact. What is undamped has none there.
PRESSED = 1.0
# Pairs that touch at no point but those of their rows, wherever they turn to.
ALONE = frozenset({"sphere_plane", "sphere_sphere", "capsule_plane"})
LAST = 1.0 - 1e-9  # first guess, in what is left of the step, where only shapes tell


def make_is_impact(spec: Spec) -> Any:
    """Return `kernel(speed, least, dv, most, e, params) -> whether it is an impact`.

    speed: at which surfaces meet [m/s]; least: see `approach.make_slowest`; dv, most: see
    `approach.make_forced`; e: coefficient of restitution.
    """

    def is_impact(speed, least, dv, most, e, params):
        if not speed > least:
            return False
        share = params.timestep / params.dt
        if e > 0.0:
            if 2.0 * e * speed > FLIGHT * max(-dv, 0.0) * share:
                return True
        return speed > SLOW * most * share

    return kernel(is_impact, spec)


def make_foresee(spec: Spec) -> Any:
    """Return `kernel(contact, pair, bodies, motion, params, met) -> whether an impact happens now`.

    Fills waits and due of a row whose `rate` is known. params.dt: what is left of the step. met:
    whether the part before ended where its two bodies met.
    """
    forced, slowest = make_forced(spec), make_slowest(spec)
    change_ahead = make_change_ahead(spec)
    relative_speed, is_impact = make_relative_speed(spec), make_is_impact(spec)
    turns, gap_acceleration = step_terms(spec).turns, make_gap_acceleration(spec)
    restitution, compliance = may_rebound(spec), row_terms(spec).compliant
    springs = row_terms(spec).elastic
    takes_time: Any = make_takes_time(spec) if springs else None
    restitution_of: Any = make_restitution_of(spec) if restitution else None
    draws, is_drawn = made_once(spec, "is_drawn")
    overlooks, ropes = step_terms(spec).overlooks, row_terms(spec).taut
    acceleration_of_rope: Any = make_gap_acceleration_of_rope(spec) if ropes else None
    cavities, is_inside = make_is_inside(spec)
    closing: Any = make_closing(spec) if cavities else None

    def foresee(contact, pair, bodies, motion, params, met):
        left = params.dt
        soft = False
        if compliance:
            soft = pair.compliance > 0.0
        lasts = soft  # its impulse takes time: none at an instant
        if springs:
            # Its law reckons with what is left of a gap. A part that began where it is met would be
            # the same of a substep whole and in halves, and have no error that is estimated.
            lasts = takes_time(contact, pair, bodies, params)
        if lasts:
            return False
        v = contact.rate
        if contact.phi <= TOUCHING and abs(v) <= CREEP:
            return False
        (dv, most), least = forced(contact, motion), slowest(contact, bodies, motion)
        swung = 0.0  # what a rope's rate changes as it swings round [m/s]
        if ropes:
            if contact.span > 0.0:
                end_a, end_b = bodies[pair.a], bodies[pair.b]
                swung = acceleration_of_rope(end_a, end_b, bodies, motion) * left
                dv, most = dv + swung, most + abs(swung)
        if cavities:
            if is_inside(pair.kind):  # its wall curves towards it
                swung = closing(contact, pair, bodies, motion, left) * left
                dv, most = dv + swung, most + abs(swung)
        a, e = (change_ahead(contact, motion) + swung) / left, 0.0
        gap = contact.phi if contact.phi > TOUCHING else 0.0
        squared = v * v - 2.0 * a * gap
        meets = gap == 0.0 and v < 0.0
        speed = -v if meets else sqrt(max(squared, 0.0))
        if restitution:
            e = restitution_of(pair, speed)
        if soft and contact.phi < -TOUCHING:  # it is pressed: the spring moves it
            return meets and e < 1.0 and speed > max(least, PRESSED * most)
        if meets:
            return is_impact(speed, least, dv, 0.0 if met else most, e, params)
        if e > 0.0 and contact.phi <= params.slop and v > 0.0:
            if 2.0 * v <= FLIGHT * max(-dv, 0.0) * params.timestep / left:
                contact.rate = 0.0  # pressed back at once, it lies: an impact takes it along
        drawn = False  # as long as it is closed, however fast it opens
        if draws:
            drawn = is_drawn(contact, pair, params)
        # What leaves a gap, whatever holds its bodies, is no contact of this part. Bodies that turn
        # may be pressed to a surface by another contact alone, as a ladder to a wall; what would
        # rebound has to meet again as an impact.
        pressed = most
        if turns and e == 0.0:
            turned = gap_acceleration(contact, bodies, motion) * left
            if contact.phi <= params.slop + CLOSED * turned * left:
                pressed += turned
        leaves = v > least + pressed and contact.phi + left * (v - 0.5 * pressed) > params.slop
        comes_back = False  # too slowly for an impact, as the part showed when it was made before
        if overlooks:
            comes_back = pair.whole == 1
        if leaves and not (drawn or comes_back):
            contact.waits = 1
        flies, slow = False, most
        if gap > params.slop:
            if gap_acceleration(contact, bodies, motion) * left > CURVED * most or gap > FALL:
                slow = GLANCING * most
        if squared > 0.0 and (v < 0.0 or a < 0.0):
            if is_impact(speed, least, dv, slow, e, params):
                # The root that comes first, in the form that does not cancel.
                due = (v + speed) / -a if v > 0.0 else 2.0 * gap / (speed - v)
                # What is far inside has not left by a rebound: a rope that is too long pulls.
                inside = contact.phi < -OVERLAP
                flies = gap > 0.0 or (due >= FLIGHT * params.timestep and not inside)
                if flies and due < left:
                    contact.waits, contact.due = 1, due
                elif flies and e > 0.0 and contact.phi <= params.slop and not comes_back:
                    contact.waits = REBOUNDS  # it flies, and meets later
        if turns:
            waits = (flies or contact.waits == 1) and not comes_back
            if waits and contact.due == NEVER and gap > 0.0:
                # Surfaces that turn may come nearer by as much as this: their shapes decide.
                ma, mb = motion[contact.a], motion[contact.b]
                spin = sqrt(ma.wx * ma.wx + ma.wy * ma.wy + ma.wz * ma.wz)
                spin += sqrt(mb.wx * mb.wx + mb.wy * mb.wy + mb.wz * mb.wz)
                end = contact.phi + left * (v + 0.5 * dv)
                if end < 0.5 * spin * relative_speed(contact, bodies, motion) * left * left:
                    contact.waits, contact.due = 1, LAST * left
        return False

    return kernel(foresee, spec)


def make_rebounds(spec: Spec) -> Any:
    """Return `kernel(state, count) -> whether` a pair of the rows rebounds; None if none ever does.

    Asked of rows, not of the engine: where nothing rebounds, bits are those without restitution.
    """
    if not may_rebound(spec):
        return None
    restitution_of = make_restitution_of(spec)

    def rebounds(state, count):
        contacts, pairs = state.contacts, state.pairs
        found = False
        for c in range(count):
            found = found or restitution_of(pairs[contacts[c].pair], 0.0) > 0.0
        return found

    return kernel(rebounds, spec)


def make_let_rebound(spec: Spec) -> Any:
    """Return `kernel(contacts, count) -> whether any waits` of what flies between rebounds.

    Of a pair that stays where another point of it touches no point flies by itself. The rows of
    a pair stand together.
    """

    def let_rebound(contacts, count):
        waiting, first = False, 0
        while first < count:
            pair, last, stays = contacts[first].pair, first, False
            while last < count and contacts[last].pair == pair:
                stays = stays or (contacts[last].phi <= TOUCHING and contacts[last].waits == 0)
                last += 1
            for c in range(first, last):
                if contacts[c].waits == REBOUNDS:
                    contacts[c].waits = 0 if stays else 1
                    waiting = waiting or not stays
            first = last
        return waiting

    return kernel(let_rebound, spec)


def make_stays_apart(spec: Spec) -> Any:
    """Return `kernel(contact, pair, bodies, motion, left) -> whether` its gap cannot close.

    By the rate of the gap alone, where a pair has no feature without a row:
        phi(t) >= phi + v t - (|a| + r) t^2/2,
    a: of the bodies to each other, as reckoned or by forces alone, whichever is more; r: |w|^2 h of
    an end of a capsule, which is slender and goes round its momentum no faster than |w|: torques
    are in no reckoning of meetings. The distance of balls curves upwards. None where no pair is of
    them.
    """
    kinds = tuple(SHAPE_PAIRS[name].kind for name in spec.shape_pairs if name in ALONE)
    if not kinds:
        return None
    compound, swept = has_hook(spec, "place_parts"), row_terms(spec).swept

    def stays_apart(contact, pair, bodies, motion, left):
        if pair.kind not in kinds:
            return False
        one, other, ma, mb = bodies[pair.a], bodies[pair.b], motion[contact.a], motion[contact.b]
        if compound:
            if one.owner != pair.a or other.owner != pair.b:
                return False
        if swept:  # its gap is that of where they pass each other
            aside = abs(contact.tangential_x) + abs(contact.tangential_y)
            if aside + abs(contact.tangential_z) > 0.0:
                return False
        if one.shape == PLANE:
            if ma.wx != 0.0 or ma.wy != 0.0 or ma.wz != 0.0:
                return False
        # What is reckoned is of the part before: in the first one of a force it is 0.
        change = 0.5 * length(minus(ahead(mb), ahead(ma)))
        change = max(change, 0.5 * (length(gained(ma)) + length(gained(mb))))
        if other.shape == CAPSULE:
            if other.inv_ix != other.inv_iy or other.inv_iz < other.inv_ix:
                return False
            spin = length(Vec3(mb.wx, mb.wy, mb.wz))
            change += 0.5 * other.hz * spin * spin * left
        return max(contact.phi, 0.0) + left * (contact.rate - change) > 0.0

    return kernel(stays_apart, spec)


def make_follow(spec: Spec) -> Any:
    """Return `kernel(contacts, pairs, count, bodies, motion, left)`; None where nothing turns.

    Bodies that part where they touched, and turn, may meet with other features of theirs: of such
    a pair one row is due as soon as any of their points can have closed the gap, but for those that
    stay apart by their own gaps.
    """
    if not step_terms(spec).turns:
        return None
    forced, nearest_rate = make_forced(spec), make_nearest_rate(spec)
    stays_apart = make_stays_apart(spec)
    alone = stays_apart is not None

    def follow(contacts, pairs, count, bodies, motion, left):
        first = 0
        while first < count:
            pair, last, waits, least, soonest = contacts[first].pair, first, True, first, left
            apart = alone
            while last < count and contacts[last].pair == pair:
                contact = contacts[last]
                dv, most = forced(contact, motion)
                # An impact that this step does not bring by itself lasts as little.
                meets = contact.phi > TOUCHING and contact.rate < -most
                waits = waits and (contact.waits == 1 or meets)
                rate = abs(dv) - nearest_rate(contact, bodies, motion)
                gap = max(contact.phi, 0.0)
                if rate * soonest > gap:
                    least, soonest = last, gap / rate
                if alone:
                    apart = apart and stays_apart(contact, pairs[pair], bodies, motion, left)
                last += 1
            if apart:
                for c in range(first, last):
                    contacts[c].due = NEVER
            elif waits and soonest < left:
                contact = contacts[least]
                contact.located, contact.due = ELSEWHERE, min(contact.due, soonest)
            first = last

    return kernel(follow, spec)
