"""Contact problems whose velocities are known by hand, and the laws any solution has to obey.

A cube of mass 1 and edge 1 on a plane, four corners, moved as a whole: each corner sees the same
velocity, so by symmetry the cube moves as one contact of mass 1 would, as long as it does not tip:
the free velocity is the same at every corner and friction acts half an edge below the centre, which
loads front corners more and back corners less while all of them go on pushing.
"""

from __future__ import annotations

import numpy as np
from contact_problems import WORLD, Box, Touch, problem_of_boxes
from gauss_seidel import dense

MU = 0.4
UP = np.array([0.0, 0.0, 1.0])
CORNERS = [(-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)]
# Free velocity of the cube and velocity of every corner after [m/s], along (x, y, z).
BY_HAND = {
    "comes to rest": ((0.0, 0.0, -1.0), (0.0, 0.0, 0.0)),
    # |v_t| <= mu |v_n|: friction stops it
    "sticks": ((0.12, -0.16, -1.0), (0.0, 0.0, 0.0)),
    # slowed along its way by mu times what the plane gives
    "slides": ((1.2, -1.6, -1.0), (1.2 - MU * 0.6, -1.6 + MU * 0.8, 0.0)),
    "opens": ((0.3, 0.2, 0.5), (0.3, 0.2, 0.5)),
    "rests as it is": ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
}


def cube(velocity, mu: float = MU):
    """Return the problem of a cube on four corners that would move by `velocity` (3,)."""
    box = Box(1.0, np.full(3, 0.5), 0.5 * UP)
    touches = [Touch(WORLD, 0, np.array([x, y, 0.0]), UP) for x, y in CORNERS]
    return problem_of_boxes([box], touches, np.array([[*velocity, 0.0, 0.0, 0.0]]), mu)


def laws_broken(problem, impulses: np.ndarray) -> float:
    """Return the largest breach of Signorini's and Coulomb's laws, over the largest velocity.

    Of forces as velocities, times the largest of W; no projection, no natural map.
    """
    matrix, q = dense(problem)
    u = (matrix @ impulses.ravel() + q).reshape(-1, 3)
    speed = max(np.abs(q).max(), 1e-300)
    stiff = np.abs(matrix).max()
    breaches = [0.0]
    for r, w, mu in zip(impulses, u, problem.mu, strict=True):
        pushing, sliding = np.hypot(*r[1:]), np.hypot(*w[1:])
        breaches += [-stiff * r[0], -w[0], min(stiff * r[0], w[0])]
        breaches.append(stiff * (pushing - mu * r[0]))
        # Friction opposes sliding, as strongly as it may: r_t . w_t = -mu r_n |w_t|. As a product
        # it is no velocity; its root over the other factor's root is.
        power = r[1:] @ w[1:] + mu * r[0] * sliding
        breaches.append(min(np.sqrt(max(stiff * power, 0.0)), sliding))
    return float(max(breaches) / speed)
