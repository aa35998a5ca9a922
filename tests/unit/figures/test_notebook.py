"""A run in a notebook: its cells and claims in sums, failed claims first; damage in words."""

from __future__ import annotations

from pathlib import Path

from lavendersim.errors import TraceError
from lavendersim.figures.notebook import MOST_VERDICTS, html_of
from lavendersim.measures.verdict import Verdict
from lavendersim.runner.run_results import CellResult, RunResults


class Run:
    """A run with its results, or a damaged one."""

    name = "drop <b>"

    def __init__(self, path: Path, results: RunResults | None = None) -> None:
        self.path, self._results = path, results

    def results(self) -> RunResults:
        """Return its tables."""
        if self._results is None:
            raise TraceError("results.json: missing & gone")
        return self._results


def cell(index: int, steps: int, physics: float) -> CellResult:
    """Return the result of a cell whose steps took `physics` us each."""
    return CellResult(index, "", "complete", steps, {}, physics, 0.0, 0.0, None, 0.0, 0)


def verdict(number: int, passed: bool) -> Verdict:
    """Return a verdict with a number of its own."""
    node = f"claim {number}"
    return Verdict("low", node, passed, 1.0, "at most 2", "exact", f"message {number}", "")


def test_texts_are_escaped_and_failed_claims_come_first(tmp_path: Path) -> None:
    cells = (cell(0, 100, 3.0), cell(1, 300, 1.0))
    checks = tuple(verdict(number, number != 30) for number in range(40))
    page = html_of(Run(tmp_path, RunResults("drop", False, None, cells, None, checks, False)))
    assert "drop &lt;b&gt;" in page
    assert "drop <b>" not in page
    # By steps, not by cells: (100 * 3 + 300 * 1) / 400 us.
    assert "400 steps, physics 1.50" in page
    assert "claim 30" in page
    assert sum(f"claim {k}" in page for k in range(30, 40)) == 1
    assert sum(f"claim {k}<" in page for k in range(40)) <= MOST_VERDICTS


def test_a_damaged_run_says_so_in_place_of_its_results(tmp_path: Path) -> None:
    page = html_of(Run(tmp_path))
    assert "results.json: missing &amp; gone" in page


def test_its_first_figure_is_shown(tmp_path: Path) -> None:
    (tmp_path / "figures").mkdir()
    for name in ("b.png", "a.png"):
        (tmp_path / "figures" / name).write_bytes(b"PNG" + name.encode())
    assert "UE5HYS5wbmc=" in html_of(Run(tmp_path))  # PNGa.png
