"""Newton's method finds torques with impulses, and leaves them within what the impulses allow.

A twisted tower under a heavy cube, on contacts that resist every turning, asked for a sharp end:
the last of sixteen sweeps is followed by Newton's method, and no sweep fixes what it leaves. And
balls on each other, which only torques keep up.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import Bench, box, plane, resolved, sphere

from lavendersim.engine.engine import Rows

G, DT, EDGE, COUNT = 9.81, 1.0 / 240.0, 0.2, 4
C = 5e-5
LAST = 16  # sweeps: two looks, of which the second is the end


def twisted_tower(history: str = "none") -> Bench:
    surface = {"friction": 0.5, "torsional_friction": C, "rolling_friction": C}
    bodies = {"floor": plane(**surface)}
    for k in range(COUNT):
        bodies[f"cube_{k}"] = box(
            (EDGE,) * 3,
            (0.01 * k, 0.0, EDGE * (k + 0.5)),
            mass=300.0 if k == COUNT - 1 else 1.0,
            velocity=(0.3, 0.0, -1.0),
            angular_velocity=(0.5, 0.2 * k, 2.0 - k),
            **surface,
        )
    cell = resolved(
        bodies, (0.0, 0.0, -G), solver="adaptive", sweeps=LAST, tolerance=5.0, warm_start=False
    )
    cell["record"]["residuals"] = history
    return interpreted_bench(cell)


class Ended(NamedTuple):
    """A step that Newton's method ends: its bench and rows, and the bodies before it."""

    bench: Bench
    rows: Rows
    velocities: np.ndarray  # (bodies, 6)
    centres: np.ndarray  # (bodies, 3)


def ended_by_newton(history: str = "none") -> Ended:
    """Run a step that is within its tolerance before the last sweeps, but not as sharp as asked."""
    bench = twisted_tower(history)
    bench.engine.counters["sharpen"] = 1
    velocities = np.hstack([bench.velocity, bench.spin])
    centres = np.array([[row[axis] for axis in "xyz"] for row in bench.engine.bodies])
    rows = bench.run(1)
    assert rows.step["sweeps"][-1] == LAST
    assert int(bench.engine.counters["newton_steps"][0]) > 0
    return Ended(bench, rows, velocities, centres)


@pytest.fixture(scope="module")
def ended() -> Ended:
    return ended_by_newton()


def test_torques_end_within_the_cones_of_the_impulses_that_newton_found(ended) -> None:
    """Some contacts push no more, and lose their torques. Limits are kept to the rounding of a
    length, 4 ulp.
    """
    contacts = ended.rows.contact
    limit = C * contacts["impulse_n"]
    roll = np.hypot(contacts["angular_impulse_t1"], contacts["angular_impulse_t2"])
    assert (limit == 0.0).any()
    for size in (np.abs(contacts["angular_impulse_n"]), roll):
        assert (size > 0.0).any()
        assert (size <= limit * (1.0 + 4 * np.finfo(float).eps)).all()


def test_velocities_are_those_that_impulses_and_torques_give(ended) -> None:
    """m dv = m g dt + sum p and I dw = sum (r x p + psi), over the bodies' contacts; cubes have no
    gyroscopic torque. Some 1,000 updates of each velocity, of up to 3 rad/s, round; impulses are
    logged to the last bit, levers to the rounding of positions.
    """
    bench, contacts = ended.bench, ended.rows.contact
    gained = {k: np.zeros(6) for k in range(1, COUNT + 1)}
    normal = np.stack([contacts[f"n{axis}"] for axis in "xyz"], axis=1)
    first = np.stack([contacts[f"t1{axis}"] for axis in "xyz"], axis=1)
    frame = np.stack([normal, first, np.cross(normal, first)], axis=1)
    push = np.stack([contacts[f"impulse_{axis}"] for axis in ("n", "t1", "t2")], axis=1)
    twist = np.stack([contacts[f"angular_impulse_{axis}"] for axis in ("n", "t1", "t2")], axis=1)
    push, twist = np.einsum("ck,ckx->cx", push, frame), np.einsum("ck,ckx->cx", twist, frame)
    half = 0.5 * contacts["separation"][:, None] * normal
    point = np.stack([contacts[axis] for axis in "xyz"], axis=1)
    for side, sign in (("a", -1.0), ("b", 1.0)):
        for c, k in enumerate(contacts[f"body_{side}"]):
            if k > 0:
                lever = point[c] + sign * half[c] - ended.centres[k]
                gained[k] += sign * np.hstack([push[c], np.cross(lever, push[c]) + twist[c]])
    for k, impulse in gained.items():
        mass = bench.cell["scene"]["bodies"][f"cube_{k - 1}"]["mass"]
        inertia = mass * EDGE**2 / 6.0
        change = np.hstack([bench.velocity[k], bench.spin[k]]) - ended.velocities[k]
        expected = np.hstack([impulse[:3] / mass + [0.0, 0.0, -G * DT], impulse[3:] / inertia])
        np.testing.assert_allclose(change, expected, atol=1e-11)


@pytest.mark.parametrize("history", ["none", "all"])
def test_a_step_tells_the_residual_that_its_contacts_end_with(history: str) -> None:
    """Whether or not the residual was reported before Newton's method, after the last sweep."""
    rows = ended_by_newton(history).rows
    assert rows.step["residual"][-1] == rows.contact["residual"].max()


@pytest.mark.parametrize("heavy", [1.0, 1000.0])
def test_balls_on_each_other_are_held_up_by_torques_alone(heavy: float) -> None:
    """On a slope below c / (2 n r) a pillar of n balls stands: psi of each contact is the moment of
    the weight above it, sum m h g slope dt at heights h over it. Rows may miss by the tolerance
    each, four rows a contact; what they carry answers it, at levers no longer than the pillar.
    """
    count, radius, c, slope, tolerance = 5, 0.1, 0.02, 0.01, 1e-9
    surface = {"friction": 0.5, "rolling_friction": c}
    masses = np.array([1.0] * (count - 1) + [heavy])
    heights = radius * (2 * np.arange(count) + 1)
    bodies = {"floor": plane(**surface)}
    for k in range(count):
        bodies[f"ball_{k}"] = sphere(radius, (0, 0, heights[k]), mass=masses[k], **surface)
    numerics = {"solver": "adaptive", "sweeps": 60, "tolerance": tolerance}
    bench = interpreted_bench(resolved(bodies, (G * slope, 0.0, -G), **numerics))
    rows = bench.run(1)
    assert rows.step["not_converged"][-1] == 0
    assert int(bench.engine.counters["newton_steps"][0]) > 0
    assert np.abs(bench.velocity).max() <= 10 * count * tolerance
    roll = np.hypot(rows.contact["angular_impulse_t1"], rows.contact["angular_impulse_t2"])
    for contact, psi in zip(rows.contact, roll, strict=True):
        arms = np.maximum(heights - contact["z"], 0.0)
        moment = (masses * arms).sum() * G * slope * DT
        off = 4 * masses.sum() * heights[-1] * tolerance
        assert psi == pytest.approx(moment, abs=off)
