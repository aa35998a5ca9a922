"""The tutorial notebook runs from its first cell to its last, and shows what it says."""

from __future__ import annotations

import ast
import json
from pathlib import Path
from typing import Any

import pytest

NOTEBOOK = Path(__file__).resolve().parents[2] / "docs" / "tutorial.ipynb"


def shown(source: str, names: dict[str, Any]) -> Any:
    """Execute a cell as a notebook does; return the value of its last expression."""
    tree = ast.parse(source)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "tutorial", "exec"), names)
    if last is None:
        return None
    return eval(compile(ast.Expression(last.value), "tutorial", "eval"), names)


def test_every_cell_of_the_tutorial_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    notebook = json.loads(NOTEBOOK.read_text())
    names: dict[str, Any] = {}
    values = [
        shown("".join(cell["source"]), names)
        for cell in notebook["cells"]
        if cell["cell_type"] == "code"
    ]
    good, run, rebounds, _, trace, _, steps = values
    assert good is True
    assert "2 cells" in run._repr_html_()
    assert sorted(rebounds) == [0.5, 0.8]
    assert repr(trace).startswith("Trace of ")
    assert "floor, ball" in repr(trace)
    assert steps == 3 * 480
    assert "impulse 7.97" in capsys.readouterr().out  # 1.8 sqrt(2 g) = 7.973


def test_the_notebook_has_no_outputs_that_could_be_stale() -> None:
    cells = [c for c in json.loads(NOTEBOOK.read_text())["cells"] if c["cell_type"] == "code"]
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in cells)
