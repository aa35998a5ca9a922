"""An Experiment: claims and controls apart, who makes mistakes, what is swept, finer timesteps."""

from __future__ import annotations

from fractions import Fraction

from lavendersim.experiment import Experiment, load_experiment_text
from tests.marked_config import config

APEX = "{kind: apex_error, body: ball, above: floor}"


def made(**sections: str) -> Experiment:
    return load_experiment_text(config(**sections), "some/folder/made.yaml")


def test_claims_and_controls_stand_apart_in_the_order_of_the_file() -> None:
    expect = "[{name: b, measure: x, at_most: 1}, {name: control, fails: b}, {name: completes2, measure: x, at_most: 2}]"  # noqa: E501
    one = made(measure=f"{{x: {APEX}, y: {APEX}}}", expect=expect)
    assert [claim.name for claim in one.expectations] == ["b", "completes2"]
    assert [claim.name for claim in one.controls] == ["control"]
    assert one.unjudged == ["y"]


def test_every_path_of_an_axis_is_swept_by_its_name() -> None:
    union = "[{m: {paths: [scene.bodies.ball.mass, duration], values: [1, 2]}}, "
    union += "{r: {path: scene.bodies.ball.shape.radius, values: [0.2]}}]"
    assert made(sweep=union).swept == {
        "scene.bodies.ball.mass": "m",
        "duration": "m",
        "scene.bodies.ball.shape.radius": "r",
    }


def test_the_cells_that_make_a_mistake_are_known_by_it() -> None:
    sweep = "{s: {path: study.mistake, values: [none, capture_in_sweeps]}}"
    one = made(numerics="chapter", sweep=sweep)
    assert {name: [cell.index for cell in cells] for name, cells in one.mistakes.items()} == {
        "capture_in_sweeps": [1]
    }
    assert made(numerics="chapter").mistakes == {}


def test_effects_are_switched_in_place_or_by_the_sweep() -> None:
    swept = "{s: {path: effects.sleeping, values: [on, off]}}"
    assert made(sweep=swept).switches_effects
    assert made(effects="{sleeping: off}").switches_effects
    assert not made(sweep="{t: {path: duration, values: [1, 2]}}").switches_effects


def test_timesteps_are_divided_exactly_and_again() -> None:
    sweep = "{dt: {path: numerics.timestep, values: [1/60, 1/7]}}"
    finer = made(sweep=sweep).refined(2).refined(3)
    assert [cell.config.numerics.timestep for cell in finer.cells()] == [
        Fraction(1, 360),
        Fraction(1, 42),
    ]
    assert finer.options.divisor == 6
    assert made(sweep=sweep).cells()[0].config.numerics.timestep == Fraction(1, 60)


def test_what_is_drawn_and_what_is_always_judged() -> None:
    plain = made()
    assert (plain.name, plain.is_drawn, plain.always) == ("made", False, None)
    assert made(overhead="{}").is_drawn
    assert made(always="{}").always is not None
