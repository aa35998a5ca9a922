"""The restitution target is captured once per step, before the solve, and held through the sweeps.

Recomputed inside the sweeps it would vanish: the first sweep reverses the velocity, the second
finds nothing that approaches and takes the bounce back, so that every e rebounds alike.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest
from physics_runs import GRAVITY, Course, first_apex, run_config

H, R, BETA, SLOP = 1.0, 0.1, 0.02, 0.001  # clearance, radius, and the chapter's gain and slop

DROPS = """
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      surface: {restitution: 1}
      release: {above: floor, clearance: 1.0, phase: 0}
numerics: {preset: chapter, timestep: 1/480}
duration: 1.0
sweep:
"""
BY_RESTITUTION = """
  phase: {path: scene.bodies.ball.release.phase, values: [0, 1/4, 1/2, 3/4]}
  e: {path: scene.bodies.ball.surface.restitution, values: [0.2, 0.4, 0.6, 0.8, 1.0]}
"""
BY_SWEEPS = """
  e: {path: scene.bodies.ball.surface.restitution, values: [0.8]}
  sweeps: {path: numerics.sweeps, values: [1, 2, 22, 100]}
"""


def rebound_band(e: float, phase: float, dt: float) -> tuple[float, float]:
    """Return the lowest and highest first apex of the discrete drop [m].

    v += g dt, then x += v dt, lets a ball that is found at penetration d arrive at
        v = sqrt(2 g (h + d) + (g dt/2)^2) + g dt/2,
    and a ball that leaves at u from height z rise to z + (u + g dt/2)^2 / 2g. Contact is found
    late: d lies anywhere in 0 .. v dt. Lowest: all of d has to be climbed again. Highest: the bias
    (beta/dt)(d - slop) adds to the bounce and projection gives all of d back.
    """
    g, half = GRAVITY, GRAVITY * dt / 2
    gap = H + phase * sqrt(2 * g * H) * dt
    d = np.linspace(0.0, 1.01 * sqrt(2 * g * gap) * dt, 201)
    v = np.sqrt(2 * g * (gap + d) + half**2) + half
    bias = BETA / dt * np.maximum(d - SLOP, 0.0)
    lowest = (e * v + half) ** 2 / (2 * g) - d
    highest = (e * v + bias + half) ** 2 / (2 * g)
    sampling = g * dt**2 / 8
    return float(lowest.min() - sampling), float(highest.max())


@pytest.fixture(scope="module")
def drops() -> list[Course]:
    return run_config(DROPS + BY_RESTITUTION)


def test_every_restitution_rebounds_to_e_squared_h(drops: list[Course]) -> None:
    for drop in drops:
        e, phase = drop.coordinates["e"], float(drop.coordinates["phase"])
        lowest, highest = rebound_band(e, phase, drop.dt)
        rebound = first_apex(drop, "ball", R)
        assert lowest <= rebound <= highest, (
            f"e = {e}, phase {phase}: rebound {rebound:.4f} m, e^2 h = {e * e * H:.4f} m, "
            f"derived band {lowest:.4f} .. {highest:.4f} m"
        )


def test_rebounds_are_distinct_and_ordered_by_restitution(drops: list[Course]) -> None:
    for phase in {drop.coordinates["phase"] for drop in drops}:
        rebounds = [
            first_apex(drop, "ball", R) for drop in drops if drop.coordinates["phase"] == phase
        ]
        # e^2 h of the two lowest differ by 0.12 m, and their bands are less than 0.02 m wide.
        assert np.diff(rebounds).min() > 0.1, f"phase {phase}: rebounds {rebounds} m"


def test_more_sweeps_do_not_change_the_bounce() -> None:
    rebounds = [first_apex(drop, "ball", R) for drop in run_config(DROPS + BY_SWEEPS)]
    # One row is solved by one sweep; later ones move its impulse by round-off, 1e-16 each.
    assert rebounds == pytest.approx([rebounds[0]] * 4, rel=1e-13)
