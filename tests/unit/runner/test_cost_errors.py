"""Errors of settings: relative to the truth, their orders, and what is no answer."""

from __future__ import annotations

import math
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.sweeps.cost_grid import settings_of
from lavendersim.runner.accuracy import Accuracy
from lavendersim.runner.cell_outcome import CellOutcome
from lavendersim.runner.cost_errors import SettingRun, errors_of, orders_of, relative_error
from lavendersim.runner.run_directory import RunCell

BALL = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 0.3]}
numerics: chapter
duration: 0.6
measure:
  apex: {kind: apex_error, body: ball, above: floor}
  sinking: {kind: max_penetration, body: ball}
expect:
  - {name: it hardly sinks in, measure: sinking, at_most: 0.01}
cost:
  error: {measure: apex}
  solvers: all
  timesteps: [1/960, 1/60, 1/240]
  sweeps: [2, 8]
"""


def outcome(steps: int, not_converged: int) -> CellOutcome:
    return CellOutcome(0, "complete", steps, 0, 0, 0, Accuracy(2e-3, 1e-3, not_converged))


class FakeCell(RunCell):
    def trace(self) -> Any:
        return SimpleNamespace(status="complete", step=np.zeros(2, [("contact_count", "i8")]))


CELL = FakeCell(0, "", {}, Path(), "cell.mcap", "complete")


def test_an_error_is_relative_to_its_scale_and_the_worst_of_a_row() -> None:
    assert relative_error(1.5, 1.0, None) == 0.5
    assert relative_error(-1.0, -4.0, None) == 0.75  # of |truth|
    assert relative_error(0.25, 0.0, None) == 0.25  # nothing to be relative to
    assert relative_error(0.25, 0.0, 0.5) == 0.5
    assert relative_error([1.0, 4.0], [1.0, 2.0], 2.0) == 1.0
    assert relative_error([1.0, 4.0], 2.0, 1.0) == 2.0
    assert math.isnan(relative_error([1.0, 4.0], [1.0, 2.0, 3.0], 1.0))
    assert math.isnan(relative_error([1.0, math.nan], 1.0, 1.0))


def test_the_order_is_the_slope_between_neighbouring_timesteps_of_a_curve() -> None:
    settings = settings_of(load_experiment_text(BALL, "ball.yaml"))
    # error = timestep^2 of the one number of sweeps, timestep^1 of the other
    errors = [float(one.timestep) ** (2 if one.sweeps == 2 else 1) for one in settings]
    orders = orders_of(settings, errors)
    for one, order in zip(settings, orders, strict=True):
        if one.role == "grid" and one.tolerance is None:
            expected = None if one.timestep == Fraction(1, 60) else 2 if one.sweeps == 2 else 1
            assert order == (expected if expected is None else pytest.approx(expected, rel=1e-12))


@pytest.mark.parametrize(
    ("not_converged", "said"), [(0, ""), (2, ""), (3, "3 of 200 steps above 0.001 m/s")]
)
def test_a_setting_that_leaves_more_than_its_share_not_converged_has_failed(
    not_converged: int, said: str
) -> None:
    experiment = load_experiment_text(BALL, "ball.yaml")
    (setting, *_) = settings_of(experiment)
    asked = setting._replace(tolerance=1e-3)
    measured = [{"apex": 0.25, "sinking": 0.0}]
    run_of = SettingRun(asked, [CELL], [outcome(200, not_converged)], measured)
    (error,) = errors_of(experiment, [run_of])
    assert (error.error, error.residual, error.not_converged) == (0.25, 2e-3, not_converged)
    assert error.failed == said  # a hundredth, two of two hundred, may be


def test_perturbed_starts_show_the_least_error_beside_the_worst() -> None:
    """Two timesteps at each of three starts: of each start the worse, of these the least."""
    axes = ["sweep start_seed=scene.perturbation.seed:[0, 1, 2]"]
    axes += ["sweep height=scene.bodies.ball.mass:[0.3, 0.4]"]
    experiment = load_experiment_text(BALL, "ball.yaml", overrides=axes)
    errors = {
        (0, 0.3): 0.5,
        (0, 0.4): 0.1,
        (1, 0.3): 0.2,
        (1, 0.4): 0.3,
        (2, 0.3): 0.9,
        (2, 0.4): 0,
    }
    measured = [
        {"apex": errors[cell.coordinates["start_seed"], cell.coordinates["height"]], "sinking": 0.0}
        for cell in experiment.cells()
    ]
    cells, outcomes = [CELL] * len(measured), [outcome(200, 0)] * len(measured)
    (setting, *_) = settings_of(experiment)
    (error,) = errors_of(experiment, [SettingRun(setting, cells, outcomes, measured)])
    assert (error.error, error.least) == (0.9, 0.3)
    measured[0]["apex"] = math.nan
    (error,) = errors_of(experiment, [SettingRun(setting, cells, outcomes, measured)])
    assert math.isnan(error.error)
    assert error.least == 0.3
