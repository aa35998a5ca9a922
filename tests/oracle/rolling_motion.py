"""A body that rolls and pivots on the plane z = 0 without slip: the ODE of the rolling constraint.

With p from the centre to the contact, v = -omega x p. From I omega' + omega x I omega = p x F and
F = m (v' + g z):
    (I + m (p.p 1 - p p^T)) omega' = -omega x I omega + p x m (g z - omega x p')
p' is the velocity of the contact relative to the centre, not that of a point of the body.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

GRAVITY = 9.81  # [m/s^2]
UP = np.array([0.0, 0.0, 1.0])
# Of the matrix of the turn and the angular velocity: p [m] and p' [m/s].
Arm = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


class Rolling(NamedTuple):
    """A body of 1 kg: moments about its own axes [m^2], and where it touches the plane."""

    moments: np.ndarray
    arm: Arm

    def acceleration(
        self, turn: np.ndarray, spin: np.ndarray, gravity: float = GRAVITY
    ) -> np.ndarray:
        """Return omega' [rad/s^2]; turn: body to world, a matrix."""
        inertia = turn @ np.diag(self.moments) @ turn.T
        p, rate = self.arm(turn, spin)
        push = np.cross(p, gravity * UP - np.cross(spin, rate))
        about = inertia + (p @ p) * np.eye(3) - np.outer(p, p)
        return np.linalg.solve(about, push - np.cross(spin, inertia @ spin))

    def energy(self, turn: np.ndarray, spin: np.ndarray) -> float:
        """Return kinetic and potential energy [J], the height that of the centre."""
        p, _ = self.arm(turn, spin)
        body, velocity = turn.T @ spin, np.cross(p, spin)
        return float(0.5 * (self.moments @ body**2 + velocity @ velocity) - GRAVITY * p[2])

    def steady(self, turn: np.ndarray, ratio: float) -> float:
        """Return the rate W of steady precession of omega = W (z + ratio e), e the body's z.

        omega' = W z x omega: both sides of it but gravity's part grow by W^2.
        """
        unit = UP + ratio * turn[:, 2]
        across = np.cross(UP, turn[:, 2])
        falls = self.acceleration(turn, 0.0 * UP) @ across
        bends = (np.cross(UP, unit) - self.acceleration(turn, unit, 0.0)) @ across
        return float(np.sqrt(falls / bends))

    def after(
        self, seconds: float, turn: np.ndarray, spin: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return where the centre has gone from its start [m], the turn and the spin [rad/s]."""

        def rates(_: float, state: np.ndarray) -> np.ndarray:
            w, now = state[3:7], Rotation.from_quat(state[3:7], scalar_first=True).as_matrix()
            omega = state[7:]
            velocity = np.cross(self.arm(now, omega)[0], omega)
            about = 0.5 * np.concatenate([[-omega @ w[1:]], w[0] * omega + np.cross(omega, w[1:])])
            return np.concatenate([velocity, about, self.acceleration(now, omega)])

        start = Rotation.from_matrix(turn).as_quat(scalar_first=True)
        found = solve_ivp(
            rates,
            (0.0, seconds),
            np.concatenate([np.zeros(3), start, spin]),
            method="DOP853",
            rtol=1e-11,
            atol=1e-12,
        )
        end = found.y[:, -1]
        return end[:3], Rotation.from_quat(end[3:7], scalar_first=True).as_matrix(), end[7:]


def disc(radius: float, length: float) -> Rolling:
    """Return a homogeneous cylinder on the rim of its lower face."""
    about = radius**2 / 4.0 + length**2 / 12.0

    def arm(turn: np.ndarray, spin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        axis = turn[:, 2]
        turning = np.cross(spin, axis)
        side = 1.0 if axis[2] >= 0.0 else -1.0
        steep, steeper = UP - axis * axis[2], -turning * axis[2] - axis * turning[2]
        size = np.linalg.norm(steep)
        highest = steep / size
        rate = (steeper - highest * (highest @ steeper)) / size
        return (
            -radius * highest - 0.5 * side * length * axis,
            -radius * rate - 0.5 * side * length * turning,
        )

    return Rolling(np.array([about, about, 0.5 * radius**2]), arm)


def on_a_tip(moments: Sequence[float], tip: Sequence[float], radius: float) -> Rolling:
    """Return a body on a round tip, whose middle is at `tip` in its frame; radius 0: a point."""
    middle = np.asarray(tip, dtype=float)

    def arm(turn: np.ndarray, spin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        out = turn @ middle
        return out - radius * UP, np.cross(spin, out)

    return Rolling(np.asarray(moments, dtype=float), arm)
