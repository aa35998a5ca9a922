"""A ball that leaves the top of a fixed one: a pendulum upside down, theta'' = g/R sin theta."""

from __future__ import annotations

from typing import Any

import numpy as np
from interpreted_steps import Steps
from laboratory import resolved, sphere
from scipy.integrate import solve_ivp

RADIUS, SMALL, GRAVITY, SPEED = 0.5, 0.1, 9.81, 0.8
REACH = RADIUS + SMALL  # of the pendulum [m]
# Solves end at 1e-12 m/s.
NUMERICS: dict[str, Any] = {
    **{"integrator": "midpoint_contact", "impacts": "in_order", "speculative": True},
    **{"tolerance": 1e-12, "sweeps": 400, "slop": 1e-6},
}


def ball_on_ball(
    timestep: str = "1/100", speed: float = SPEED, friction: float = 0.0, **numerics: Any
) -> Steps:
    """Return its engine; with friction it rolls."""
    velocity = {"velocity": (speed, 0.0, 0.0)}
    if friction:
        velocity["angular_velocity"] = (0.0, speed / SMALL, 0.0)
    bodies = {
        "ground": sphere(RADIUS, (0.0, 0.0, 0.0), fixed=True, friction=friction),
        "ball": sphere(SMALL, (0.0, 0.0, REACH), friction=friction, **velocity),
    }
    known = {**NUMERICS, "timestep": timestep, **numerics}
    return Steps(resolved(bodies, (0.0, 0.0, -GRAVITY), **known))


def angle_of(steps: Steps) -> float:
    """Return how far it has come [rad]."""
    x, _, z = steps.places[1]
    return float(np.arctan2(x, z))


def pendulum(time: float, speed: float = SPEED) -> float:
    """Return how far it comes [rad], by an integrator of order 5."""
    found = solve_ivp(
        lambda _, y: (y[1], GRAVITY / REACH * np.sin(y[0])), (0.0, time), (0.0, speed / REACH),
        rtol=1e-12, atol=1e-14,
    )  # fmt: skip
    return float(found.y[0, -1])
