"""The error of a problem given by its matrix, without units.

    | c r - P_K(c r - uh) | / |q|,   uh = w + mu |w_t| e_n,   c = tr W / 3n
over all rows; P_K projects onto Coulomb's cone. Zero exactly at a solution (De Saxce's form of the
law), the same for permuted contacts, turned tangents, other units. Where q = 0 it is not divided:
no impulse solves such a problem.
"""

from __future__ import annotations

from math import sqrt

from .compile import kernel
from .cone import project_cone
from .spec import Spec


def make_scaled_residual(spec: Spec):
    """Return `kernel(contacts, count, velocities) -> (residual [-], its worst contact)`."""
    convex = spec.friction_cone == "convex"

    def scaled_residual(contacts, count, velocities):
        c = velocities.mean_diagonal
        total, largest, worst = 0.0, 0.0, -1
        for k in range(count):
            contact = contacts[k]
            w_n = contact.w_n + contact.gamma * contact.lambda_n
            w_1, w_2 = contact.w_1, contact.w_2
            if not convex:
                w_n += contact.mu * sqrt(w_1 * w_1 + w_2 * w_2)
            n, one, two = c * contact.lambda_n, c * contact.lambda_1, c * contact.lambda_2
            x, y, z = project_cone(n - w_n, one - w_1, two - w_2, contact.mu)
            x, y, z = x - n, y - one, z - two
            squared = x * x + y * y + z * z
            total += squared
            # A NaN wins and stays, or divergence would pass for convergence.
            if worst < 0 or squared > largest or squared != squared:
                largest, worst = squared, k
        return sqrt(total) / velocities.load, worst

    return kernel(scaled_residual, spec)
