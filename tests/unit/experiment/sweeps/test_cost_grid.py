"""The grid of a cost section: a product of its lists, and fragments that give one setting back."""

from __future__ import annotations

from fractions import Fraction

from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.sweeps.cost_grid import (
    TRUTH_TOLERANCE,
    fragment_of,
    over_the_grid,
    settings_of,
)
from tests.bouncing_ball_config import BOUNCING_BALL

COST = """\
cost:
  error: {measure: apex}
  solvers: all
  timesteps: [1/60, 1/240]
  sweeps: [2, 8]
  warm_start: [true]
"""
GRID = BOUNCING_BALL + COST


def test_the_grid_is_the_product_of_its_lists_with_what_the_config_specifies_first() -> None:
    experiment = load_experiment_text(GRID, "ball.yaml")
    settings = settings_of(experiment)
    assert settings[0].role == "specified"
    assert settings[0].timestep == Fraction(1, 240)
    assert [one.role for one in settings].count("specified") == 1
    assert settings[-1].role == "chapter"  # the config's slop is another
    grid = [one for one in settings if one.role == "grid"]
    assert len(set(grid)) == len(grid)
    for one in grid:
        # adaptive ends at its tolerance; every other solver takes the sweeps it is given
        assert (one.tolerance is None) == (one.solver != "adaptive")
        assert one.sweeps in (2, 8) or one.solver == "adaptive"
        assert one.preset == "chapter"
    assert {one.timestep for one in grid} == {Fraction(1, 60), Fraction(1, 240)}
    swept = over_the_grid(experiment, settings)
    assert len(swept.cells()) == 3 * len(settings)
    for place, cell in enumerate(swept.cells()):
        setting, numerics = settings[place // 3], cell.config.numerics
        assert {name: getattr(numerics, name) for name in setting.knobs} == setting.knobs
        assert numerics.slop == (0.001 if setting.role == "chapter" else 0.002)


def test_accuracies_are_asked_for_where_the_laws_are_of_order_two() -> None:
    for numerics, few in (("default", 4), ("{integrator: midpoint}", 0), ("chapter", 0)):
        text = GRID.replace("{preset: chapter, slop: 0.002}", numerics)
        asked = [
            one
            for one in settings_of(load_experiment_text(text, "ball.yaml"))
            if one.accuracy is not None
        ]
        assert len(asked) == few
        for one in asked:
            assert (one.solver, one.timestep, one.tolerance) == ("adaptive", Fraction(1, 60), 1e-9)
    both = GRID.replace("cost:", "cost:\n  presets: [default, chapter]\n  accuracies: [1e-3]")
    both = both.replace("{preset: chapter, slop: 0.002}", "default")
    settings = settings_of(load_experiment_text(both, "ball.yaml"))
    assert [one.preset for one in settings if one.accuracy == 1e-3] == ["default"]


def test_a_fragment_gives_its_setting_and_states_no_more_than_it_must() -> None:
    asked = "{accuracy: 2e-3, slop: 1e-6}"  # and the grid has equal timesteps beside it
    for numerics in (
        "{preset: chapter, slop: 0.002}",
        "chapter",
        "default",
        "{timestep: 1/60}",
        asked,
    ):
        text = GRID.replace("{preset: chapter, slop: 0.002}", numerics)
        experiment = load_experiment_text(text, "ball.yaml")
        settings = settings_of(experiment)
        swept = over_the_grid(experiment, settings)
        for place, setting in enumerate(settings):
            fragment = fragment_of(experiment, setting)
            pasted = load_experiment_text(
                text.replace(f"numerics: {numerics}\n", fragment), "ball.yaml"
            )
            # the whole config of a cell, to the last digit
            assert [cell.digest for cell in pasted.cells()] == [
                cell.digest for cell in swept.cells()[3 * place : 3 * place + 3]
            ], fragment
            if setting.role == "chapter":
                assert fragment == "numerics: chapter\n"


def test_the_truth_is_at_an_eighth_of_the_finest_timestep() -> None:
    finest = GRID.replace("{measure: apex}", "{measure: apex, truth: finest}")
    last = settings_of(load_experiment_text(finest, "ball.yaml"))[-1]
    assert (last.role, last.timestep, last.tolerance) == (
        "truth",
        Fraction(1, 1920),
        TRUTH_TOLERANCE,
    )
    roles = {setting.role for setting in settings_of(load_experiment_text(GRID, "ball.yaml"))}
    assert "truth" not in roles


def test_settings_of_one_curve_differ_in_their_timestep_alone() -> None:
    settings = settings_of(load_experiment_text(GRID, "ball.yaml"))
    for one in settings:
        for other in settings:
            alike = one._replace(timestep=other.timestep, role=other.role) == other
            own = (one.role == "chapter") == (other.role == "chapter")
            assert (one.curve == other.curve) == (alike and own)
