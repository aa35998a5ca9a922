"""What a step row says is what the state says: energies, momenta and the hash of every bit."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from laboratory import Bench, box, config, plane, resolved, sphere
from rows import inertia_of

GRAVITY = np.array([0.3, -0.2, -9.81])


@pytest.fixture
def bench() -> Bench:
    bodies = {
        "floor": plane(),
        "box": box(
            (0.5, 0.4, 0.3), (0.1, 0.2, 1.0), mass=2.0, angular_velocity=(1.0, 2.0, -3.0),
            orientation=(0.8, 0.0, 0.6, 0.0), velocity=(0.5, 0.0, 1.0),
        ),
        "ball": sphere(0.2, (1.0, 1.0, 0.2), mass=3.0, angular_velocity=(0.0, 0.0, 4.0)),
    }  # fmt: skip
    return Bench(resolved(bodies, GRAVITY))


def test_energies_and_momenta_follow_their_definitions(bench):
    step = bench.run(7).step[-1]
    kinetic, potential, momentum, angular = 0.0, 0.0, np.zeros(3), np.zeros(3)
    described = list(config(bench.cell).scene.bodies.values())
    for i, body in enumerate(described):
        if body.mass is None:
            continue
        row = bench.engine.bodies[i]
        x = np.array([row[k] for k in "xyz"])
        turned = convex.matrix_of(np.array([row[k] for k in ("qw", "qx", "qy", "qz")]))
        inertia = turned @ np.diag(inertia_of(body.shape, body.mass)) @ turned.T
        v, spin = bench.velocity[i], bench.spin[i]
        kinetic += 0.5 * body.mass * v @ v + 0.5 * spin @ inertia @ spin
        potential -= body.mass * GRAVITY @ x
        momentum += body.mass * v
        angular += np.cross(x, body.mass * v) + inertia @ spin
    assert step["kinetic_energy"] == pytest.approx(kinetic, rel=1e-14)
    assert step["potential_energy"] == pytest.approx(potential, rel=1e-14)
    for k, axis in enumerate("xyz"):
        assert step[f"momentum_{axis}"] == pytest.approx(momentum[k], rel=1e-13, abs=1e-15)
        assert step[f"angular_momentum_{axis}"] == pytest.approx(angular[k], rel=1e-13, abs=1e-14)


def fnv(step: int, bench: Bench) -> int:
    state = 0xCBF29CE484222325 ^ step
    names = ["x", "y", "z", "qw", "qx", "qy", "qz"]
    for body, velocity in zip(bench.engine.bodies, bench.engine.velocities, strict=True):
        pose, speeds = [body[name] for name in names], list(velocity)[:6]
        for word in np.array([*pose, *speeds]).view(np.uint64):
            bits = 0 if word == 1 << 63 else int(word)
            state = (state ^ bits) * 0x100000001B3 % 2**64
    return state


def test_the_hash_is_fnv_over_every_pose_and_velocity(bench):
    for step in (3, 5):
        row = bench.run(step - int(bench.engine.counters["step"][0])).step[-1]
        assert int(row["state_hash"]) == fnv(step, bench)


def test_one_flipped_bit_changes_the_hash(bench):
    before = fnv(1, bench)
    bench.engine.velocities.view(np.uint64)[5] ^= 1
    assert fnv(1, bench) != before


def test_minus_zero_hashes_like_zero(bench):
    bench.run(1)
    bench.engine.velocities["wx"][2] = 0.0
    before = fnv(1, bench)
    bench.engine.velocities["wx"][2] = -0.0
    assert fnv(1, bench) == before
