"""Ctrl-C in `lavender cost`: rounds that are whole are kept, and cells that are run."""

from __future__ import annotations

from itertools import count
from pathlib import Path

import pytest

from lavender_cli.cost import cost
from lavendersim.runner import cost_times, experiment_run, open_run
from lavendersim.runner.interruption import Interrupted

COST = """\
cost:
  error: {measure: rebound, truth: 0.025}
  solvers: [projected_gauss_seidel]
  timesteps: [1/240]
  sweeps: [4]
  warm_start: [true]
  accuracies: []
"""


@pytest.fixture
def costed(drop: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    drop.write_text(drop.read_text() + COST)
    monkeypatch.chdir(tmp_path)
    return drop


def test_rounds_that_are_whole_are_kept(
    costed: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    samples = count()

    def sample(engines: cost_times.Engines) -> float:
        number = next(samples)
        if number == 7:  # of 9 rounds with 2 settings: in the middle of the fourth
            raise Interrupted("interrupted by SIGINT")
        return 1e9 + number

    monkeypatch.setattr(cost_times, "_sample", sample)
    with pytest.raises(KeyboardInterrupt):
        cost([costed], plot=False)
    said = capsys.readouterr()
    assert "interrupted by SIGINT after 3 of 9 rounds" in said.err
    assert "medians of 3 interleaved repeats" in said.out
    run = open_run(Path("runs/latest"))
    assert run.finished
    table = run.cost()
    assert table is not None
    assert table.interrupted == "interrupted by SIGINT after 3 of 9 rounds"
    assert [len(row.samples) for row in table.rows] == [3, 3]


def test_cells_that_are_run_are_not_run_again(
    costed: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with monkeypatch.context() as patch:

        def interrupted(*given: object, **more: object) -> None:
            raise Interrupted("interrupted by SIGINT")

        patch.setattr(experiment_run, "write_results", interrupted)
        with pytest.raises(KeyboardInterrupt):
            cost([costed], plot=False, quick=True, values=["duration=0.4"])
    said = capsys.readouterr()
    command = f"lavender cost {costed} --set duration=0.4 --runs runs --quick --no-plot --resume"
    assert f"go on with: {command}" in said.err
    (left,) = (one for one in Path("runs").iterdir() if one.name != "latest")
    cost([costed], plot=False, quick=True, resume=True, values=["duration=0.4"])
    assert "2 of 2 cells are done" in capsys.readouterr().err
    assert Path("runs/latest").resolve() == left.resolve()
    assert open_run(left).finished
