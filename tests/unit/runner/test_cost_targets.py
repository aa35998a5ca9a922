"""From numbers to answers: errors, orders, failures, the front, and the sentence of a target."""

from __future__ import annotations

import math
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.sweeps.cost_grid import settings_of
from lavendersim.measures.cost_table import CostRow
from lavendersim.runner.accuracy import Accuracy
from lavendersim.runner.cell_outcome import CellOutcome
from lavendersim.runner.cost_errors import SettingRun, errors_of, orders_of, relative_error
from lavendersim.runner.cost_targets import answers, front_of
from lavendersim.runner.run_directory import RunCell
from tests.made_costs import cost_table, row_data, spread

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


def row(cost: float, error: float | None, failed: str = "", **more: Any) -> CostRow:
    """A setting that was timed, within 1 ns."""
    more |= {"ns_per_second": spread(cost, cost - 1.0, cost + 1.0), "error": error}
    given = row_data(fragment=f"numerics: {cost}\n") | more
    return cost_table(given | {"failed": failed}).rows[0]


def test_nothing_on_the_front_failed_or_is_dearer_and_no_better_than_another() -> None:
    rows = [
        row(50.0, 0.2),
        row(10.0, 0.1, failed="diverged"),
        row(20.0, 0.5),
        row(60.0, 0.2),
        row(70.0, 0.01),
        row(15.0, None, failed="its log has no answer"),
        row(20.0, 0.6),
    ]
    assert front_of(rows) == [2, 0, 4]
    two, one = answers(rows, [0.2, 0.001])
    assert two.sentence == (
        "20 % costs 50 ns per simulated second: adaptive, 240 Hz, 8 sweeps, warm"
    )
    assert two.fragment == "numerics: 50.0\n"
    assert one.sentence == (
        "no setting of the grid reaches 0.1 %: the nearest is 1 % at 70 ns per simulated second: "
        "adaptive, 240 Hz, 8 sweeps, warm"
    )


def test_of_two_errors_at_round_off_the_cheaper_is_on_the_front() -> None:
    # 2^-52 = 2.2e-16; both are what some hundred operations leave
    assert front_of([row(50.0, 2e-15), row(20.0, 8e-15), row(10.0, 1e-6)]) == [2, 1]


def outcome(steps: int, not_converged: int) -> CellOutcome:
    return CellOutcome(0, "complete", steps, 0, 0, 0, Accuracy(2e-3, 1e-3, not_converged))


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


class FakeCell(RunCell):
    def trace(self) -> Any:
        return SimpleNamespace(status="complete")


CELL = FakeCell(0, "", {}, Path("cell.mcap"), "complete")


def test_a_target_is_reached_by_what_is_just_as_good_but_by_no_failure() -> None:
    rows = [row(2e6, 0.01, failed="not met: it stands"), row(3.1e6, 0.01, warm_start=False)]
    (answer,) = answers(rows, [0.01])
    assert answer.row == 1
    assert answer.sentence.startswith("1 % costs 3.1 ms per simulated second: ")
    assert answer.sentence.endswith("8 sweeps, cold")


def test_an_accuracy_answers_a_target() -> None:
    """The cheapest that reaches it, by name and as what is to be pasted."""
    solved = {"tolerance": 1e-9, "timestep": "1/60"}
    rows = [
        row(2e6, 1e-4, accuracy=1e-4, fragment="asked", **solved),
        row(2e6, 1e-2, fragment="equal", **solved),
    ]
    (answer,) = answers(rows, [1e-3])
    assert answer.fragment == "asked"
    assert answer.sentence == (
        "0.1 % costs 2 ms per simulated second: adaptive, accuracy 1e-4, to 1e-9 m/s, warm"
    )
