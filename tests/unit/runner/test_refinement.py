"""`--refine` finds the time error that a scheme is known to have, and says what a claim forbids.

A body that falls freely for T by semi-implicit Euler at timestep h is at z0 - g T^2/2 - g T h/2:
order 1, and the extrapolation gives the parabola. By the midpoint rule it is on the parabola.
"""

from __future__ import annotations

import csv
from math import isnan
from pathlib import Path

import pytest

from lavendersim.experiment import load_experiment
from lavendersim.runner import list_runs, open_run, run
from lavendersim.runner.refinement import Refined, refine

G, T = 9.81, 0.5
FALL = """\
question: How far does it fall?
expected: g T^2 / 2.
scene:
  gravity: [0, 0, -9.81]
  bodies:
    ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1.0, position: [0, 0, 5]}}
numerics: {{timestep: 1/{rate}, integrator: {integrator}}}
duration: 0.5
{events}
measure:
  fall: {{kind: displacement, body: ball, along: [0, 0, -1]}}
expect:
  - {{name: falls, measure: fall, equals: {{value: 1.22625, absolute: {tolerance}}}}}
"""


def config(folder: Path, integrator: str = "semi_implicit_euler", **given: str) -> Path:
    values = {"rate": "100", "events": "", "tolerance": "1.0"} | given
    path = folder / "fall.yaml"
    path.write_text(FALL.format(integrator=integrator, **values))
    return path


def refined(path: Path) -> list[Refined]:
    finished = run(path, root=path.parent / "runs")
    return refine(finished)


def test_semi_implicit_euler_falls_at_order_one(tmp_path: Path) -> None:
    (row,) = refined(config(tmp_path))
    found = row.found
    # z is a sum of 200 terms of size up to 5: round-off 200 * 5 * 2^-53 = 1e-13, and the
    # differences it is divided by are 0.006.
    for value, timestep in zip(found.values, (1 / 100, 1 / 200, 1 / 400), strict=True):
        assert value == pytest.approx(G * T * (T + timestep) / 2, abs=1e-12)
    assert found.order == pytest.approx(1.0, abs=1e-9)
    assert found.extrapolated == pytest.approx(G * T**2 / 2, abs=1e-11)
    assert found.error == pytest.approx(G * T / 200, abs=1e-11)


def test_the_midpoint_rule_falls_without_error(tmp_path: Path) -> None:
    (row,) = refined(config(tmp_path, "midpoint"))
    assert isnan(row.found.order)
    assert "equal" in row.found.note
    assert not row.exceeds


def test_timesteps_of_events_are_refined_too(tmp_path: Path) -> None:
    """From T/2 on at a tenth of h: the error is g/2 times the sum of all h^2."""
    events = "events: [{at: 0.25, timestep: 1/1000}]"
    (row,) = refined(config(tmp_path, events=events))
    error = G / 2 * (25 * (1 / 100) ** 2 + 250 * (1 / 1000) ** 2)
    assert row.found.error == pytest.approx(error, abs=1e-11)
    assert row.found.order == pytest.approx(1.0, abs=1e-9)


# Half the timestep changes the fall by g T h / 4 = 0.01226 m.
@pytest.mark.parametrize(("tolerance", "exceeds"), [("0.0123", False), ("0.0122", True)])
def test_a_change_beyond_a_claims_tolerance_is_said(
    tmp_path: Path, tolerance: str, exceeds: bool
) -> None:
    (row,) = refined(config(tmp_path, tolerance=tolerance))
    assert row.tolerance == float(tolerance)
    assert row.claim == "falls"
    assert row.exceeds == exceeds


def test_the_finer_runs_lie_beside_and_leave_the_run_as_it_was(tmp_path: Path) -> None:
    path = config(tmp_path)
    finished = run(path, root=tmp_path / "runs")
    before = {file: file.read_bytes() for file in finished.run.path.rglob("*") if file.is_file()}
    refine(finished)
    assert {file: file.read_bytes() for file in before} == before
    assert open_run(root=tmp_path / "runs").path == finished.run.path
    for again, divisor in zip(list_runs(finished.run.path / "refined"), (2, 4), strict=True):
        # as another process reads it: from disk alone
        assert again.experiment.cells()[0].config.numerics.timestep.denominator == 100 * divisor
        assert again.cells[0].trace().step["step"][-1] == 50 * divisor
    with (finished.run.path / "time_errors.csv").open() as file:
        (line,) = csv.DictReader(file)
    assert (line["measure"], line["timestep"], line["exceeds"]) == ("fall", "1/100", "0")
    assert float(line["order"]) == pytest.approx(1.0, abs=1e-9)


def test_a_refined_experiment_keeps_everything_but_the_timestep(tmp_path: Path) -> None:
    experiment = load_experiment(config(tmp_path))
    (cell,), (finer,) = experiment.cells(), experiment.refined(4).cells()
    assert finer.config.numerics.timestep == cell.config.numerics.timestep / 4
    assert finer.config.refined(1) == finer.config
    same = finer.config.as_dict()
    same["numerics"]["timestep"] = cell.config.as_dict()["numerics"]["timestep"]
    assert same == cell.config.as_dict()
    assert finer.config.steps == 4 * cell.config.steps
