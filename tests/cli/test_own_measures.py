"""Measures of a file beside the config: checked as all others, run there and from nowhere else."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import pytest
from command_line import lavender

from tests.drop_config import SCENE

OWN = '''\
from lavendersim.measures import Trace, own_measure
from lavendersim.quantities.names import BodyName
from pathlib import Path
Path(__file__).with_name("was_run").touch()


@own_measure
def highest(trace: Trace, body: BodyName, above: float = 0.0) -> float:
    """Greatest height [m] of a body's centre over a level."""
    return float(trace.pose[:, trace.bodies.index(body), 2].max()) - above


def not_registered(trace: Trace) -> float:
    return 0.0
'''
# Released 0.1 m above the floor with a radius of 0.1 m, a ball is highest at first: 0.2 m.
CONFIG = (
    SCENE
    + """\
duration: 0.2
sweep: {mass: {path: scene.bodies.ball.mass, values: [1, 2, 3]}}
measure:
  top: {kind: highest, body: ball, above: 0.05, at: {mass: [1, 2]}}
  twice: {kind: ratio, measure: top, to: top}
  unjudged: {kind: highest, body: ball}
expect:
  - {name: the top, measure: top, equals: {value: 0.15, within: 1.0e-12}}
"""
)
EQUALS = "equals: {value: 0.15, within: 1.0e-12}"


@pytest.fixture
def config(tmp_path: Path) -> Path:
    (tmp_path / "measures.py").write_text(OWN)
    path = tmp_path / "own.yaml"
    path.write_text(CONFIG.replace(EQUALS, "between: [0.149999, 0.150001]"))
    return path


def was_run(config: Path) -> bool:
    return config.with_name("was_run").exists()


def test_a_run_takes_them_and_keeps_which_file_they_are_of(config: Path, tmp_path: Path) -> None:
    done = lavender("run", config, where=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "pass  the top" in done.stdout
    assert "unjudged: 0.2 m\n" in done.stdout  # with the unit of its docstring
    results = json.loads((tmp_path / "runs/latest/results.json").read_text())
    tops = [row["measures"].get("top") for row in results["cells"]]
    assert tops[:2] == pytest.approx([0.15, 0.15], abs=1e-12)
    assert tops[2] is None
    digest = hashlib.sha256(OWN.encode()).hexdigest()
    assert f'sha256: "{digest}"' in (tmp_path / "runs/latest/config.yaml").read_text()


@pytest.mark.parametrize(
    ("was", "now", "sentence"),
    [
        ("body: ball, above", "bdy: ball, above",
         'own.yaml:13:24: unknown key "bdy" in measure.top; did you mean "body"?'),
        ("body: ball, above", "body: bal, above",
         'own.yaml:13:30: body: no body is called "bal"; did you mean "ball"?'),
        ("above: 0.05", 'above: "x"',
         'own.yaml:13:43: above: expected a number, found the text "x"'),
        ("body: ball, above: 0.05, ", "",
         "own.yaml:13:8: missing key \"body\" in measure.top"),
        ("kind: highest", "kind: highst",
         'own.yaml:13:15: unknown kind "highst" in measure.top; did you mean "highest"?'),
        ("at: {mass: [1, 2]}", "at: {mass: [1, 9]}",
         "own.yaml:13:64: mass: 9 is not among the swept values 1, 2, 3"),
    ],
)  # fmt: skip
def test_parameters_are_refused_at_their_places(
    config: Path, tmp_path: Path, was: str, now: str, sentence: str
) -> None:
    text = config.read_text()
    assert was in text
    config.write_text(text.replace(was, now))
    done = lavender("plan", "own.yaml", where=tmp_path)
    assert (done.returncode, done.stderr.splitlines()[0]) == (2, sentence)
    assert not (tmp_path / "runs").exists()


@pytest.mark.parametrize(
    ("was", "now", "sentence"),
    [
        ("    return float(", "    return float((", "measures.py:10:"),
        ("from pathlib import Path", "import nothing_of_that_name", "measures.py:3:1: ModuleNot"),
        (", above: float = 0.0", ", above=0.0", "measures.py:7:1: highest: above: expected a type"),
        ("def highest", "def tilt", "measures.py:7:1: tilt: there is a measure of this name"),
    ],
)
def test_a_file_that_cannot_be_run_is_refused_at_its_line(
    config: Path, tmp_path: Path, was: str, now: str, sentence: str
) -> None:
    config.with_name("measures.py").write_text(OWN.replace(was, now))
    config.write_text(config.read_text().replace("kind: highest", "kind: other", 1))
    done = lavender("plan", "own.yaml", where=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith(sentence)
    assert "Traceback" not in done.stderr


def test_an_error_in_a_function_fails_what_is_expected_with_its_line(
    config: Path, tmp_path: Path
) -> None:
    config.with_name("measures.py").write_text(OWN.replace("- above", "/ 0.0 - above"))
    done = lavender("run", config, where=tmp_path)
    assert done.returncode == 1
    assert "Traceback" not in done.stderr
    assert "measures.py:10: highest: ZeroDivisionError" in done.stdout + done.stderr


def test_a_config_that_names_none_of_its_kinds_does_not_run_the_file(
    config: Path, tmp_path: Path
) -> None:
    config.write_text(SCENE + "duration: 0.1\nmeasure: {t: {kind: simulated_duration}}\n")
    assert lavender("run", config, where=tmp_path).returncode == 0
    assert not was_run(config)


def test_no_code_is_run_for_a_run_unless_its_file_is_named(config: Path, tmp_path: Path) -> None:
    assert lavender("run", config, where=tmp_path).returncode == 0
    config.with_name("was_run").unlink()
    for verb in ("show", "ls", "verify", "judge"):
        done = lavender(verb, where=tmp_path)
        assert not was_run(config)
        assert "Traceback" not in done.stderr
        if verb in ("verify", "judge"):
            assert done.returncode == 2
            assert "no code of a run is run; name that file with --measures" in done.stderr
        else:
            assert done.returncode == 0, done.stderr
    for verb in ("verify", "judge"):
        done = lavender(verb, "--measures", "measures.py", where=tmp_path)
        assert done.returncode == 0, done.stderr
    config.with_name("measures.py").write_text(OWN + "# another\n")
    done = lavender("judge", "--measures", "measures.py", where=tmp_path)
    assert done.returncode == 2


def test_shards_are_merged_without_the_file(config: Path, tmp_path: Path) -> None:
    for part in ("1/2", "2/2"):
        done = lavender("run", config, "--shard", part, "--into", "parts", where=tmp_path)
        assert done.returncode == 0, done.stderr
    config.with_name("measures.py").unlink()
    done = lavender("merge", "parts", where=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "pass  the top" in done.stdout


def test_a_changed_file_is_a_changed_config(config: Path, tmp_path: Path) -> None:
    assert lavender("run", config, "--resume", where=tmp_path).returncode == 0
    assert "nothing to resume" in lavender("run", config, "--resume", where=tmp_path).stderr
    config.with_name("measures.py").write_text(OWN + "# another\n")
    assert lavender("run", config, "--resume", where=tmp_path).returncode == 0
    assert len([*(tmp_path / "runs").glob("2*")]) == 2


def test_they_are_listed_with_unit_meaning_and_parameters(config: Path, tmp_path: Path) -> None:
    done = lavender("measures", "highest", "--measures", "measures.py", where=tmp_path)
    assert done.stdout.splitlines() == [
        "highest  m  Greatest height of a body's centre over a level  (of measures.py)",
        "  body",
        "  above: (default 0.0)",
    ]
    assert "of_row" in lavender("measures", where=tmp_path).stdout
