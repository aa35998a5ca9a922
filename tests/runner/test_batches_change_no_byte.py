"""A run is the same to the byte whether its cells advance one by one or sixteen in a call.

Also where worlds of a batch end early, by divergence or a bound, where a check fails, a body is
removed, and events and triggers change others; with one process and with two.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from run_contents import contents

import lavendersim
from lavendersim.runner import Finished, cell, executor

# At 1e160 m/s the energy is infinite; at 0.3 m the ball stands within the guest.
WORLDS = """\
scene:
  gravity: [0, 0, -9.81]
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 0.6]}
    guest: {shape: {kind: sphere, radius: 0.1}, mass: 7, position: [0, 0, 0.2]}
events:
  - {at: 0.1, body: guest, remove: true}
  - {when: {touches: [ball, floor]}, body: ball, velocity: [0, 0, 4]}
  - {at: 0.4, body: ball, velocity: [1, 0, 2]}
duration: 0.6
sweep:
  - gravity: {path: scene.gravity, values: [[0, 0, -9.81], [0, 0, -5], [0, 0, -3]]}
    mass: {path: scene.bodies.guest.mass, values: [1, 2, 3, 4]}
    z: {path: scene.bodies.ball.position.2, values: [0.6, 0.3]}
  - speed: {path: events.2.velocity.2, values: [2, 1e160]}
    at: {path: events.0.at, values: [0, 0.2, 0.3, 0.55, 0.58]}
always: {energy: none, speed: none}
measure:
  rise: {kind: position, body: ball, along: [0, 0, 1], time: 0.5}
expect:
  - {name: never so high, measure: rise, at_most: 0.5}
"""


@pytest.fixture(scope="module")
def config(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("config") / "worlds.yaml"
    path.write_text(WORLDS)
    return path


def run_of(
    config: Path, root: Path, together: int, jobs: int, monkeypatch: pytest.MonkeyPatch
) -> Finished:
    monkeypatch.setattr(executor, "TOGETHER", together)
    monkeypatch.setattr(executor, "BRIEF", 1e9)
    monkeypatch.setattr(executor, "BATCHES", 1)
    return lavendersim.run(config, root=root, jobs=jobs)


def test_bytes_are_those_of_cells_alone(
    config: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sizes: list[int] = []
    real = cell.advance_together

    def advance(engines: Any, steps: Any, **how: Any) -> Any:
        sizes.append(len(engines))
        return real(engines, steps, **how)

    monkeypatch.setattr(cell, "advance_together", advance)
    single = run_of(config, tmp_path / "single", 1, 1, monkeypatch)
    assert set(sizes) == {1}
    sizes.clear()
    batches = run_of(config, tmp_path / "batches", 16, 1, monkeypatch)
    assert max(sizes) == 16
    statuses = {one.status.split(":")[0] for one in single.outcomes}
    assert statuses == {"complete", "diverged", "beyond bounds"}
    assert not all(verdict.passed for verdict in single.verdicts)
    expected = contents(single.run)
    assert contents(batches.run) == expected
    if os.name == "posix":
        for together in (1, 16):
            two = run_of(config, tmp_path / f"two of {together}", together, 2, monkeypatch)
            assert contents(two.run) == expected
