"""A run in a notebook: its cells and claims in sums, failed claims first; damage in words."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from lavendersim.errors import TraceError
from lavendersim.figures.notebook import MOST_VERDICTS, html_of


class Run:
    """A run with its results, or a damaged one."""

    name = "drop <b>"

    def __init__(self, path: Path, results: dict[str, Any] | None = None) -> None:
        self.path, self._results = path, results

    def results(self) -> dict[str, Any]:
        """Return its tables."""
        if self._results is None:
            raise TraceError("results.json: missing & gone")
        return self._results


def check(number: int, passed: bool) -> dict[str, Any]:
    """Return a verdict."""
    return {
        **{"node": f"claim {number}", "passed": passed, "measured": 1.0, "expected": "at most 2"},
        **{"message": f"message {number}", "margin": 0.5, "follows": False, "tolerance": "exact"},
    }


def test_texts_are_escaped_and_failed_claims_come_first(tmp_path: Path) -> None:
    cells = [
        {"status": "complete", "steps": 100, "physics_us_per_step": 3.0, "label": "", "index": 0},
        {"status": "complete", "steps": 300, "physics_us_per_step": 1.0, "label": "", "index": 1},
    ]
    checks = [check(number, number != 30) for number in range(40)]
    page = html_of(Run(tmp_path, {"cells": cells, "checks": checks, "passed": False}))
    assert "drop &lt;b&gt;" in page
    assert "drop <b>" not in page
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
