"""Balls that give way as they meet keep momentum and angular momentum, with friction and spin.

Normal force and friction act at one point, in the middle of what they are indented: the torques of
friction are then F_t times arms that end there, and what they change adds up to nothing. Were the
arms as long as the radii, as those of rigid balls, F_t times the indentation would be won.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import States, ball, config, run_scenes

RADII, MASSES = (0.02, 0.05), (0.1, 0.4)  # [m], [kg]
SPEED, SPIN = 1.5, "[5, -8, 40]"  # [m/s], [rad/s]
GAP = 0.002  # [m]
SURFACES = {
    "Hertz": "hertz_stiffness: 1e+6, friction: 0.3",
    "spring": "compliance: 5e-6, friction: 0.3",
    "Hertz along the surface": "hertz_stiffness: 1e+6, friction: 0.3, tangential_stiffness: 0.8",
}


def scene(surface: str) -> str:
    away = sum(RADII) + GAP
    place = (-away * math.cos(0.4), -away * math.sin(0.4), 0.0)
    one = ball(RADII[0], MASSES[0], place, (SPEED, 0.0, 0.0))
    bodies = {
        "one": one.replace("surface:", f"angular_velocity: {SPIN}, surface:"),
        "other": ball(RADII[1], MASSES[1], (0.0, 0.0, 0.0)),
    }
    return config(bodies, 1000, 0.012, surface)


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    return run_scenes({name: scene(surface) for name, surface in SURFACES.items()})


@pytest.mark.parametrize("name", SURFACES)
def test_momentum_and_angular_momentum_are_kept(ran: dict[str, States], name: str) -> None:
    step = ran[name].step
    # Indented by more than a twentieth of the smaller radius.
    assert step["max_penetration"].max() > 0.05 * RADII[0]
    for quantity, allowed in (
        # Impulses are equal and opposite, to round-off of 0.15 N s.
        ("momentum", 1e-15),
        # Arms are of a middle that is found to 1e-9 m/s: to 1e-12 m, of impulses of 0.1 N s.
        ("angular_momentum", 1e-13),
    ):
        of_time = np.stack([step[f"{quantity}_{axis}"] for axis in "xyz"], axis=-1)
        np.testing.assert_allclose(of_time, of_time[:1].repeat(len(of_time), 0), atol=allowed)
