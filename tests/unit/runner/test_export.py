"""Tables of a run: which there are, and what is said of those it has not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lavendersim.arrow import Field, Table
from lavendersim.errors import UsageError
from lavendersim.runner import export
from lavendersim.runner.export import TABLES, export_run, table_of

RUN: Any = object()


def table(name: str) -> Table:
    return Table(name, [Field("x", "f8")], lambda: iter([{"x": np.array([1.0, 2.0])}]))


@pytest.fixture(autouse=True)
def _tables(monkeypatch: pytest.MonkeyPatch) -> None:
    def of_log(run: Any, name: str) -> Table:
        if name in ("velocity", "contact"):
            raise UsageError(f"no {name} here")
        return table(name)

    monkeypatch.setattr(export, "log_table", of_log)
    monkeypatch.setattr(export, "_OF_RESULTS", {name: lambda run, n=name: table(n) for name in ("cells", "verdicts")})  # noqa: E501  # fmt: skip


def test_a_table_is_found_by_its_name() -> None:
    assert [table_of(RUN, name).name for name in ("cells", "step")] == ["cells", "step"]
    with pytest.raises(
        UsageError, match=r"'steps': no table of a run; expected one of cells, verdi"
    ):
        table_of(RUN, "steps")
    assert TABLES == ("cells", "verdicts", "step", "pose", "velocity", "contact")


def test_without_names_everything_there_is_and_the_reason_for_the_rest(tmp_path: Path) -> None:
    """Velocities are there where a config asks for them: a run may have none."""
    found = export_run(RUN, "csv", tmp_path)
    tables = {path.name for path in found.files if path.suffix == ".csv"}
    assert tables == {"cells.csv", "pose.csv", "step.csv", "verdicts.csv"}
    assert found.left_out == ["no table contact: no contact here"]
    header, *rows = (tmp_path / "step.csv").read_text().splitlines()
    assert header.strip('"') == "x"
    assert [float(row) for row in rows] == [1.0, 2.0]


def test_a_table_that_is_named_has_to_be_there(tmp_path: Path) -> None:
    assert [path.name for path in export_run(RUN, "parquet", tmp_path, ["step", "step"]).files] == ["step.parquet"]  # noqa: E501  # fmt: skip
    with pytest.raises(UsageError, match="no velocity here"):
        export_run(RUN, "csv", tmp_path, ["step", "velocity"])
    with pytest.raises(UsageError, match="'xls': expected one of"):
        export_run(RUN, "xls", tmp_path)
