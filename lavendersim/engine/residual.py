"""Rows with impulses and velocities enter, the step's error leaves, in m/s.

Natural map of the complementarity 0 <= lambda_n, 0 <= w with w = v_n + target + gamma lambda_n:
    r = | min((k_n + gamma) lambda_n, w) |
zero exactly at a solution, continuous, and in velocity units because lambda is scaled by the row's
own inverse mass. The residual of a step is the largest over its rows.
"""

from __future__ import annotations

from .compile import kernel
from .contact import make_normal_velocity
from .spec import Spec


def make_row_residual(spec: Spec):
    """Return `kernel(contact, v_n) -> r` [m/s]."""
    compliant = spec.has("compliance")

    def row_residual(contact, v_n):
        w = v_n + contact.target
        if compliant:
            w += contact.gamma * contact.lambda_n
        # A NaN in the first place of min stays, in the second it is dropped.
        return abs(min(w, contact.lambda_n / contact.inv_k))

    return kernel(row_residual, spec)


def make_residual(spec: Spec):
    """Return `kernel(contacts, count, velocities) -> (largest residual [m/s], its contact)`."""
    normal_velocity = make_normal_velocity(spec)
    row_residual = make_row_residual(spec)

    def residual(contacts, count, velocities):
        largest, worst = 0.0, -1
        for c in range(count):
            contact = contacts[c]
            v_n = normal_velocity(contact, velocities[contact.a], velocities[contact.b])
            r = row_residual(contact, v_n)
            # A NaN wins and stays, or divergence would pass for convergence.
            if worst < 0 or r > largest or r != r:
                largest, worst = r, c
        return largest, worst

    return kernel(residual, spec)
