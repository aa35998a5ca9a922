"""Values from the command line stand in the place of the file's; what is wrong is said there."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from lavendersim import open_run
from lavendersim.errors import ConfigError
from lavendersim.experiment import Experiment, load_experiment_text
from lavendersim.runner import finished_run, run

TEXT = """\
scene:
  surfaces: {rubber: {friction: 0.8, restitution: 0.5}}
  bodies:
    floor: {shape: {kind: plane}, surface: rubber}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 0.5], surface: rubber}
numerics: chapter
duration: 0.1
"""
SWEPT = TEXT + "sweep: {mass: {path: scene.bodies.ball.mass, values: [1, 2]}}\n"
PRODUCTS = (
    TEXT
    + """\
sweep:
- mass: {path: scene.bodies.ball.mass, values: [1, 2]}
- {mass: {path: scene.bodies.ball.mass, values: [3]}, t: {path: duration, values: [0.2]}}
"""
)


def loaded(*overrides: str, text: str = TEXT) -> Experiment:
    return load_experiment_text(text, "drop.yaml", overrides=overrides)


def test_a_value_stands_in_the_place_of_the_files() -> None:
    overrides = (
        "set numerics.timestep=1/480",
        "set scene.bodies.ball.surface.restitution=0.9",
        "set scene.bodies.ball.position=[0, 0, 2.5]",
    )
    experiment = loaded(*overrides)
    (cell,) = experiment.cells()
    bodies = cell.config.scene.bodies
    assert cell.config.numerics.timestep == Fraction(1, 480)
    assert cell.config.numerics.undetermined_forces == "as_solved"  # chapter's, still
    assert bodies["ball"].position == (0.0, 0.0, 2.5)
    # As in a sweep, a path through a surface varies this body's own copy of it.
    assert [bodies[name].surface.restitution for name in ("ball", "floor")] == [0.9, 0.5]
    assert experiment.options.overrides == overrides
    assert experiment.text == TEXT


def test_the_last_of_two_values_counts() -> None:
    (cell,) = loaded("set duration=0.2", "set duration=0.3").cells()
    assert cell.config.duration == 0.3


def test_an_axis_is_added_or_stands_in_the_place_of_one() -> None:
    added = loaded("sweep e=scene.bodies.ball.surface.restitution:[0.2, 0.5]")
    assert [cell.label for cell in added.cells()] == ["e=0.2", "e=0.5"]
    typed = loaded("sweep e=scene.bodies.ball.surface.restitution:0.2,1/2")
    assert [cell.label for cell in typed.cells()] == ["e=0.2", "e=1/2"]
    (one,) = loaded("sweep mass=scene.bodies.ball.mass:3").cells()
    assert one.config.scene.bodies["ball"].mass == 3.0
    more = loaded("sweep h=numerics.timestep:[1/60, 1/120]", text=SWEPT)
    assert len(more.cells()) == 4
    other = loaded("sweep mass=scene.bodies.ball.mass:[3]", text=SWEPT)
    assert [cell.label for cell in other.cells()] == ["mass=3"]


def test_an_axis_is_added_to_every_product_of_a_list() -> None:
    """(A + B) x h is A x h + B x h: each cell of the file, at each of the new values."""
    before = [cell.label for cell in loaded(text=PRODUCTS).cells()]
    after = [cell.label for cell in loaded("sweep h=numerics.timestep:[1/60, 1/120]", text=PRODUCTS).cells()]  # noqa: E501  # fmt: skip
    assert len(before) == 3
    assert sorted(after) == sorted(f"{one}, h={h}" for one in before for h in ("1/60", "1/120"))


@pytest.mark.parametrize(
    ("text", "override", "at", "said"),
    [
        (TEXT, "set duration", "--", "expected --set PATH=VALUE"),
        (TEXT, "set duration=", "--", "expected --set PATH=VALUE"),
        (TEXT, "sweep e=duration", "--", "expected --sweep NAME=PATH:[VALUES]"),
        (TEXT, "set duratoin=1", "duratoin", "path: a sweep cannot reach"),
        (TEXT, "set numerics.timestpe=1", "numerics", 'did you mean "timestep"?'),
        (TEXT, "set scene.bodies.bal.mass=1", "scene", 'did you mean "ball"?'),
        (TEXT, "set scene.bodies.ball=1", "scene", "is a mapping; name one value inside it"),
        (TEXT, "set scene.bodies.ball.mass=heavy", "heavy", "expected a number above 0 [kg]"),
        (TEXT, "set scene.bodies.ball.position=[0, 0, x]", "x]", "expected a number"),
        (TEXT, "set duration=[1", "[1", 'a "[" that is not closed'),
        (TEXT, "sweep m=scene.bodies.ball.mas:[1]", "scene", 'did you mean "mass"?'),
        (TEXT, "sweep m=scene.bodies.ball.mass:3,heavy", "heavy", "expected a number above 0 [kg]"),
        (TEXT, "sweep m=scene.bodies.ball.mass:{a: 1}", "{a", "expected a number"),
        (SWEPT, "set scene.bodies.ball.mass=3", "3", "is varied by axis mass; expected --sweep"),
        (
            PRODUCTS,
            "sweep mass=scene.bodies.ball.mass:[3]",
            "scene",
            "mass is an axis of a list of products in this file",
        ),
    ],
)
def test_what_is_wrong_is_said_at_its_place_in_the_option(
    text: str, override: str, at: str, said: str
) -> None:
    with pytest.raises(ConfigError) as refused:
        loaded(override, text=text)
    first = refused.value.defects[0]
    assert said in first.message
    assert (first.file, first.line) == (f"--{override}", 1)
    assert first.column == f"--{override}".index(at) + 1


def test_a_run_keeps_them(tmp_path: Path) -> None:
    config = tmp_path / "drop.yaml"
    config.write_text(TEXT)
    experiment = load_experiment_text(TEXT, str(config), overrides=["set duration=0.05"])
    done = run(experiment, tmp_path).run
    assert done.path.name.startswith("2")
    assert "-drop-duration=0.05-" in done.path.name
    again = open_run(done.path)
    assert again.experiment.options.overrides == ("set duration=0.05",)
    assert again.cells[0].trace().config.duration == 0.05
    assert again.experiment.cells()[0].config.duration == 0.05
    # Other values make it another experiment: it is not resumed, nor taken for finished.
    assert finished_run(experiment, tmp_path) is not None
    assert finished_run(loaded(), tmp_path) is None
