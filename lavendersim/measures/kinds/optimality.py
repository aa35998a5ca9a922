"""Violation of the laws of contact by logged contacts, beyond the residual of their step.

    pushing          lambda_n >= 0
    complementarity  0 <= lambda_n, 0 <= w, lambda_n w = 0  with  w = v_n + b + gamma lambda_n,
                     b the target, what stabilisation and restitution asked of the row
    cone             |lambda_t| <= mu lambda_n
    sliding          lambda_t = -mu lambda_n v_t/|v_t| where v_t is not 0
The second and the fourth by their natural maps, |min((k_n + gamma) lambda_n, w)| and
|k lambda_t - proj(k lambda_t - v_t)| with the projection onto the cone's section: both in m/s, and
zero exactly where the law holds. The residual of a step bounds both: the first is its very terms,
and the second grows with k, for which it has the largest response of the contact to a tangential
impulse and this file the least that any contact of the two bodies can have, the sum of their
inverse masses. mu is the config's; the log's only where it changes with the motion.
"""

from __future__ import annotations

import numpy as np

from lavendersim.geometry.bodies import inverse_mass
from lavendersim.measures.columns import contact_parts, friction_of, of_pairs
from lavendersim.measures.interfaces import Floats, Rows, Trace
from lavendersim.measures.registration import measure
from lavendersim.measures.specs.optimality import Optimality

NAN = float("nan")


@measure(Optimality)
def optimality(spec: Optimality, trace: Trace) -> Floats:
    """Return the largest violations [m/s]: pushing, complementarity; with friction cone, sliding.

    One NaN for a log without contacts or without what their rows asked for (`target`). UsageError
    where the log has no /contacts at all, NotReportedError where an engine does not report them.
    """
    if trace.config.engine is not None and "target" not in (trace.contact.dtype.names or ()):
        np.asarray(trace.contact["target"])  # NotReportedError: another engine does not report it
    largest = [
        [np.max(one) for one in _violations(trace, contacts)]
        for contacts in map(_of_cones, contact_parts(trace))
        if len(contacts["step"]) and "target" in (contacts.dtype.names or ())
    ]
    return np.max(largest, axis=0) if largest else np.array([NAN])


def _of_cones(contacts: Rows) -> Rows:
    """Return the rows that have a cone; those of joints are equations."""
    if "joint" not in (contacts.dtype.names or ()):
        return contacts
    rows: Rows = contacts[contacts["joint"] == 0]
    return rows


def _violations(trace: Trace, contacts: Rows) -> list[Floats]:
    steps = contacts["step"]
    bodies = [trace.config.scene.bodies[name] for name in trace.bodies]
    surfaces = [one.surface for one in bodies]
    dt = trace.clock.lengths(steps)
    residual = np.asarray(trace.step["residual"])[np.searchsorted(trace.step["step"], steps)]
    impulse_n = contacts["impulse_n"]
    if "gamma" in (contacts.dtype.names or ()):
        gamma = np.asarray(contacts["gamma"])
    else:
        gamma = of_pairs(contacts, surfaces, lambda pair: pair.compliance) / dt**2
    least = _summed(contacts, [inverse_mass(one) for one in bodies])
    pushed = (contacts["inverse_effective_mass"] + gamma) * impulse_n
    away = contacts["normal_velocity"] + contacts["target"] + gamma * impulse_n
    violations = [
        np.maximum(-pushed, 0.0),
        np.maximum(np.abs(np.minimum(pushed, away)) - residual, 0.0),
    ]
    if "impulse_t1" in (contacts.dtype.names or ()):
        mu = friction_of(trace, contacts)
        contacts, mu = _unstretched(contacts, mu)
        cone, sliding = _friction(trace, contacts, least, mu)
        violations += [cone, np.maximum(sliding - residual, 0.0)]
    return violations


def _summed(contacts: Rows, of_bodies: list[float]) -> Floats:
    """Return a property of each contact's two bodies, summed."""
    values = np.array(of_bodies)
    total: Floats = values[contacts["body_a"]] + values[contacts["body_b"]]
    return total


def _unstretched(contacts: Rows, mu: Floats) -> tuple[Rows, Floats]:
    """Return contacts whose section is an ellipse with a disc in its place, and its coefficient.

    Of F = mu M, det M = 1: M^-1 lambda_t and M v obey the law of the disc where lambda_t and v
    obey maximum dissipation.
    """
    if "friction_11" not in (contacts.dtype.names or ()):
        return contacts, mu
    a, b, c = (contacts[f"friction_{k}"] for k in ("11", "12", "22"))
    of_disc = np.sqrt(np.maximum(a * c - b * b, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b, c = (
            np.where(of_disc > 0.0, one / of_disc, own)
            for one, own in ((a, 1.0), (b, 0.0), (c, 1.0))
        )
    found = contacts.copy()
    one, two = contacts["impulse_t1"], contacts["impulse_t2"]
    found["impulse_t1"], found["impulse_t2"] = c * one - b * two, a * two - b * one
    one, two = contacts["slip_t1"], contacts["slip_t2"]
    found["slip_t1"], found["slip_t2"] = a * one + b * two, b * one + c * two
    return found, of_disc


def _friction(trace: Trace, contacts: Rows, scale: Floats, mu: Floats) -> tuple[Floats, Floats]:
    limit = scale * mu * np.maximum(contacts["impulse_n"], 0.0)
    first, second = scale * contacts["impulse_t1"], scale * contacts["impulse_t2"]
    one, other = first - contacts["slip_t1"], second - contacts["slip_t2"]
    if trace.config.numerics.friction_cone == "pyramid":
        sizes = np.maximum(np.abs(first), np.abs(second))
        one, other = np.clip(one, -limit, limit), np.clip(other, -limit, limit)
    else:
        sizes = np.sqrt(first**2 + second**2)
        lengths = np.sqrt(one**2 + other**2)
        with np.errstate(divide="ignore", invalid="ignore"):
            shrink = np.where(lengths > limit, limit / lengths, 1.0)
        one, other = one * shrink, other * shrink
    return np.maximum(sizes - limit, 0.0), np.sqrt((first - one) ** 2 + (second - other) ** 2)
