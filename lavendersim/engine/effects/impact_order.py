"""Impact order: impacts that follow each other within a step happen at their own times.

A step is made in parts. Before each the next impact is foreseen, from the free motion of bodies:
    phi + v tau + a tau^2/2 = 0,   v, a: rate of the gap and its change by forces,
and then located on the shapes themselves (`impact_location`); what contacts hold is reckoned to
accelerate as in the last part. The bodies move to there, and what
meets is solved as an impact alone: poses stand still, forces have no time to act. Surfaces that
have not met take no part in it, nor do those that part; what they do to each other comes after. So
a contact ahead acts only when it is met, along the normal that it then has.

Slow meetings are no impacts (`foreseen_impacts`): with a rebound that would end within FLIGHT
steps, or without rebound below SLOW times what forces change in a step (GLANCING of that across a
gap, where the path of the contact bends). They are contacts of the motion (`impact_time`). An
impact takes along what touches and does not part, and of its two bodies what is flush with it by
ten slops, as points of a face that lands without rebound (`impact_rows`); nothing else. One may
have MOST_ROWS rows of contacts, and a step has WORK of them to spend on its parts, or REBOUND where
something near rebounds, for impacts without order may win energy; while no more than MOST_ROWS
contacts touch it has ENDLESS, and what goes on then ends as contact, without rebounds: that wins
none. The rest of a step that has spent its rows or meets a larger impact, or whose bodies overlap,
is made in one part: its impacts at their times but without their order (/step: unordered).
"""

from __future__ import annotations

from typing import Any

from ..records import TOUCHING
from ..spec import Spec
from ..step_terms import step_terms
from ..terms import StepTerms
from .decision import Decision, Facts, meeting, named
from .effect import Choice, Column, Effect, Fields, Hooks, kernel
from .joint_models import driving

# Rows of contacts that the parts of one step may have in all.
WORK = 512
# The break of a rack of 15 balls that rest on a table takes some 1000: each part has their rows.
REBOUND = 2048
# A ball between a wall and one of a million times its mass has 3,141 impacts (Galperin 2003), most
# of them in 1/60 s: 3,100 parts of some four rows each.
ENDLESS = 16384
# Of gravity along a plane: what is left of the normal's last digits.
ROUND_OFF = 1e-12
# So many contacts that a part looks at, and does not meet, count as one row.
CANDIDATES_A_ROW = 16
# An impact of more rows is not made by itself.
MOST_ROWS = 64


def slides_back(facts: Facts) -> bool:
    """Whether something may drive the one ball of a scene along its one plane, against friction.

    Friction on it then changes within a step (`sliding_stops`).
    """
    surface = facts.pairs[0].surface
    resists = surface.friction > 0.0 or facts.pairs[0].resists_turning
    if not resists or facts.integrator != "midpoint_contact":
        return False
    if any(body.force or body.torque or body.pulled or body.twisted for body in facts.bodies):
        return True
    (plane,) = (body for body in facts.bodies if body.shape == "plane")
    n = plane.config.shape.normal
    for g in (facts.gravity, *facts.later_gravity):
        across = (g[1] * n[2] - g[2] * n[1], g[2] * n[0] - g[0] * n[2], g[0] * n[1] - g[1] * n[0])
        if any(abs(part) > ROUND_OFF * max(map(abs, g)) for part in across):
            return True
    return False


def decide(facts: Facts) -> Decision:
    """On when the numerics ask for it and impacts may follow each other, or turn as they come."""
    if facts.impacts != "in_order":
        return Decision(False, f"impacts are {facts.impacts}")
    by_step = facts.stabilisation_gain > 0.0
    driven = driving(facts)
    if driven and not by_step:
        return Decision(True, f"{named(driven)}: a motor reaches its speed within a step")
    if not meeting(facts):
        return Decision(False, "nothing can touch")
    only = facts.pairs[0]
    rigid = not only.is_soft  # where a spring begins to push is met in time
    if facts.pair_count == 1 and only.shape_pair == "sphere_plane" and rigid:
        if slides_back(facts):
            return Decision(True, "the ball may slide, or roll, to a stop and back on the plane")
        if only.surface.tangential_restitution > 0.0 and only.surface.friction > 0.0:
            return Decision(True, "every bounce gives back slip")
        return Decision(False, "one ball and one plane: no impact follows another within a step")
    if by_step:
        return Decision(False, "stabilisation_gain pushes by the step: it has no order in time")
    return Decision(True, "impacts are in_order")


