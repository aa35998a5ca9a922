"""The contact problem of a step in numpy, from the state before it and the rows that it logs.

Only the geometry of a logged row is taken (bodies, point, normal, separation); masses, inertias,
Jacobians, free velocities and targets are worked out again from the config.
"""

from __future__ import annotations

import convex
import numpy as np
from complementarity import Body, jacobian
from laboratory import Bench, config

from lavendersim.cell import Sphere


def inertia_of(shape, mass) -> np.ndarray:
    """Principal moments of a homogeneous solid by the covariance of its mass: I = tr(C) - C."""
    if isinstance(shape, Sphere):
        second = np.full(3, shape.radius**2 / 5.0)
    else:
        second = np.square(shape.size) / 12.0
    return mass * (second.sum() - second)


class RowOracle:
    """The contact problem of the next step of `bench`, captured from its state now."""

    def __init__(self, bench: Bench) -> None:
        cell, engine = config(bench.cell), bench.engine
        self.described = list(cell.scene.bodies.values())
        self.numerics = cell.numerics
        self.dt = float(self.numerics.timestep)
        gravity = np.array(cell.scene.gravity, float)
        self.speed_limit = self.numerics.restitution_threshold * np.linalg.norm(gravity) * self.dt
        self.surfaces = [described.surface for described in self.described]
        self.centres = np.array([[row[k] for k in "xyz"] for row in engine.bodies])
        self.velocity = np.concatenate([bench.velocity, bench.spin], axis=1)
        self.inverse = np.zeros((6 * len(self.described),) * 2)
        for i, described in enumerate(self.described):
            mass = described.mass
            if mass is None:
                continue
            quaternion = [engine.bodies[i][k] for k in ("qw", "qx", "qy", "qz")]
            moments = inertia_of(described.shape, mass)
            inverse = Body(1.0 / mass, 1.0 / moments, convex.matrix_of(quaternion)).inverse
            self.inverse[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] = inverse
            self.velocity[i, :3] += gravity * self.dt

    def rows(self, contacts: np.ndarray) -> np.ndarray:
        """Return J, one row per contact."""
        count = len(self.described)
        found = []
        for c in contacts:
            point = np.array([c["x"], c["y"], c["z"]])
            a, b = c["body_a"], c["body_b"]
            arms = (point - self.centres[a], point - self.centres[b])
            found.append(jacobian(count, a, b, np.array([c["nx"], c["ny"], c["nz"]]), arms))
        return np.array(found).reshape(len(contacts), 6 * count)

    def delassus(self, contacts: np.ndarray) -> np.ndarray:
        """Return J M^-1 J^T."""
        rows = self.rows(contacts)
        return rows @ self.inverse @ rows.T

    def approach(self, contacts: np.ndarray) -> np.ndarray:
        """Return v_n before the solve, gravity included."""
        return self.rows(contacts) @ self.velocity.ravel()

    def gamma(self, contacts: np.ndarray) -> np.ndarray:
        """Return c / dt^2 of every row."""
        soft = np.array([surface.compliance for surface in self.surfaces])  # springs in series
        return (soft[contacts["body_a"]] + soft[contacts["body_b"]]) / self.dt**2

    def target(self, contacts: np.ndarray) -> np.ndarray:
        """Return b + b_rest of every row."""
        depth = np.maximum(-contacts["separation"] - self.numerics.slop, 0.0)
        target = -self.numerics.stabilisation_gain / self.dt * depth
        approach = self.approach(contacts)
        for k, c in enumerate(contacts):
            if approach[k] < -self.speed_limit:
                pair = self.surfaces[c["body_a"]], self.surfaces[c["body_b"]]
                target[k] += max(surface.restitution for surface in pair) * approach[k]
        return target

    def problem(self, contacts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return W + gamma and q of the complementarity problem."""
        matrix = self.delassus(contacts) + np.diag(self.gamma(contacts))
        return matrix, self.approach(contacts) + self.target(contacts)
