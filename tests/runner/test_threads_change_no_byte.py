"""A run whose sweeps are shared by several threads writes the log of one thread, byte for byte."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from small_configs import write

import lavendersim
from lavendersim.engine import engine
from lavendersim.engine.atomics import CAN_WAIT
from lavendersim.engine.solvers.packed import team_sweeps
from lavendersim.runner.threads import VARIABLE

# Layers of spheres that touch their neighbours: 540 contacts, 36 with the floor.
LAYERS = """\
question: Do threads change what comes out?
expected: Not a byte.
scene:
  surfaces: {rubber: {friction: 0.5}}
  bodies:
    floor: {shape: {kind: plane}, surface: rubber}
  arrangements:
    ball:
      kind: grid
      counts: [6, 6, 6]
      spacing: [0.1, 0.1, 0.1]
      origin: [0, 0, 0.05]
      jitter: 0.0001
      seed: 1
      body: {shape: {kind: sphere, radius: 0.05}, mass: 1.0, surface: rubber}
numerics: {preset: chapter, solver: coloured_gauss_seidel, timestep: 1/240}
duration: 1/12
measure:
  gain: {kind: energy_gain}
expect:
  - {name: runs, measure: gain, at_most: 1}
"""


@pytest.mark.skipif(not CAN_WAIT, reason="threads wait by what POSIX has")
def test_logs_are_those_of_one_thread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(team_sweeps, "FEWEST_GROUPS", 2)
    monkeypatch.setattr(team_sweeps, "WORTH_IT", 8)
    monkeypatch.setattr(engine, "SHARED_SWEEP", 0)  # in the first call, too
    forks, logs = [], []
    with_team = engine.with_team

    def counted(serve: Any, words: Any, threads: int, step: Any) -> int:
        status = with_team(serve, words, threads, step)
        forks.append((threads, int(words[0])))
        return status

    monkeypatch.setattr(engine, "with_team", counted)
    config = write(tmp_path, LAYERS)
    for threads in (1, 2, 5):
        monkeypatch.setenv(VARIABLE, str(threads))
        finished = lavendersim.run(config, root=tmp_path / str(threads))
        (cell,) = finished.run.cells
        logs.append(cell.path.read_bytes())
    assert logs[0] == logs[1] == logs[2]
    assert {threads for threads, _ in forks} == {2, 5}
    assert max(word for _, word in forks) > 6 << 16  # one for a call's begin and its end, each