def make_order(spec: Spec) -> Any:
    """Return `kernel(state, count, workspace, params, counters) -> (count, length)` of the part.

    params.dt: what is left of the step, for which forces have acted (`motion`). length: of the part
    [s]; 0: it is an impact. The contacts that take part in it are the first `count` rows.
    """
    from ..approach import (
        CREEP,
        FAR,
        GUESSED,
        LOCATED,
        MEETS,
        NEVER,
        OVERLAP,
        make_approach,
        make_depth,
        make_expect,
        make_is_still,
    )
    from ..flush_contacts import make_drop_flush
    from ..foreseen_impacts import make_follow, make_foresee, make_let_rebound, make_rebounds
    from ..impact_location import make_locate
    from ..impact_rows import make_keep_motion, make_keep_present, make_mark_impact
    from ..motor_reach import make_first_reach, reaches_speeds
    from ..row_terms import make_is_soft, row_terms
    from ..stiff_springs import may_rebound
    from . import has_hook, made_once

    expect, depth = make_expect(spec), make_depth(spec)
    approach, foresee, follow = make_approach(spec), make_foresee(spec), make_follow(spec)
    locate, drop_flush = make_locate(spec), make_drop_flush(spec)
    mark_impact, keep_present = make_mark_impact(spec), make_keep_present(spec)
    keep_motion = make_keep_motion(spec)
    edged = drop_flush is not None
    is_soft: Any = make_is_soft(spec) if row_terms(spec).elastic else None
    turns = step_terms(spec).turns
    springs, ropes = row_terms(spec).elastic, row_terms(spec).taut
    bilateral, stopped = row_terms(spec).bilateral, row_terms(spec).stopped
    rebounds = may_rebound(spec)
    any_rebounds: Any = make_rebounds(spec)
    stops, first_stop = made_once(spec, "first_stop")
    driven = reaches_speeds(spec)
    first_reach: Any = make_first_reach(spec) if driven else None
    # Where no motor starts anything and no surface moves in its body, what is still stays so. Ropes
    # may be tied farther out than their bodies reach.
    rests = not driven and not ropes and not has_hook(spec, "surface_velocity")
    is_still = make_is_still(spec)

    def first_due(contacts, count):
        first, due = -1, NEVER
        for c in range(count):
            if contacts[c].due < due:
                first, due = c, contacts[c].due
        return first, due

    first_due = kernel(first_due, spec)

    def begin_order(state, count, still):
        # Whether anything moves that touches or may: what rests on each other has no order.
        # still: no surfaces move, whose rates would be below what counts.
        bodies, motion, contacts = state.bodies, state.motion, state.contacts
        moves = False
        for c in range(count):
            contact = contacts[c]
            contact.waits, contact.located, contact.due, contact.rate = 0, GUESSED, NEVER, 0.0
            contact.passed_on = 0
            if bilateral:
                if contact.bilateral == 1:  # it neither meets nor parts
                    continue
            if contact.phi > TOUCHING:
                # Beyond what both can move: no part of this step, whatever happens in it.
                if contact.phi > motion[contact.a].reach + motion[contact.b].reach:
                    contact.located = FAR
                    continue
                moves = True
            elif contact.phi < -OVERLAP:
                moves = True
            if still:
                continue
            contact.rate = approach(contact, bodies, motion)
            if abs(contact.rate) > CREEP:
                moves = True
        return moves

    begin_order = kernel(begin_order, spec)

    let_rebound: Any = make_let_rebound(spec) if rebounds else None

    def until_stop(state, count, length, params, counters):
        # The part that ends where sliding stops or a motor has its speed, if that comes first.
        if stops:
            length = min(length, first_stop(state, count, params, counters))
        if driven:
            length = min(length, first_reach(state, count, params, counters))
        return length

    until_stop = kernel(until_stop, spec)

    def order(state, count, workspace, params, counters):
        bodies, motion, contacts = state.bodies, state.motion, state.contacts
        left = params.dt
        still = rests and count > 0 and is_still(bodies, motion)
        if still:
            if not begin_order(state, count, True):
                return count, left
        if not begin_order(state, count, False):
            return count, until_stop(state, count, left, params, counters)
        expect(state.contacts, count, bodies, motion, left)
        if edged:
            count = drop_flush(state, count, workspace, params)
        meets, waiting, touching = False, False, 0
        for c in range(count):
            contact = contacts[c]
            if contact.located == FAR:
                continue
            if bilateral:
                if contact.bilateral == 1:
                    touching += 1
                    continue
            if contact.phi <= TOUCHING:
                touching += 1
                deep = False
                if contact.phi < -OVERLAP:
                    deep = contact.phi < -depth(contact, bodies, motion, params)
                if springs:
                    deep = deep and not is_soft(state.pairs[contact.pair])
                if ropes:  # too long by what its turn left: nothing is inside of anything
                    deep = deep and contact.span == 0.0
                if stopped:
                    deep = deep and contact.stop == 0
                if deep:
                    counters.unordered = 1
                    return count, left
            met = contact.a == counters.met_a and contact.b == counters.met_b
            met = met and counters.met_at == counters.elapsed
            if foresee(contact, state.pairs[contact.pair], bodies, motion, params, met):
                contact.located, meets = MEETS, True
            if contact.waits == 1:
                waiting = True
        if rebounds:
            waiting = let_rebound(contacts, count) or waiting
        if not (meets or waiting):
            return count, until_stop(state, count, left, params, counters)
        rows = touching
        if meets:
            rows = mark_impact(state, count, params)
        counters.spent += 1 + rows + count // CANDIDATES_A_ROW
        spent = counters.spent > WORK
        if rebounds and spent:
            few = touching <= MOST_ROWS
            if counters.spent <= (ENDLESS if few else REBOUND):
                spent = not any_rebounds(state, count)
            elif few:
                counters.plastic = 1
        if spent or (meets and rows > MOST_ROWS):
            counters.unordered = 1
            return count, left
        if meets:
            return keep_present(contacts, count), 0.0
        if turns:
            follow(contacts, state.pairs, count, bodies, motion, left)
        length = left
        while True:
            first, due = first_due(contacts, count)
            if first < 0 or due >= left:
                break
            contact = contacts[first]
            if contact.located == LOCATED:
                length = due
                counters.met_a, counters.met_b = contact.a, contact.b
                counters.met_at = counters.elapsed + due
                break
            due = locate(state, count, contact, workspace, params)
            contact.located, contact.due = LOCATED, due
        if springs:
            for c in range(count):
                if is_soft(state.pairs[contacts[c].pair]):
                    contacts[c].waits = 0  # its law reckons with gaps, whatever closes them
        count = keep_motion(contacts, count, workspace.overlooked)
        return count, until_stop(state, count, length, params, counters)

    return kernel(order, spec)


