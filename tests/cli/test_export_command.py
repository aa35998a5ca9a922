"""`lavender export` and the tables of a run, read by DuckDB: the results, and the logs by cell."""

from __future__ import annotations

from pathlib import Path

import duckdb
import numpy as np
import pyarrow as pa
import pytest
from damaged_runs import DRAWN, copied, cut, logs, made, verb
from pyarrow import csv, parquet

from lavendersim import open_run
from lavendersim.runner.export import TABLES

SWEPT = "e: {path: scene.bodies.ball.surface.restitution, values: [0.5, 0.52]}"
SLEEP = "sleep: {path: numerics.sleeping, values: [false, true]}"
TWO_PLANS = DRAWN.replace(SWEPT, SLEEP).replace("series: e", "series: sleep")


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished run of two cells, with its figure."""
    return made(DRAWN, tmp_path_factory.mktemp("run"))


def test_every_table_is_exported_and_names_its_cell(run: Path, tmp_path: Path) -> None:
    done = verb("export", run, "-o", tmp_path)
    assert (done.code, done.stderr) == (0, "")
    written = [name for name in TABLES if name != "velocity"]  # which its config does not ask for
    assert done.stdout.split() == [str(tmp_path / f"{name}.parquet") for name in written]
    for name in written:
        assert parquet.read_schema(tmp_path / f"{name}.parquet").names[:2] == ["cell", "label"]


def test_cells_have_what_the_results_have(run: Path) -> None:
    opened = open_run(run)
    rows = opened.results()["cells"]
    found = pa.table(opened.table("cells")).to_pylist()
    for row, expected, cell in zip(found, rows, opened.cells, strict=True):
        key = (cell.index, cell.label, cell.coordinates["e"])
        assert (row["cell"], row["label"], row["e"]) == key
        assert (row["status"], row["steps"]) == (expected["status"], expected["steps"])
        for name, value in expected["measures"].items():
            assert row[name] == value
        assert row["physics_us_per_step"] == expected["physics_us_per_step"]


def test_verdicts_of_a_cell_are_counted_as_its_own(run: Path) -> None:
    opened = open_run(run)
    verdicts = opened.table("verdicts")  # noqa: F841 - DuckDB finds both by their names
    cells = opened.table("cells")  # noqa: F841
    judged = duckdb.sql(
        "SELECT cell, bool_and(v.passed), any_value(c.passed) FROM verdicts v JOIN cells c "
        "USING (cell) GROUP BY cell ORDER BY cell"
    ).fetchall()
    assert [(index, own) for index, own, _ in judged] == [(i, own) for i, _, own in judged]
    nodes = [row["node"] for row in pa.table(opened.table("verdicts")).to_pylist()]
    assert nodes == [check["node"] for check in opened.results()["checks"]]


@pytest.mark.parametrize("file_format", ["parquet", "csv", "arrow"])
def test_rows_of_a_cell_are_those_of_its_log(file_format: str, run: Path, tmp_path: Path) -> None:
    verb("export", run, "--to", file_format, "--table", "step,contact", "-o", tmp_path)
    readers = {
        "parquet": parquet.read_table,
        "csv": csv.read_csv,
        "arrow": lambda file: pa.ipc.open_file(file).read_all(),
    }
    for name in ("step", "contact"):
        found = readers[file_format](tmp_path / f"{name}.{file_format}")
        cells = found["cell"].to_numpy()
        for cell in open_run(run).cells:
            expected = getattr(cell.trace(), name)
            for column in set(expected.dtype.names) - {"body_a", "body_b"}:
                own = found[column].to_numpy()[cells == cell.index]
                np.testing.assert_array_equal(own, expected[column])


def test_a_column_that_one_plan_has_is_null_in_the_others(tmp_path: Path) -> None:
    step = open_run(made(TWO_PLANS, tmp_path)).table("step")  # noqa: F841
    found = duckdb.sql(
        "SELECT cell, count(*) > 0, count(awake) = count(*), count(awake) = 0 "
        "FROM step GROUP BY cell ORDER BY cell"
    ).fetchall()
    assert found == [(0, True, False, True), (1, True, True, False)]


def test_a_damaged_log_is_not_exported_and_earlier_files_stay(run: Path, tmp_path: Path) -> None:
    spoilt = copied(run, tmp_path)
    verb("export", spoilt)
    before = {file.name: file.read_bytes() for file in (spoilt / "export").iterdir()}
    cut(logs(spoilt)[1], 0.7)
    done = verb("export", spoilt)
    assert (done.code, done.stdout) == (3, "")
    assert "nothing is exported; --allow-incomplete" in done.stderr
    assert {file.name: file.read_bytes() for file in (spoilt / "export").iterdir()} == before
    allowed = verb("export", spoilt, "--allow-incomplete", "-o", tmp_path / "part")
    assert allowed.code == 3
    steps = parquet.read_table(tmp_path / "part" / "step.parquet").num_rows
    assert 0 < steps < parquet.read_table(spoilt / "export" / "step.parquet").num_rows


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--to", "xlsx"), "'xlsx': expected one of parquet, csv, arrow"),
        (("--table", "contacts"), "expected one of cells, verdicts, step, pose, velocity, contact"),
    ],
)
def test_what_there_is_not_is_refused(
    arguments: tuple[str, str], sentence: str, run: Path, tmp_path: Path
) -> None:
    done = verb("export", run, *arguments, "-o", tmp_path / "none")
    assert (done.code, done.stdout) == (2, "")
    assert sentence in done.stderr
    assert not (tmp_path / "none").exists()


def test_a_notebook_shows_summary_verdicts_and_figure(run: Path) -> None:
    shown = open_run(run)._repr_html_()
    assert "2 cells (2 complete)" in shown
    assert "data:image/png;base64," in shown
    for check in open_run(run).results()["checks"]:
        assert f"<td>{check['node']}</td>" in shown


def test_a_notebook_escapes_every_name(run: Path, tmp_path: Path) -> None:
    spoilt = copied(run, tmp_path)
    for file, old in (("cells.json", '"experiment": "drop"'), ("results.json", '"node": "')):
        text = (spoilt / file).read_text()
        new = old.replace("drop", "<script>") if "drop" in old else old + "<script>"
        assert old in text
        (spoilt / file).write_text(text.replace(old, new))
    (spoilt / "DONE").write_text("")  # as of older runs, without digests
    for row in ("cells.json",):
        text = (spoilt / row).read_text()
        (spoilt / row).write_text(text.replace('"log"', '"former"'))
    shown = open_run(spoilt)._repr_html_()
    assert "&lt;script&gt;" in shown
    assert "<script>" not in shown


def test_an_unfinished_run_says_so_in_a_notebook(run: Path, tmp_path: Path) -> None:
    spoilt = copied(run, tmp_path)
    (spoilt / "DONE").unlink()
    assert "this run did not finish" in open_run(spoilt)._repr_html_()
