"""Nine icosahedra that land, and the same world turned about the vertical and shifted, land alike.

No direction is special, and in which step of which part an impact falls is decided by where bodies
are: a body that touched exactly as a step ended had its impact in this step or the next by the last
bit, and the two landings ended 42 mm apart.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from shared_runs import GRAVITY, States, config, flow, plane, run_scenes

RATES = (60, 240)
RADIUS, APART, SECONDS, REBOUND = 0.1, 0.25, 0.5, 0.5  # [m], [m], [s], [-]
ANGLE, SHIFT = 0.7, np.array([0.3, -0.2, 0.0])  # [rad], [m]
GOLDEN = 0.5 * (1.0 + math.sqrt(5.0))
CORNERS = [
    np.roll((0.0, a, b * GOLDEN), k) * RADIUS / math.hypot(1.0, GOLDEN)
    for k in range(3)
    for a in (-1, 1)
    for b in (-1, 1)
]
SHAPE = f"{{kind: hull, points: [{', '.join(map(flow, CORNERS))}]}}"


def landing(rate: int, angle: float, shift: np.ndarray) -> str:
    """They fall from 0.05 to 0.45 m above the floor, turned at random, with spins."""
    rng, about = np.random.default_rng(1), Rotation.from_euler("z", angle)
    bodies = {"floor": plane()}
    for k in range(9):
        place = np.array([APART * (k % 3 - 1), APART * (k // 3 - 1), 0.15 + 0.05 * k])
        velocity, spin = rng.normal(size=3) * (0.3, 0.3, 0.0), 3.0 * rng.normal(size=3)
        stands = about * Rotation.from_rotvec(2.0 * rng.normal(size=3))
        bodies[f"icosahedron{k}"] = (
            f"{{shape: {SHAPE}, mass: 1, surface: one, position: {flow(about.apply(place) + shift)}"
            f", velocity: {flow(about.apply(velocity))}, angular_velocity: "
            f"{flow(about.apply(spin))}, orientation: {flow(stands.as_quat(scalar_first=True))}}}"
        )
    surface = f"friction: 0.5, restitution: {REBOUND}"
    return config(bodies, rate, SECONDS, surface, gravity=repr(GRAVITY))


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {f"plain {rate}": landing(rate, 0.0, np.zeros(3)) for rate in RATES}
    texts |= {f"turned {rate}": landing(rate, ANGLE, SHIFT) for rate in RATES}
    return run_scenes(texts)


@pytest.mark.parametrize("rate", RATES)
def test_a_turned_world_lands_as_the_world_turned(ran: dict[str, States], rate: int) -> None:
    """To what solves leave and impacts make of it.

    A solve leaves 1e-9 m/s. An impact at a corner hands a difference of velocities on times
    1 + (1 + e) r^2 m/I at most, 6.2 by I = 0.29 m r^2 of an icosahedron; a body has up to four,
    each of up to three rows: 3 (1 + 6.2 + 6.2^2 + 6.2^3) 1e-9 m/s. In half a second that is 4e-7 m.
    """
    plain, turned = ran[f"plain {rate}"], ran[f"turned {rate}"]
    about, known = Rotation.from_euler("z", ANGLE).as_matrix(), 3 * 284 * 1e-9
    place = (turned.place - SHIFT) @ about - plain.place
    assert plain.step["contact_count"].max() >= 3
    assert (
        np.abs(plain.velocity[-1, 1:, 2] - plain.velocity[0, 1:, 2] + GRAVITY * SECONDS).min() > 1
    )
    assert np.abs(place[:, 1:]).max() <= SECONDS * known
    assert np.abs(turned.velocity @ about - plain.velocity)[:, 1:].max() <= known
    assert np.abs(turned.spin @ about - plain.spin)[:, 1:].max() <= known / RADIUS
