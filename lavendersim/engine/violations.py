"""By how much contacts violate each part of the law: Signorini, the cone, dissipation.

Of one contact, with w_n = v_n + target + gamma lambda_n, w_t the slip of its surfaces and
k_n + gamma the response of its row, the law of Signorini and Coulomb is broken by
    Signorini      | min((k_n + gamma) lambda_n, w_n) |                                   [m/s]
    cone           max(0, -lambda_n, |lambda_t| - mu max(lambda_n, 0))                    [N s]
    dissipation    | lambda_t . w_t + mu lambda_n |w_t| |                                 [J]
The last is what friction fails to take of the most that its disc allows: 0 where the contact sticks
or slides against its motion. All three are 0 exactly where the law holds. They are of this law
whichever one the engine solves (`friction_cone`), so they give the error of the model
beside the solver's; `residual` is the solver's alone. Torques have no part here.
"""

from __future__ import annotations

from math import sqrt

from .compile import kernel
from .records import Field
from .residual import make_normal_residual
from .row_terms import row_terms
from .spec import Spec

# Columns of steps: the largest of each, and the logged contact that has it, -1 for none.
SIGNORINI_ROW: list[Field] = [("signorini", "f8"), ("signorini_contact", "i8")]
COULOMB_ROW: list[Field] = [
    ("cone", "f8"),
    ("cone_contact", "i8"),
    ("dissipation", "f8"),
    ("dissipation_contact", "i8"),
]


def make_forget(spec: Spec):
    """Return `kernel(counters)`, before the contacts of a step: nothing is broken yet."""

    def forget(counters):
        counters.signorini, counters.signorini_contact = 0.0, -1
        counters.cone, counters.cone_contact = 0.0, -1
        counters.dissipation, counters.dissipation_contact = 0.0, -1

    return kernel(forget, spec)


def make_watch_signorini(spec: Spec):
    """Return `kernel(counters, at, contact, v_n)`; at: the contact's row in the log, -1: none."""
    normal_residual = make_normal_residual(spec)

    def watch_signorini(counters, at, contact, v_n):
        broken, most = normal_residual(contact, v_n), counters.signorini
        # A NaN is greater than anything, or it would not be seen.
        if broken > most or broken != broken or (counters.signorini_contact < 0 and broken == most):
            counters.signorini, counters.signorini_contact = broken, at

    return kernel(watch_signorini, spec)


def make_watch_coulomb(spec: Spec):
    """Return `kernel(counters, at, contact, w_1, w_2)`; None without friction."""
    if not row_terms(spec).frictional:
        return None

    def watch_coulomb(counters, at, contact, w_1, w_2):
        n, one, two = contact.lambda_n, contact.lambda_1, contact.lambda_2
        broken = sqrt(one * one + two * two) - contact.mu * max(n, 0.0)
        broken = max(broken, 0.0 - n)
        if broken <= 0.0:
            broken = 0.0
        if broken > counters.cone or broken != broken or counters.cone_contact < 0:
            counters.cone, counters.cone_contact = broken, at
        broken = abs(one * w_1 + two * w_2 + contact.mu * n * sqrt(w_1 * w_1 + w_2 * w_2))
        if broken > counters.dissipation or broken != broken or counters.dissipation_contact < 0:
            counters.dissipation, counters.dissipation_contact = broken, at

    return kernel(watch_coulomb, spec)


def make_log_signorini(spec: Spec):
    """Return `kernel(row, bodies, counters)` that fills SIGNORINI_ROW."""

    def log_signorini(row, bodies, counters):
        row.signorini, row.signorini_contact = counters.signorini, counters.signorini_contact

    return kernel(log_signorini, spec)


def make_log_coulomb(spec: Spec):
    """Return `kernel(row, bodies, counters)` that fills COULOMB_ROW."""

    def log_coulomb(row, bodies, counters):
        row.cone, row.cone_contact = counters.cone, counters.cone_contact
        row.dissipation = counters.dissipation
        row.dissipation_contact = counters.dissipation_contact

    return kernel(log_coulomb, spec)
