"""Impact time: an impact happens at the surface, at the time within the step when it is reached.

With the gap phi, its rate v and its free acceleration a at the start of the step, the surfaces meet
after tau with speed |v_meet|,
    phi + v tau + a tau^2/2 = 0,   v_meet = -sqrt(v^2 - 2 a phi),
leave with -e v_meet, and end the step with v_n = -e v_meet + a (dt - tau): this is what the row
requires. The bodies move on their old velocity until tau and on the new one from there; their
other contacts require that the gap left at tau does not close in the rest of the step. What forces
do in that rest counts as in `integrate.displace`: what flies on moves by its mean velocity there,
v_n - a (dt - tau)/2; what is carried by v_n. Of a, drag that resists the approach ends at tau. A
flight so short that it would end within the step is no flight: the contact is then a plastic one,
but where it is the only one (`repeated_bounces`).
"""

from math import sqrt
from typing import Any

from ..records import TOUCHING
from ..step_terms import step_terms
from ..terms import StepTerms
from .decision import Decision, Facts, meeting
from .effect import Choice, Effect, Fields, Hooks, kernel
from .joint_models import driving

# Slower than so many times what forces change in a step, surfaces come to rest, without an impact.
SLOWEST = 4.0


def decide(facts: Facts) -> Decision:
    """On when the numerics ask for it and something can touch."""
    if facts.impacts == "captured":
        return Decision(False, f"impacts are {facts.impacts}")
    # Where a motor reaches its speed a step has parts, too.
    if meeting(facts) or driving(facts):
        return Decision(True, f"impacts are {facts.impacts}")
    return Decision(False, "nothing can touch")


def make_foresee(spec):
    """Return `kernel(contact, params, alone)`: when surfaces meet in free flight, and how fast.

    alone: its bodies have no other contact.
    """
    from ..free_flight import target_of_flight
    from ..repeated_bounces import bounces_repeat, make_bounce_on
    from ..row_terms import row_terms
    from . import has_hook, made_once

    ordered, springs = step_terms(spec).ordered_impacts, row_terms(spec).elastic
    bilateral = row_terms(spec).bilateral
    falls, restitution_at = made_once(spec, "restitution_at")
    slows, repeats = has_hook(spec, "slowed_n"), bounces_repeat(spec)
    bounce_on: Any = make_bounce_on(spec) if repeats else None

    def foresee(contact, params, alone):
        dt = params.dt
        contact.tau, contact.is_impact = dt, 0
        if springs:
            if contact.spring_compliance > 0.0:
                return
        if bilateral:
            if contact.bilateral == 1:
                return
        v, a = contact.v_n_pre - contact.dv_n, contact.dv_n / dt
        # Surfaces that touch or overlap meet at once.
        gap = contact.phi if contact.phi > TOUCHING else 0.0
        squared = v * v - 2.0 * a * gap
        flown = gap == 0.0 and v > 0.0 and a < 0.0 and contact.e > 0.0  # by a rebound before
        if squared <= 0.0 or (v >= 0.0 and (a >= 0.0 or gap == 0.0) and not flown):
            return
        approach_speed = sqrt(squared)
        # The smaller root, in the form that does not cancel.
        tau = 2.0 * gap / (approach_speed - v) if gap > 0.0 else 0.0
        if flown:
            tau = 2.0 * v / -a
        rest = dt - tau
        if rest <= 0.0:
            if flown and contact.phi >= -params.slop:  # and beyond the step
                contact.target = target_of_flight(contact.v_n_pre)
            return
        e = contact.e
        if falls:
            e = restitution_at(e, contact, approach_speed)
        separation_speed = e * approach_speed
        if slows:
            # What resists the approach ends with it, and resists what flies off.
            a -= (1.0 + e) * max(contact.slowed_n, 0.0) / dt
        # A flight that outlasts the step, or a plastic impact worth the name.
        flies_on = 2.0 * separation_speed > -a * rest
        if repeats:
            if alone and a < 0.0 and not flies_on:
                bounce_on(contact, tau, approach_speed, e, params)
                if contact.tau < dt:
                    return
        change = contact.dv_n
        if ordered:  # of a whole step, whatever its part
            change *= params.timestep / dt
        if flies_on or approach_speed > SLOWEST * abs(change):
            contact.tau, contact.approach_speed = tau, approach_speed
            contact.separation_speed, contact.e = separation_speed, e
            contact.after = a * rest if flies_on else 0.0
            if contact.after == 0.0 and a != 0.0:
                contact.separation_speed = 0.0

    return kernel(foresee, spec)


