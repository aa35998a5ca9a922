"""Bodies that springs place: energy only falls, the centre goes on, both momenta stay."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import Bench, box, resolved, sphere

STEPS = 40
SHAPES = ((0.02, 0.05, 0.09), (0.1, 0.04, 0.2))


def tied(fixed: bool, timestep: str = "1/60") -> Bench:
    """Two small boxes, far stretched springs between points well off their centres."""
    first = {"velocity": (0.2, 1.0, -0.5), "angular_velocity": (1.0, 2.0, 3.0)}
    second = {"velocity": (0.0, -0.3, 0.4), "angular_velocity": (-1.0, 0.5, 2.0)}
    bodies: dict[str, Any] = {
        "a": box(SHAPES[0], (0.0, 0.1, 0.0), mass=0.3, **first),
        "b": box(SHAPES[1], (3.0, 0.0, 0.3), mass=2.0, **second),
    }
    if fixed:
        bodies["a"] = sphere(0.001, (0.0, 0.1, 0.0), fixed=True)
    cell = resolved(bodies, (0.0, 0.0, 0.0), timestep=timestep, integrator="midpoint")
    cell["scene"]["springs"] = [
        {"a": "a", "b": "b", "stiffness": 1e7, "rest_length": 0.5}
        | {"point_a": (0.05, 0.08, 0.02), "point_b": (-0.1, 0.06, 0.1)}
    ]
    return interpreted_bench(cell)


@pytest.mark.parametrize("fixed", [False, True])
def test_placed_bodies_gain_no_energy(fixed: bool) -> None:
    bench = tied(fixed)
    placed, energies, momenta, centres = 0, [], [], []
    mass = np.array([0.0 if fixed else 0.3, 2.0])
    for _ in range(STEPS):
        row = bench.run(1).step[-1]
        placed += int((bench.engine.bodies["sprung"] == 2).any())
        energies.append(row["kinetic_energy"] + row["spring_energy"])
        names = ("momentum", "angular_momentum")
        momenta.append([row[f"{name}_{axis}"] for name in names for axis in "xyz"])
        places = np.column_stack([bench.engine.bodies[axis] for axis in "xyz"])
        centres.append(mass @ places / mass.sum())
    assert placed > 0, "Newton's method found everything"
    # A share of 1e-12 counts as round-off, in each step.
    assert np.diff(energies).max() <= 1e-12 * STEPS * energies[0]
    if not fixed:
        # Momenta of some 1e3 N s at most, which cancel, in forty steps.
        np.testing.assert_allclose(momenta, momenta[:1] * STEPS, rtol=0.0, atol=1e-10)
        speed = np.array(momenta[0][:3]) / mass.sum()
        ahead = np.arange(STEPS)[:, None] / 60.0 * speed
        np.testing.assert_allclose(np.array(centres) - centres[0], ahead, atol=1e-10)


def test_what_newton_finds_is_not_placed() -> None:
    bench = tied(fixed=False, timestep="1/100000")
    bench.run(STEPS)
    assert not (bench.engine.bodies["sprung"] == 2).any()
