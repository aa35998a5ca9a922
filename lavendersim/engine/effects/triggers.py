"""Triggers: states of bodies that make an event happen, looked for at the end of every step.

    touches, leaves           two bodies press on each other in the step; or no more, having done so
    faster_than, slower_than  the speed of a centre of mass [m/s]
    above, below              the component of a centre of mass along a direction [m]
Each is met once, by the first step that ends so; places and speeds count from the initial state on,
contacts from the first step. A step that meets one ends the call, its event acts before the next:
it is late by up to a step. Contacts of bodies asleep stay what they were.
"""

from __future__ import annotations

from typing import Any, Final

from ..spec import Spec
from .decision import Decision, Facts
from .effect import Column, Effect, Hooks, kernel

# Conditions, as stored in TRIGGER.condition.
CONDITIONS: Final = ("touches", "leaves", "faster_than", "slower_than", "above", "below")
TOUCHES, LEAVES, FASTER_THAN, SLOWER_THAN, ABOVE, BELOW = range(len(CONDITIONS))


def decide(facts: Facts) -> Decision:
    """On when an event has a trigger, in a run that is logged: it is met by what the log says."""
    if not facts.triggers:
        return Decision(False, "every event has its time")
    if not facts.record:
        return Decision(False, "nothing of the run is logged")
    return Decision(True, f"an event happens when {facts.triggers[0]}")


def make(spec: Spec) -> Any:
    """Return `kernel(state, log, counters) -> how many` triggers the step that has ended meets.

    log: `memory.Log`, whose row of the step knows its contacts.
    """
    from ..row_terms import row_terms
    from ..vectors import Vec3, dot
    from . import has_hook

    contacts, sleeps = has_hook(spec, "log_contacts"), has_hook(spec, "update_sleeping")
    joins = row_terms(spec).bilateral

    def press(one, contact_rows, first, count):
        for c in range(first, first + count):
            row = contact_rows[c]
            if joins:
                if row.joint > 0:  # its bodies do not touch there
                    continue
            if row.impulse_n > 0.0:
                if row.body_a == one.a and row.body_b == one.b:
                    return True
                if row.body_a == one.b and row.body_b == one.a:
                    return True
        return False

    pressed: Any = kernel(press, spec) if contacts else None

    def meet_contact(one, bodies, log, counters):
        if sleeps:
            if bodies[one.a].asleep == 1 or bodies[one.b].asleep == 1:
                return False
        count = log.step[counters.step_rows].contact_count
        now = pressed(one, log.contact, counters.contact_rows, count)
        if one.condition == TOUCHES:
            return now
        before = one.touched
        one.touched = 1 if now else before
        return before == 1 and not now

    contact_met: Any = kernel(meet_contact, spec) if contacts else None

    def state_met(one, body, v):
        if one.condition == FASTER_THAN or one.condition == SLOWER_THAN:
            squared = v.vx * v.vx + v.vy * v.vy + v.vz * v.vz
            if one.condition == FASTER_THAN:
                return squared > one.value * one.value
            return squared < one.value * one.value
        place = dot(Vec3(one.x, one.y, one.z), Vec3(body.x, body.y, body.z))
        if one.condition == ABOVE:
            return place > one.value
        return place < one.value

    state_met = kernel(state_met, spec)

    def meet(state, log, counters):
        row, met = log.step[counters.step_rows], 0
        row.triggered = 0
        for k in range(state.triggers.shape[0]):
            one = state.triggers[k]
            if one.met == 1:
                continue
            now = False
            if one.condition > LEAVES:
                now = state_met(one, state.bodies[one.a], state.velocities[one.a])
            elif contacts:
                now = contact_met(one, state.bodies, log, counters)
            if now:
                one.met = 1
                row.triggered |= 1 << k
                met += 1
        return met

    return kernel(meet, spec)


EFFECT = Effect(
    name="triggers",
    decide=decide,
    per="body",
    needs=("step_log",),
    step_columns=(
        Column("triggered", "i8", "bit k is 1 where the step meets the k-th trigger", number=60),
    ),
    hooks=Hooks(meet_triggers=make),
)
