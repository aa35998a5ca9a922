"""`extends`: which files may be named, how far, and where what is wrong with them is reported."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment, load_experiment_text
from lavendersim.experiment.inheritance.parents import MOST_PARENTS

BASE = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 0.5]}
duration: 0.1
sweep: {mass: {path: scene.bodies.ball.mass, values: [1, 2]}}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return the folder of a child, below that of its parent; the project is above both."""
    (tmp_path / "base.yaml").write_text(BASE)
    (tmp_path / "cases").mkdir()
    return tmp_path / "cases"


def child(folder: Path, text: str, name: str = "child.yaml") -> Path:
    (folder / name).write_text(text)
    return folder / name


def refusal(path: Path) -> list[str]:
    with pytest.raises(ConfigError) as refused:
        load_experiment(path)
    return [str(defect).replace(f"{path.parent.parent}/", "") for defect in refused.value.defects]


def test_a_child_has_all_of_its_parent_but_what_it_says(folder: Path) -> None:
    experiment = load_experiment(child(folder, "extends: ../base.yaml\nduration: 0.2\n"))
    assert experiment.name == "child"
    assert [cell.config.duration for cell in experiment.cells()] == [0.2, 0.2]
    assert [cell.label for cell in experiment.cells()] == ["mass=1", "mass=2"]


def test_its_text_is_whole_without_the_parent(folder: Path) -> None:
    path = child(folder, "extends: ../base.yaml\nnumerics: {timestep: 1/480}\n")
    experiment = load_experiment(path)
    alone = load_experiment_text(experiment.text, "config.yaml")
    digests = [[cell.digest for cell in one.cells()] for one in (experiment, alone)]
    assert digests[0] == digests[1]
    (folder.parent / "base.yaml").write_text(BASE.replace("0.5]", "0.6]"))
    changed = load_experiment(path)
    assert changed.text != experiment.text
    assert [cell.digest for cell in changed.cells()] != digests[0]


def test_a_config_that_extends_nothing_keeps_its_text(folder: Path) -> None:
    assert load_experiment(folder.parent / "base.yaml").text == BASE


def test_values_of_the_command_line_come_last(folder: Path) -> None:
    path = child(folder, "extends: ../base.yaml\nduration: 0.2\n")
    experiment = load_experiment(path, overrides=("set duration=0.3",))
    assert experiment.cells()[0].config.duration == 0.3


def test_what_is_wrong_is_reported_in_the_file_that_says_it(folder: Path) -> None:
    (folder.parent / "base.yaml").write_text(BASE.replace("radius: 0.1", "radius: -1"))
    path = child(folder, "extends: ../base.yaml\nduratoin: 0.2\n")
    assert refusal(path) == [
        'cases/child.yaml:2:1: unknown key "duratoin" in the experiment; did you mean "duration"?',
        "base.yaml:4:42: radius: expected a number above 0 [m], found -1",
    ]


def test_a_parents_text_is_refused_at_its_place(folder: Path) -> None:
    (folder.parent / "base.yaml").write_text("scene: {a: [1, 2\n")
    path = child(folder, "extends: ../base.yaml\n")
    (said,) = refusal(path)
    assert said.startswith('base.yaml:1:12: a "[" that is not closed')


def test_a_chain_is_read_from_the_uppermost(folder: Path) -> None:
    child(folder, "extends: ../base.yaml\nduration: 0.2\n", "middle.yaml")
    path = child(folder, "extends: middle.yaml\nquestion: why\n")
    experiment = load_experiment(path)
    assert (experiment.config.question, experiment.config.duration) == ("why", 0.2)
    assert experiment.text.startswith("# child.yaml, middle.yaml, ../base.yaml: merged")


def chain(folder: Path, parents: int) -> Path:
    (folder / "0.yaml").write_text(BASE)
    for number in range(parents):
        child(folder, f"extends: {number}.yaml\n", f"{number + 1}.yaml")
    return folder / f"{parents}.yaml"


def test_a_chain_has_a_greatest_length(folder: Path) -> None:
    assert load_experiment(chain(folder, MOST_PARENTS)).cells()
    assert refusal(chain(folder, MOST_PARENTS + 1)) == [
        "cases/1.yaml:1:10: extends: expected at most 8 files one above the other"
    ]


@pytest.mark.parametrize(
    ("said", "sentence"),
    [
        ("child.yaml", '"child.yaml" extends this file in turn; expected no circle'),
        ("../bsae.yaml", "bsae.yaml: no such file or directory"),
        ("[a.yaml]", "expected the path of a file *.yaml, such as ../base.yaml, found a list of 1"),
        ("/etc/passwd", "expected the path of a file *.yaml, such as ../base.yaml, "
         'found the text "/etc/passwd"'),
        ("/etc/a.yaml", 'expected a path from this file\'s folder, found "/etc/a.yaml"'),
    ],
)  # fmt: skip
def test_what_cannot_be_extended_is_refused(folder: Path, said: str, sentence: str) -> None:
    assert refusal(child(folder, f"extends: {said}\n")) == [
        f"cases/child.yaml:1:10: extends: {sentence}"
    ]


def test_no_file_outside_of_the_project_is_read(folder: Path) -> None:
    """Without a project it is the folder above the config's; links are followed first."""
    outer = folder.parent.parent / f"{folder.parent.name}-outer.yaml"
    outer.write_text(BASE)
    try:
        path = child(folder, f"extends: ../../{outer.name}\n")
        (said,) = refusal(path)
        assert "is outside of" in said
        (folder / "link.yaml").symlink_to(outer)
        (said,) = refusal(child(folder, "extends: link.yaml\n"))
        assert "is outside of" in said
        (folder.parent / "deep").mkdir()
        moved = folder.parent / "deep" / "cases"
        shutil.move(folder, moved)
        path = child(moved, "extends: ../../base.yaml\n")
        (said,) = refusal(path)
        assert "is outside of" in said
        (folder.parent / "pyproject.toml").touch()
        assert load_experiment(path).cells()
    finally:
        outer.unlink()


def test_a_circle_of_several_files_is_refused(folder: Path) -> None:
    child(folder, "extends: b.yaml\n", "a.yaml")
    child(folder, "extends: a.yaml\n", "b.yaml")
    assert refusal(folder / "a.yaml") == [
        'cases/b.yaml:1:10: extends: "a.yaml" extends this file in turn; expected no circle'
    ]


def test_a_text_has_no_parents() -> None:
    with pytest.raises(ConfigError, match="a text has no folder"):
        load_experiment_text(f"extends: ../base.yaml\n{BASE}", "child.yaml")
