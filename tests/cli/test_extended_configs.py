"""A run of a config that extends another one is whole by itself: resumed, merged and read alone."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from command_line import lavender

from lavendersim import open_run
from lavendersim.runner import Run, run
from tests.drop_config import DROP

CHILD = """\
extends: ../base.yaml
sweep: {e: {path: scene.bodies.ball.surface.restitution, values: [0.3, 0.5]}}
expect: [{name: rebound, remove: true}]
"""


def logs(found: Run) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in found.path.glob("cells/*")}


@pytest.fixture
def config(tmp_path: Path) -> Path:
    (tmp_path / "base.yaml").write_text(DROP)
    (tmp_path / "cases").mkdir()
    (tmp_path / "cases" / "drops.yaml").write_text(CHILD)
    return tmp_path / "cases" / "drops.yaml"


def test_a_run_is_read_without_the_files_it_was_made_from(config: Path, tmp_path: Path) -> None:
    made = run(config, tmp_path / "runs").run
    (tmp_path / "base.yaml").unlink()
    shutil.rmtree(config.parent)
    again = open_run(made.path)
    assert [cell.label for cell in again.cells] == ["e=0.3", "e=0.5"]
    assert again.experiment.text == (made.path / "config.yaml").read_text()
    assert again.experiment.text.startswith("# drops.yaml, ../base.yaml: merged")


def test_shards_are_merged_to_what_one_process_runs(config: Path, tmp_path: Path) -> None:
    whole, parts = logs(run(config, tmp_path / "whole").run), tmp_path / "parts"
    for part in ("1/2", "2/2"):
        done = lavender("run", config, "--shard", part, "--into", parts, where=tmp_path)
        assert done.returncode == 0, done.stderr
    (tmp_path / "base.yaml").unlink()
    done = lavender("merge", parts, where=tmp_path)
    assert done.returncode == 0, done.stderr
    assert logs(open_run(None, tmp_path / "runs")) == whole


def test_a_parent_that_has_changed_begins_a_new_run(config: Path, tmp_path: Path) -> None:
    arguments = ("run", config, "--resume", "--set", "duration=0.1")
    assert lavender(*arguments, where=tmp_path).returncode == 0
    assert "nothing to resume" in lavender(*arguments, where=tmp_path).stderr
    (tmp_path / "base.yaml").write_text(DROP.replace("mass: 1", "mass: 2"))
    assert lavender(*arguments, where=tmp_path).returncode == 0
    assert len([*(tmp_path / "runs").glob("2*")]) == 2


def test_a_folder_leaves_out_what_is_there_to_be_extended(config: Path, tmp_path: Path) -> None:
    (config.parent / "_part.yaml").write_text("duration: 0.1\n")
    (config.parent / "short.yaml").write_text("extends: drops.yaml\n")
    done = lavender("check", config.parent, where=tmp_path)
    assert done.returncode == 0, done.stderr
    assert {path.name[17:].split("-")[0] for path in (tmp_path / "runs").glob("2*")} == {
        "drops",
        "short",
    }


OF_PARENT = """\
from lavendersim.measures import Trace, own_measure
from lavendersim.quantities.names import BodyName


@own_measure
def highest(trace: Trace, body: BodyName, above: float = 0.0) -> float:
    \"\"\"Greatest height [m] of a body's centre over a level.\"\"\"
    return float(trace.pose[:, trace.bodies.index(body), 2].max()) - above