def make_step_row(spec: Spec) -> Any:
    """Return `kernel(row, bodies, counters)` that fills its columns of a step."""

    def log_parts(row, bodies, counters):
        row.parts, row.unordered = counters.parts, counters.unordered
        row.impact_not_converged = counters.impact_not_converged

    return kernel(log_parts, spec)


EFFECT = Effect(
    name="impact_order",
    decide=decide,
    per="contact",
    needs=("impact_time",),
    chosen_by=Choice("impacts"),
    step=StepTerms(ordered_impacts=True),
    fields=Fields(
        body=[("ax", "f8"), ("ay", "f8"), ("az", "f8")],  # in the last part of a step [m/s^2]
        contact=[
            ("waits", "i8"),  # 1: not met in this part, or it parts: no row of it
            ("located", "i8"),  # GUESSED, ELSEWHERE, LOCATED, FAR or MEETS, see `approach`
            ("rate", "f8"),  # of the gap, as the part begins [m/s]
            ("passed_on", "i8"),  # 1: its body is about to slide or roll from it to a flush one
            ("due", "f8"),  # when the surfaces meet, from the start of the part [s]
        ],
    ),
    counts=("impact_not_converged",),
    step_columns=(
        Column("parts", "i8", "parts that the step was made in, impacts included", number=33),
        Column("unordered", "i8", "1 when impacts of the step were left without order", number=34),
        Column(
            "impact_not_converged",
            "i8",
            "searches for the time of an impact that took all their passes",
            number=49,
        ),
    ),
    hooks=Hooks(order_impacts=make_order, step_row=make_step_row),
)
