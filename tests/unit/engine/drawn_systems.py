"""Drawn contacts of bodies between each other and a floor, as solvers are given them.

In more points than hold them; and whether impulses are those that Coulomb's law asks for.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest
from drawn_contacts import Drawn, drawn, stacked, views
from interpreted import interpreted, records

from lavendersim.engine.solvers.newton.envelope import allocate_envelope
from lavendersim.engine.solvers.newton.method import step_cost
from lavendersim.engine.solvers.solver import ContactSystem
from lavendersim.engine.spec import Spec

PAIRS = [(0, 1), (0, 1), (1, 2), (2, 1), (0, 2), (2, 3), (3, 0), (0, 3), (0, 3)]
COUNT = len(PAIRS)


class DrawnSystem(NamedTuple):
    """Contacts, with the free motion of their bodies."""

    scene: Drawn
    system: ContactSystem
    workspace: Any
    size: int  # bodies that move
    free: np.ndarray  # (24,) what bodies would do without impulses

    @property
    def motion(self) -> np.ndarray:
        """What the impulses make of it, (24,)."""
        scene = self.scene
        motion: np.ndarray = self.free + scene.inverse @ scene.jacobian.T @ impulses(scene).ravel()
        return motion


def drawn_system(spec: Spec, rng: np.random.Generator) -> DrawnSystem:
    scene = drawn(spec, rng, PAIRS)
    # Bodies of any inertia that anything pushes at any place jam with more friction.
    scene.contacts["mu"] *= 0.2
    for axis in "12":
        scene.contacts[f"lambda_{axis}"] *= 0.2
    bodies, velocities, contacts = views(scene)
    workspace = records(allocate_envelope(4, COUNT, 2000, upper=2000, inside=COUNT))
    system = ContactSystem(contacts, None, COUNT, bodies, velocities)
    size, _ = interpreted(step_cost)(system, workspace)
    free = scene.motion - scene.inverse @ scene.jacobian.T @ impulses(scene).ravel()
    return DrawnSystem(scene, system, workspace, size, free)


def impulses(scene: Drawn, name: str = "lambda") -> np.ndarray:
    return np.stack([scene.contacts[f"{name}_{axis}"] for axis in "n12"], axis=1)


def assert_coulombs_law(drawn: DrawnSystem) -> None:
    """Of impulses found to a residual of 1e-9 m/s: each by the law, not by a residual."""
    scene, found, motion = drawn.scene, impulses(drawn.scene), drawn.motion
    np.testing.assert_allclose(stacked(scene.velocities), motion, atol=1e-12)
    w = (scene.jacobian @ motion).reshape(-1, 3)
    w[:, 0] += scene.contacts["target"]
    # Residuals of 1e-9 m/s, of impulses too by masses of some kilograms.
    near = 1e-8
    for impulse, velocity, mu in zip(found, w, scene.contacts["mu"], strict=True):
        push, slip = np.hypot(*impulse[1:]), np.hypot(*velocity[1:])
        assert min(impulse[0], velocity[0]) == pytest.approx(0.0, abs=near)
        assert push <= mu * impulse[0] + 1e-14
        if slip > 1e-6 and impulse[0] > 1e-6:  # it slides, and friction opposes it
            assert push == pytest.approx(mu * impulse[0], abs=near)
            np.testing.assert_allclose(impulse[1:] * slip, -push * velocity[1:], atol=near)
    assert (found[:, 0] > 1e-6).any()