"""
OF_CHILD = OF_PARENT.replace("def highest", "def topmost")
# Released 0.1 m above the floor with a radius of 0.1 m, a ball is highest at first: 0.2 m.
MEASURED = "  top: {kind: highest, body: ball, above: 0.05}\n"


@pytest.fixture
def measured(config: Path, tmp_path: Path) -> Path:
    """Return a child in a folder of its own of a parent that has measures of a file beside it."""
    base = tmp_path / "base.yaml"
    base.write_text(DROP.replace("measure:\n", f"measure:\n{MEASURED}", 1))
    assert MEASURED in base.read_text()
    (tmp_path / "measures.py").write_text(OF_PARENT)
    return config


def tops(tmp_path: Path) -> list[dict[str, float]]:
    results = json.loads((tmp_path / "runs/latest/results.json").read_text())
    return [row["measures"] for row in results["cells"]]


def test_a_measure_of_the_parents_file_is_found_beside_the_parent(
    measured: Path, tmp_path: Path
) -> None:
    done = lavender("run", "cases/drops.yaml", where=tmp_path)
    assert done.returncode == 0, done.stderr
    assert [row["top"] for row in tops(tmp_path)] == pytest.approx([0.15, 0.15], abs=1e-12)
    written = (tmp_path / "runs/latest/config.yaml").read_text()
    assert written.startswith("# drops.yaml, ../base.yaml: merged")
    assert '"../measures.py"' in written


def test_a_child_changes_what_the_parents_measure_is_given(measured: Path, tmp_path: Path) -> None:
    measured.write_text(CHILD + "measure: {top: {above: 0.1}}\n")
    done = lavender("run", "cases/drops.yaml", where=tmp_path)
    assert done.returncode == 0, done.stderr
    assert tops(tmp_path)[0]["top"] == pytest.approx(0.1, abs=1e-12)


def test_files_beside_child_and_parent_serve_one_config(measured: Path, tmp_path: Path) -> None:
    """A kind is the child's own, or else its parent's; each is measured again by naming both."""
    (measured.parent / "measures.py").write_text(OF_CHILD)
    both = "mine: {kind: topmost, body: ball}, also: {kind: highest, body: ball}"
    measured.write_text(f"{CHILD}measure: {{{both}}}\n")
    assert lavender("run", "cases/drops.yaml", where=tmp_path).returncode == 0
    (first, _) = tops(tmp_path)
    assert [first[name] for name in ("top", "mine", "also")] == pytest.approx([0.15, 0.2, 0.2])
    one = ("verify", "--measures", "measures.py")
    assert lavender(*one, where=tmp_path).returncode == 2
    done = lavender(*one, "--measures", "cases/measures.py", where=tmp_path)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("parent", "child", "sentence"),
    [
        (("kind: highest", "kind: highst"), "",
         'base.yaml:{line}:15: unknown kind "highst" in measure.top; did you mean "highest"?'),
        (("body: ball, above", "bdy: ball, above"), "",
         'base.yaml:{line}:24: unknown key "bdy" in measure.top; did you mean "body"?'),
        (("", ""), "measure: {top: {abov: 1}}\n",
         'cases/drops.yaml:4:17: unknown key "abov" in measure.top; did you mean "above"?'),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_measure_is_said_where_it_stands(
    measured: Path, tmp_path: Path, parent: tuple[str, str], child: str, sentence: str
) -> None:
    base = tmp_path / "base.yaml"
    line = base.read_text()[: base.read_text().index(MEASURED)].count("\n") + 1
    base.write_text(base.read_text().replace(MEASURED, MEASURED.replace(*parent)))
    measured.write_text(CHILD + child)
    done = lavender("plan", "cases/drops.yaml", where=tmp_path)
    assert (done.returncode, done.stderr.splitlines()[0]) == (2, sentence.format(line=line))


def test_what_is_wrong_with_the_parents_file_is_said_at_its_line(
    measured: Path, tmp_path: Path
) -> None:
    (measured.parent / "measures.py").write_text(OF_CHILD)
    (tmp_path / "measures.py").write_text(OF_PARENT.replace(", above: float", ", above"))
    done = lavender("plan", "cases/drops.yaml", where=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("measures.py:5:1: highest: above: expected a type")
    (tmp_path / "measures.py").write_text(OF_PARENT.replace("- above", "/ 0.0"))
    done = lavender("run", "cases/drops.yaml", where=tmp_path)
    assert "../measures.py:8: highest: ZeroDivisionError" in done.stdout + done.stderr
