"""Rows of other engines: sums by the formulas of our own log, impulses as vectors, hashes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lavendersim.experiment import load_experiment_text
from lavendersim.peers.declaration import FRICTION, IMPULSE, POINT, TANGENTIAL
from lavendersim.peers.messages import States
from lavendersim.runner import run
from lavendersim.runner.other_rows import RowsOfStates, state_hashes
from tests.engines import BALL, log_of

REPORTED = POINT + IMPULSE + TANGENTIAL + FRICTION
SPUN = """
scene:
  bodies:
    plate: {shape: {kind: box, size: [0.3, 0.2, 0.1]}, mass: 2, position: [1, -2, 3],
            orientation: [1, 1, 0, 0], velocity: [1, 0, 2], angular_velocity: [3, 2, 1]}
    rock: {shape: {kind: sphere, radius: 0.1}, fixed: true, position: [5, 5, 5]}
record: {velocities: true}
numerics: {timestep: 1/100}
duration: 0.1
"""


def test_sums_and_hashes_are_those_of_our_own_log(tmp_path: Path) -> None:
    """The kernel of `/step` is the independent computation: equal but for the order of sums."""
    log = log_of(run(load_experiment_text(SPUN, "spun.yaml"), tmp_path))
    assert list(log.bodies) == ["plate", "rock"]
    movable = States(0, log.pose[:, :1], log.velocity[:, :1], np.zeros((0, 3)), 0)
    block = RowsOfStates(log.config, ()).block(movable)
    for name in ("kinetic_energy", "potential_energy", "momentum_x", "momentum_z"):
        np.testing.assert_allclose(block.step[name], log.step[name], rtol=1e-14)
    for axis in "xyz":
        name = f"angular_momentum_{axis}"
        np.testing.assert_allclose(block.step[name], log.step[name], rtol=1e-13, atol=1e-13)
    np.testing.assert_array_equal(block.step["time_ns"], log.step["time_ns"])
    np.testing.assert_array_equal(block.pose[:, :, :7], log.pose)
    np.testing.assert_array_equal(block.step["state_hash"], log.step["state_hash"])


def test_equal_states_have_equal_hashes_and_minus_zero_is_zero() -> None:
    pose = np.array([[[0.0, 1.0, -2.0]], [[-0.0, 1.0, -2.0]], [[0.0, 1.0, -2.0 + 4e-16]]])
    one, other, moved = state_hashes(np.array([3, 3, 3]), pose)
    assert one == other
    assert one != moved


def test_an_impulse_along_tangents_is_the_vector_that_was_reported() -> None:
    config = load_experiment_text(BALL, "ball.yaml").cells()[0].config
    normals = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.6, 0.0, 0.8], [2.0, -3.0, 6.0]])
    normals[3] /= 7.0
    reported = np.random.default_rng(1).normal(size=(4, 3))
    reported -= normals * (reported * normals).sum(axis=1, keepdims=True)
    rows = np.array(
        [(k, 0, 1, 0, 0, 0, *normals[k], -0.5, 2.0, *reported[k], 0.3) for k in range(len(normals))]
    )
    pose, velocity = np.tile([0.0, 0, 0, 1, 0, 0, 0], (4, 1, 1)), np.zeros((4, 1, 6))
    found = RowsOfStates(config, REPORTED).block(States(0, pose, velocity, rows, 0)).contact
    first = np.column_stack([found[f"t1{axis}"] for axis in "xyz"])
    second = np.cross(normals, first)
    made = found["impulse_t1"][:, None] * first + found["impulse_t2"][:, None] * second
    np.testing.assert_allclose(made, reported, atol=1e-15)
    assert found["penetration"].tolist() == [0.5] * 4
    assert found["force_n"].tolist() == [200.0] * 4  # 2 N s in 1/100 s


def test_a_count_that_is_not_reported_has_no_column() -> None:
    """An engine may tell its iterations and no contacts, or contacts and no iterations."""
    config = load_experiment_text(BALL, "ball.yaml").cells()[0].config
    pose, velocity = np.tile([0.0, 0, 0, 1, 0, 0, 0], (2, 1, 1)), np.zeros((2, 1, 6))
    states = States(0, pose, velocity, np.zeros((0, 3)), 0, np.array([0, 7]))
    step = RowsOfStates(config, (), counted=True).block(states).step
    assert step["sweeps"].tolist() == [0, 7]
    assert "contact_count" not in step.dtype.names
    rows = np.array([(1, 0, 0, 0, 0, 0, 0, 0, 1, 0.5)] * 3)
    step = RowsOfStates(config, POINT).block(States(0, pose, velocity, rows, 0)).step
    assert step["contact_count"].tolist() == [0, 3]
    assert "sweeps" not in step.dtype.names
