"""Bounces that end within a step, of bodies that have one contact alone (`effects.impact_time`).

After the first impact the flights are e, e^2, ... as long; those of less than FLIGHT steps are
contact. What still flies as the step ends had impulses p_k at the times t_k: one impulse of their
sum at the time sum(p_k t_k)/sum(p_k) leads to the same place and velocity, so that is the impact of
the step. What does not fly stays where it first met, whatever it did above in between.
"""

from __future__ import annotations

from typing import Any

from .compile import kernel
from .effects import made_once
from .foreseen_impacts import FLIGHT
from .spec import Spec
from .step_terms import step_terms

# Slowest landing, in what forces change in a step: what is slower sinks in by half of that, less
# than a nanometre, and solvers leave a resting body as much.
STILL = 1e-5


def bounces_repeat(spec: Spec) -> bool:
    """Whether impacts of a contact alone are looked at beyond the first of a step."""
    terms = step_terms(spec)
    return terms.timed_impacts and not (terms.ordered_impacts or terms.bounces_vary)


def make_bounce_on(spec: Spec) -> Any:
    """Return `kernel(contact, first, speed, e, params)` of what meets after `first` at `speed`.

    Fills tau, approach_speed, separation_speed and after; params.slop: a gap that is a fall.
    """
    falls, restitution_at = made_once(spec, "restitution_at")

    def bounce_on(contact, first, speed, e, params):
        dt, fall = params.dt, -contact.dv_n / params.dt
        tau, meets, leaves = first, speed, e * speed
        total, weighted = meets + leaves, (meets + leaves) * tau
        flight, bounces = 2.0 * leaves / fall, 0
        while FLIGHT * dt < flight < dt - tau:
            tau, meets, bounces = tau + flight, leaves, bounces + 1
            if falls:
                e = restitution_at(contact.e, contact, meets)
            leaves = e * meets
            total, weighted = total + meets + leaves, weighted + (meets + leaves) * tau
            flight = 2.0 * leaves / fall
        flies = flight >= dt - tau
        if not flies and bounces == 0 and contact.phi <= params.slop and speed < STILL * fall * dt:
            return  # it lies, or all but
        contact.tau, contact.approach_speed = first, speed
        contact.separation_speed, contact.after = 0.0, 0.0
        if flies:
            contact.tau = weighted / total
            contact.separation_speed, contact.after = leaves, -fall * (dt - tau)

    return kernel(bounce_on, spec)
