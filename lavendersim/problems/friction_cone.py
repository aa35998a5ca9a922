"""Projection onto Coulomb's friction cones, and the derivative of the projection.

    K: |x_t| <= mu x_n.   P(y) = y inside, 0 in the polar cone, else on the nearest generator
    g = (1, mu d) / hypot(1, mu),  d = y_t / |y_t|:   P(y) = (g . y) g
    P'(y) = L L^T   inside: L = I.  In the polar cone: L = 0.  Else, with d' normal to d in the
    tangent plane, its columns are  g  and  sqrt(mu (y_n + mu |y_t|) / (1 + mu^2) / |y_t|) d'
P is the gradient of a convex function, so P' is symmetric with eigenvalues from 0 to 1. `residual`
has a projection of its own: what judges these methods shares no line with them.
"""

from __future__ import annotations

import numpy as np


def project(y: np.ndarray, mu: np.ndarray) -> np.ndarray:
    """Return P(y), (n, 3); `mu` (n,)."""
    side, inside, polar = _regions(y, mu)
    foot = np.empty_like(y)
    foot[:, 0] = (y[:, 0] + mu * side) / (1.0 + mu * mu)
    foot[:, 1:] = (mu * foot[:, 0] / np.where(side > 0.0, side, 1.0))[:, None] * y[:, 1:]
    foot[inside] = y[inside]
    foot[polar] = 0.0
    return foot


def derivative_root(y: np.ndarray, mu: np.ndarray) -> np.ndarray:
    """Return L, (n, 3, 3), of P'(y) = L L^T; columns that P' does not need are zero."""
    side, inside, polar = _regions(y, mu)
    root = np.zeros((len(mu), 3, 3))
    root[inside] = np.eye(3)
    edge = ~(inside | polar)
    mu, side, y = mu[edge], side[edge], y[edge]
    away = np.where(side > 0.0, side, 1.0)
    d_1, d_2 = y[:, 1] / away, y[:, 2] / away
    cos = 1.0 / np.sqrt(1.0 + mu * mu)
    turning = np.sqrt(np.maximum(mu * (y[:, 0] + mu * side), 0.0) / away) * cos
    nothing = np.zeros_like(mu)
    columns = ([cos, cos * mu * d_1, cos * mu * d_2], [nothing, -turning * d_2, turning * d_1])
    root[edge, :, :2] = np.array(columns).transpose(2, 1, 0)
    return root


def _regions(y: np.ndarray, mu: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    side = np.hypot(y[:, 1], y[:, 2])
    inside = side <= mu * y[:, 0]
    return side, inside, ~inside & (mu * side <= -y[:, 0])
