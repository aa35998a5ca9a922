"""The velocity and spin that a moved body has in a step lead it to where it should end."""

from __future__ import annotations

import numpy as np
from convex import matrix_of
from interpreted import interpreted
from plain_facts import one_row, vector_fields

from lavendersim.engine.effects.prescribed_motion import make_lead_to_end
from lavendersim.engine.spec import Spec


def test_it_is_led_to_its_place_and_orientation(rng) -> None:
    """Cayley: R_1 - R = [w dt/2]x (R_1 + R), column by column, from any orientation to any."""
    kernel, dt = interpreted(make_lead_to_end(Spec(("rotation",)))), 0.3
    for _ in range(10):
        begin, end = rng.normal(size=3), rng.normal(size=3)
        q, to = (v / np.linalg.norm(v) for v in rng.normal(size=(2, 4)))
        turns = {
            f"{p}q{n}": v
            for p, v4 in (("", q), ("to_", to))
            for n, v in zip("wxyz", v4, strict=True)
        }
        body = one_row(**vector_fields("", begin), **vector_fields("to_", end), **turns)
        velocity = one_row(**dict.fromkeys(("vx", "vy", "vz", "wx", "wy", "wz"), 0.0))
        kernel(body, velocity, dt)
        speed, spin = (np.array([velocity[p + axis] for axis in "xyz"]) for p in "vw")
        np.testing.assert_allclose(begin + dt * speed, end, atol=1e-14)
        one, other = matrix_of(q), matrix_of(to)
        turned = np.cross(0.5 * dt * spin, (one + other).T).T
        # w grows without bound where the turn is near a half: round-off with it.
        size = 1.0 + dt * np.linalg.norm(spin)
        np.testing.assert_allclose(other - one, turned, atol=1e-14 * size)
