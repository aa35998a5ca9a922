"""Periodic boundary: bodies meet the nearest images of others, as if these stood there.

across a face    the same motion as in the middle of the cell
momentum         kept to round-off, with energy: impulses across a face are equal and opposite
angular          not kept: a contact across a face turns the scene by L x f
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import Bench, body, config, plane, planned, resolved, sphere

from lavendersim.experiment.resolve.presets import DEFAULT

NUMERICS = DEFAULT.model_dump(mode="json")
LENGTH = 2.0  # of the cell [m]
RADIUS = 0.1  # of what meets, about [m]
BALL = {"kind": "sphere", "radius": RADIUS}
BOX = {"kind": "box", "size": [0.2, 0.18, 0.16]}
CONE = {"kind": "cone", "radius": 0.12, "height": 0.2}


def cell(bodies: dict[str, Any], ends: dict[str, Any], **numerics: Any) -> dict[str, Any]:
    """Return a cell without gravity, whose scene repeats itself."""
    made = resolved(bodies, **{**NUMERICS, **numerics})
    made["scene"]["periodic"] = ends
    made["record"]["residuals"] = "none"
    return made


def pair(shift: float, shape: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    """Two bodies 0.5 m apart around x = shift that meet off centre, turning, with friction."""
    common = {"friction": 0.5, "restitution": 0.5}
    turned = {"orientation": (1.0, 0.2, 0.1, -0.3), "angular_velocity": (1.0, 2.0, 5.0)}
    left = body(shape, (shift - 0.25, 0.0, 0.5), velocity=(1.0, 0.1, 0.0), **common)
    right = body(other, (shift + 0.25, 0.05, 0.5), velocity=(-1.0, 0, 0), **turned, **common)
    return {"left": left, "right": right}


@pytest.mark.parametrize(
    ("shape", "other"),
    [(BALL, BALL), (BOX, BOX), (CONE, BALL), (BALL, CONE)],
    ids=["balls", "boxes", "cone and ball", "ball and cone"],
)
@pytest.mark.parametrize("preset", ["default", "captured"])
def test_what_meets_across_a_face_moves_as_in_the_middle(shape, other, preset: str) -> None:
    numerics = {} if preset == "default" else {"impacts": "captured", "speculative": False}
    ends, found = {"x": [0.0, LENGTH]}, []
    # In the middle; across the face at 0, the right one two periods away; and without a cell.
    for place, periods in ((1.0, 0), (0.0, 2)):
        bodies = pair(place, shape, other)
        bodies["right"]["position"][0] += periods * LENGTH
        bench = interpreted_bench(cell(bodies, ends, **numerics))
        assert bench.spec.has("periodic_boundary")
        rows = bench.run(60)
        x = np.array([row["x"] for row in bench.engine.bodies]) - place
        x[1] -= periods * LENGTH
        found.append((rows.contact["impulse_n"], bench.velocity, RADIUS * bench.spin, x))
    without = resolved(pair(1.0, shape, other), **{**NUMERICS, **numerics})
    without["record"]["residuals"] = "none"
    alone = interpreted_bench(without)
    assert not alone.spec.has("periodic_boundary")
    alone.run(60)
    np.testing.assert_array_equal(alone.velocity, found[0][1])  # bit for bit: its image is itself
    assert len(found[0][0]) >= 1
    assert np.abs(found[0][2]).max() > RADIUS  # friction has turned both
    # Places of 4 m have a last digit of 9e-16 m; a lever of 0.1 m and what solves amplify it.
    for one, other in zip(*found, strict=True):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-12)


def gas(seed: int, count: int = 10) -> dict[str, Any]:
    """Balls of two sizes on a lattice with a random velocity each, some of them periods away."""
    rng = np.random.default_rng(seed)
    bodies = {}
    for k in range(count):
        place = 0.25 + 0.5 * np.array([k % 2, k // 2 % 2, k // 4]) + LENGTH * rng.integers(-1, 2, 3)
        place[2] = 0.25 + 0.5 * (k // 4)
        bodies[f"ball_{k}"] = sphere(
            0.12 + 0.05 * (k % 2),
            place.tolist(),
            mass=1.0 + k % 3,
            velocity=rng.uniform(-2.0, 2.0, 3).tolist(),
            restitution=1.0,
        )
    return bodies


def test_a_gas_keeps_momentum_and_energy() -> None:
    """LENGTH 2 m is two lattices of 0.5 m; along z it is open, so the cell is x and y of 1 m."""
    ends = {axis: [-0.5, 0.5] for axis in "xy"} | {"z": [0.0, 1.5]}
    bench = interpreted_bench(cell(gas(3), ends))
    rows = bench.run(240)
    mass = 1.0 / np.array([row["inv_m"] for row in bench.engine.bodies])
    p = np.stack([rows.step[f"momentum_{axis}"] for axis in "xyz"], axis=1)
    scale = (mass[:, None] * np.abs(bench.velocity)).sum()
    met = rows.contact[rows.contact["impulse_n"] > 0.0]
    assert len(met) > 20
    # Round-off: a thousand additions of 1e-16 of what enters.
    np.testing.assert_allclose(p, np.broadcast_to(p[0], p.shape), rtol=0.0, atol=1e-12 * scale)
    energy = rows.step["kinetic_energy"]
    # Solved to 1e-9 m/s, and sharper: each impact is of one contact, in closed form.
    np.testing.assert_allclose(energy, energy[0], rtol=1e-9)


def test_the_tree_finds_what_trying_every_pair_does() -> None:
    """No contact depends on how pairs are found: the same bits."""
    ends = {axis: [-0.5, 0.5] for axis in "xy"} | {"z": [0.0, 1.5]}
    made = cell(gas(5), ends)
    benches = [
        interpreted_bench(made, planned(made).spec),
        interpreted_bench(made, planned(made).spec.including("broad_phase")),
    ]
    rows = [bench.run(150) for bench in benches]
    assert (rows[0].contact["impulse_n"] > 0.0).sum() > 10
    np.testing.assert_array_equal(rows[0].step["state_hash"], rows[1].step["state_hash"])


def test_the_torque_of_a_contact_across_a_face_is_a_period_times_its_force() -> None:
    """Two balls meet along y across the face of x: L goes by L x f, to round-off."""
    bodies = {
        "left": sphere(0.1, (0.09, 0.0, 0.0), velocity=(0.0, 1.0, 0.0)),
        "right": sphere(0.1, (LENGTH - 0.09, 0.15, 0.0), velocity=(0.0, -1.0, 0.0)),
    }
    bench = interpreted_bench(cell(bodies, {"x": [0.0, LENGTH]}))
    rows = bench.run(30)
    (met,) = rows.contact[rows.contact["impulse_n"] > 0.0]
    impulse = met["impulse_n"] * np.array([met["nx"], met["ny"], met["nz"]])  # on the right one
    about = np.stack([rows.step[f"angular_momentum_{axis}"] for axis in "xyz"], axis=1)
    # The right ball stands a period further than where the contact pushes its image.
    expected = np.cross((LENGTH, 0.0, 0.0), impulse)
    assert np.abs(expected).max() > 0.1
    np.testing.assert_allclose(about[-1] - about[0], expected, rtol=0.0, atol=1e-12)


def test_it_is_off_where_no_two_bodies_have_images() -> None:
    made = cell({"floor": plane(), "ball": sphere(0.1, (0.0, 0.0, 0.1))}, {"x": [0.0, LENGTH]})
    decision = planned(made).decisions["periodic_boundary"]
    assert decision == (False, "bodies meet nothing but planes, which are everywhere")
    made["scene"]["periodic"] = None
    decision = planned(made).decisions["periodic_boundary"]
    assert decision == (False, "the scene is not periodic")


def test_planes_have_no_images() -> None:
    two = {name: sphere(0.1, (x, 0.0, 0.1)) for name, x in (("one", 0.0), ("two", 0.5))}
    bench = Bench(cell({"floor": plane(), **two}, {"x": [0.0, LENGTH]}), None)
    np.testing.assert_array_equal(bench.engine.bodies["period_x"], (0.0, LENGTH, LENGTH))
    np.testing.assert_array_equal(bench.engine.bodies["period_y"], 0.0)
    assert config(bench.cell).scene.periodic.periods == {"x": LENGTH}
