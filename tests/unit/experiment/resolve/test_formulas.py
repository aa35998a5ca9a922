"""Constants and formulas of a config: the numbers in each cell, and where they come from."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import Experiment, load_experiment, load_experiment_text

SCENE = """
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: $r}, mass: 2 * $m, position: [0, 0, $r + $gap]}
numerics: {timestep: 1 / $rate}
duration: 1
"""
CONSTANTS = "constants: {r: 0.05, m: 1, gap: 2 * $r, rate: 480}"


def loaded(rest: str = "", constants: str = CONSTANTS, set_: tuple[str, ...] = ()) -> Experiment:
    return load_experiment_text(constants + SCENE + rest, "made.yaml", overrides=set_)


def ball(experiment: Experiment, cell: int = 0) -> tuple[float, float, float]:
    body = experiment.cells()[cell].config.scene.bodies["ball"]
    return body.shape.radius, body.mass, body.position[2]  # type: ignore[union-attr, return-value]


def test_formulas_become_numbers_in_the_cell() -> None:
    experiment = loaded()
    assert ball(experiment) == (0.05, 2.0, 0.15)  # 0.05 + 0.1 is 0.15000000000000002 in floats
    assert experiment.cells()[0].config.numerics.timestep == Fraction(1, 480)


def test_a_cell_is_the_same_as_one_with_the_numbers_written_out() -> None:
    written = SCENE.replace("$r + $gap", "0.15").replace("2 * $m", "2").replace("$r", "0.05", 1)
    other = load_experiment_text(written.replace("1 / $rate", "1/480"), "other.yaml")
    assert loaded().cells()[0].digest == other.cells()[0].digest


def test_where_each_number_came_from_is_kept() -> None:
    found = {one.path: one for one in loaded().computed}
    mass = found["scene.bodies.ball.mass"]
    assert (mass.text, mass.number, mass.mark[:2]) == ("2 * $m", 2, (5, 53))


def test_a_swept_constant_has_its_own_number_in_each_cell() -> None:
    experiment = loaded("sweep: {r: {path: constants.r, values: [0.05, 0.1]}}\n")
    assert [ball(experiment, k) for k in (0, 1)] == [(0.05, 2.0, 0.15), (0.1, 2.0, 0.3)]


def test_a_constant_can_be_set_from_outside() -> None:
    assert ball(loaded(set_=("set constants.r=0.1",))) == (0.1, 2.0, 0.3)
    assert ball(loaded(set_=("set scene.bodies.ball.mass=$r * 20",)))[1] == 1.0


def test_a_child_changes_the_constants_of_its_parent(tmp_path: Path) -> None:
    (tmp_path / "base.yaml").write_text(CONSTANTS + SCENE)
    child = tmp_path / "child.yaml"
    child.write_text("extends: base.yaml\nconstants: {r: 0.1}\n")
    assert ball(load_experiment(child)) == (0.1, 2.0, 0.3)
    again = load_experiment_text(load_experiment(child).text, "again.yaml")
    assert ball(again) == (0.1, 2.0, 0.3)


def test_values_of_an_axis_may_be_formulas() -> None:
    experiment = loaded("sweep: {m: {path: scene.bodies.ball.mass, values: [$m, 3 * $m]}}\n")
    assert [cell.label for cell in experiment.cells()] == ["m=1", "m=3"]


EXPECT = """
measure: {slip: {kind: slip_distance, body: ball}}
expect: [{name: it falls, measure: slip, equals: FORMULA, relative: 0.1}]
"""


@pytest.mark.parametrize(
    ("formula", "text"),
    [
        ("2 * $r", 0.1),
        ("$mass * $r", "$mass * 0.05"),
        ("$gap * $scale", "$scale * (2 * 0.05)"),
    ],
)
def test_expected_values_keep_axes_and_have_numbers_for_constants(
    formula: str, text: object
) -> None:
    sweep = "sweep: {mass: {path: scene.bodies.ball.mass, values: [1, 2]}}"
    if "$gap" in formula:  # a constant made of one that is swept by an axis of another name
        sweep = "sweep: {scale: {path: constants.gap, values: [0.5, 1]}}"
        formula, text = "$gap * $r", "$scale * 0.05"
    experiment = loaded(sweep + EXPECT.replace("FORMULA", formula))
    (claim,) = experiment.expectations
    assert claim.agreement is not None
    assert claim.agreement.value == text


def test_a_constant_made_of_a_swept_one_is_written_out_in_an_expected_value() -> None:
    sweep = "sweep: {size: {path: constants.r, values: [0.1, 0.2]}}"
    (claim,) = loaded(sweep + EXPECT.replace("FORMULA", "$gap + 1")).expectations
    assert claim.agreement is not None
    assert claim.agreement.value == "(2 * $size) + 1"


def test_a_swept_constant_that_names_no_cell_cannot_be_expected() -> None:
    sweep = "sweep: {m: {paths: {scene.bodies.ball.mass: [1, 2], constants.r: [0.1, 0.2]}}}"
    with pytest.raises(ConfigError, match=r"put constants\.r first in it"):
        loaded(sweep + EXPECT.replace("FORMULA", "2 * $r"))


FIGURE = """
measure: {slip: {kind: slip_distance, body: ball}}
figure:
  caption: c
  panels:
    - {kind: measure_against_axis, measure: slip, axis: size, x_label: x, y_label: y,
       ideal: {value: FORMULA, label: law}}
"""


def test_the_ideal_of_a_figure_keeps_axes_as_an_expected_value_does() -> None:
    sweep = "sweep: {size: {path: constants.r, values: [0.1, 0.2]}}"
    figure = loaded(sweep + FIGURE.replace("FORMULA", "$gap + 1")).config.figure
    assert figure is not None
    assert figure.panels[0].ideal.value == "(2 * $size) + 1"  # type: ignore[attr-defined]
    with pytest.raises(ConfigError, match=r"ideal: there is no constant or axis \$sise.*\$size"):
        loaded(sweep + FIGURE.replace("FORMULA", "2 * $sise"))


def test_dollars_of_texts_stay_what_they_are() -> None:
    experiment = loaded("question: does it cost $r?\nexpected: 2 * $r\n")
    assert (experiment.config.question, experiment.config.expected) == (
        "does it cost $r?",
        "2 * $r",
    )