def make_mark_carried(spec):
    """Return `kernel(contact, motion, params)`: which bodies do not fly after an impact.

    They lie on what they touch as the step begins, or stay with what they met (`motion.carried`).
    """
    from ..integrate import AFTERWARDS, ALWAYS, IMPACT
    from ..row_terms import row_terms

    bilateral = row_terms(spec).bilateral

    def mark_carried(contact, motion, params):
        how = 0
        if contact.is_impact == IMPACT:
            if contact.separation_speed == 0.0:
                how = AFTERWARDS
        elif contact.phi <= params.slop:
            how = ALWAYS
        if bilateral:
            if contact.bilateral == 1:  # it lies on nothing
                return
        a, b = motion[contact.a], motion[contact.b]
        if contact.inv_m_a > 0.0:
            a.carried = max(a.carried, how)
        if contact.inv_m_b > 0.0:
            b.carried = max(b.carried, how)

    return kernel(mark_carried, spec)


def make_foresee_impacts(spec):
    """Return `kernel(contacts, begin, end, count, motion, params) -> whether any is foreseen`.

    When these rows of `count` meet, and each of their bodies first does: the taus of `motion`,
    which are dt before.
    """
    foresee = make_foresee(spec)

    def foresee_impacts(contacts, begin, end, count, motion, params):
        meets = False
        for c in range(begin, end):
            contact = contacts[c]
            foresee(contact, params, count == 1)
            if contact.tau < params.dt:
                meets = True
                if contact.inv_m_a > 0.0:
                    motion[contact.a].tau = min(motion[contact.a].tau, contact.tau)
                if contact.inv_m_b > 0.0:
                    motion[contact.b].tau = min(motion[contact.b].tau, contact.tau)
        return meets

    return kernel(foresee_impacts, spec)


def make_predict_impacts(spec):
    """Return `kernel(contacts, count, motion, params)`: targets of impacts and of what is near.

    Of rows that are foreseen, where any meets.
    Of a body's contacts the first to meet is the impact, with those that meet at the same place
    within the slop; later ones are treated from that time on.
    """
    from ..integrate import AHEAD, IMPACT
    from ..joined_impacts import make_share_impacts
    from ..row_terms import row_terms
    from . import made_once

    bilateral = row_terms(spec).bilateral
    share_impacts: Any = make_share_impacts(spec) if bilateral else None
    springs = row_terms(spec).elastic
    falls, _ = made_once(spec, "restitution_at")
    mark_carried = make_mark_carried(spec)

    def first_impact(contact, motion, dt):
        first = dt
        if contact.inv_m_a > 0.0:
            first = min(first, motion[contact.a].tau)
        if contact.inv_m_b > 0.0:
            first = min(first, motion[contact.b].tau)
        return first

    first_impact = kernel(first_impact, spec)

    def gap_at(contact, t, dt):
        v, a = contact.v_n_pre - contact.dv_n, contact.dv_n / dt
        return contact.phi + t * (v + 0.5 * a * t)

    gap_at = kernel(gap_at, spec)

    def predict_impacts(contacts, count, motion, params):
        dt = params.dt
        if bilateral:
            share_impacts(contacts, count, motion)
        for i in range(motion.shape[0]):
            motion[i].carried = 0
        for c in range(count):
            contact = contacts[c]
            if contact.tau < dt:
                if gap_at(contact, first_impact(contact, motion, dt), dt) <= params.slop:
                    contact.is_impact = IMPACT
                    if falls:
                        contact.e_impact = contact.e if contact.separation_speed > 0.0 else 0.0
                    contact.target = -(contact.separation_speed + contact.after)
            mark_carried(contact, motion, params)
        for c in range(count):
            contact = contacts[c]
            if springs:
                if contact.spring_compliance > 0.0:
                    continue
            if bilateral:
                if contact.bilateral == 1:
                    continue
            first = first_impact(contact, motion, dt)
            if first >= dt or contact.is_impact == IMPACT:
                continue
            gap, rest = gap_at(contact, first, dt), dt - first
            if gap > params.slop:
                contact.target = (gap - params.slop) / rest
                if motion[contact.a].carried == 0 and motion[contact.b].carried == 0:
                    contact.is_impact = AHEAD
                    contact.target -= 0.5 * contact.dv_n / dt * rest

    return kernel(predict_impacts, spec)


EFFECT = Effect(
    name="impact_time",
    decide=decide,
    per="contact",
    chosen_by=Choice("impacts"),
    step=StepTerms(timed_impacts=True),
    fields=Fields(
        contact=[
            ("dv_n", "f8"),  # change of v_n by forces in this step [m/s]
            ("e", "f8"),  # coefficient of restitution of the pair [-]
            ("tau", "f8"),  # when the surfaces meet, from the start of the step; dt: not in it [s]
            ("approach_speed", "f8"),  # speed at which they meet [m/s]
            ("separation_speed", "f8"),  # speed at which they leave, by Newton's law [m/s]
            ("after", "f8"),  # what forces add to v_n from then to the end of the step [m/s]
            ("is_impact", "i8"),  # IMPACT or AHEAD (`integrate`): what sets its target; else 0
        ],
    ),
    hooks=Hooks(foresee_impacts=make_foresee_impacts, predict_impacts=make_predict_impacts),
)
