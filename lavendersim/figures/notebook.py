"""A run as a notebook shows it: summary, verdicts, and its figure as a small picture."""

from __future__ import annotations

import base64
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

from lavendersim.errors import LavenderError
from lavendersim.figures.html_page import Picture, render

WIDTH: Final = 420  # dots of the picture
MOST_VERDICTS: Final = 20  # of a long list the failed ones, then the first
FIGURES: Final = "figures"


class Summary(NamedTuple):
    """What became of a run's cells and claims."""

    cells: Sequence[Any]
    states: Mapping[str, int]  # how many cells ended how
    steps: int
    physics: float  # [us] a step
    passed: int
    claims: int
    shown: Sequence[Any]  # verdicts, failed ones first


def html_of(run: Any) -> str:
    """Return a run as HTML. A damaged or unfinished run says so in place of its results."""
    summary, damage = None, ""
    try:
        summary = _summary(run)
    except LavenderError as error:
        damage = str(error)
    return render(
        "run.html",
        name=_name(run),
        path=str(run.path),
        summary=summary,
        damage=damage,
        picture=_picture(run.path),
    )


def _name(run: Any) -> str:
    try:
        return str(run.name)
    except LavenderError:
        return str(run.path.name)


def _summary(run: Any) -> Summary:
    results = run.results()
    cells, checks = results.cells, results.checks
    return Summary(
        cells=cells,
        states=Counter(row.status for row in cells),
        steps=sum(row.steps for row in cells),
        physics=results.mean_per_step("physics_us_per_step"),
        passed=sum(check.passed for check in checks),
        claims=len(checks),
        shown=sorted(checks, key=lambda check: check.passed)[:MOST_VERDICTS],
    )


def _picture(path: Path) -> Picture | None:
    """Return the first figure that was drawn of the run; None without one."""
    found = sorted((path / FIGURES).glob("*.png"))
    if not found:
        return None
    return Picture(found[0].name, base64.b64encode(found[0].read_bytes()).decode(), WIDTH)
