"""Figures of runs as PNG and SVG, and HTML reports. matplotlib and Jinja are imported only here."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from lavendersim.errors import TraceError


def draw(run: Any, directory: Path) -> list[Path]:
    """Draw the figures of a run (`.experiment`, `.cells`): its own, its overheads', its cost's.

    Returns the files written. TraceError, and no file is touched, where a log of the run is damaged
    (`.damaged`), unless it may be incomplete (`.allow_incomplete`). matplotlib is imported here and
    not before: it takes a quarter of a second.
    """
    from lavendersim.figures.config_figure import draw as draw_page

    _refuse_damaged(run)
    paths = draw_page(run, directory)
    if run.experiment.config.overhead is not None:
        paths += draw_overheads([run], directory)
    if callable(getattr(run, "cost", None)) and run.cost() is not None:
        from lavendersim.figures.work_precision import draw_work_precision

        paths += draw_work_precision(run, directory)
    return paths


def prepare() -> None:
    """Import what draws a figure, before there is one to be drawn."""
    from lavendersim.figures import config_figure  # noqa: F401


def _refuse_damaged(run: Any) -> None:
    """Raise TraceError where a log is damaged and may not be; one just written is read strictly."""
    if getattr(run, "allow_incomplete", True) or getattr(run, "ran", None) is not None:
        return
    if damaged := run.damaged():
        raise TraceError("\n".join(damaged))


def draw_overheads(runs: Sequence[Any], directory: Path) -> list[Path]:
    """Draw what effects cost in the scenes of some runs, side by side; returns the files."""
    from lavendersim.figures.overheads import draw_overheads as draw_page

    return draw_page(runs, directory)


def draw_comparisons(
    comparisons: Sequence[Any],
    ratios: dict[str, list[float]],
    tolerance: float,
    processor: str,
    directory: Path,
) -> list[Path]:
    """Draw what solvers reached in what time, and their performance profile; returns the files.

    A comparison has `.name`, `.contacts` and `.attempts`, see `problems.comparison`; `ratios` are
    times over the best, by solver.
    """
    from lavendersim.figures.performance_profile import draw_profile
    from lavendersim.figures.residual_against_time import draw_curves

    paths = draw_curves(comparisons, tolerance, processor, directory)
    if any(comparison.truth for comparison in comparisons):
        paths += draw_curves(comparisons, tolerance, processor, directory, "error")
    return paths + draw_profile(ratios, comparisons, tolerance, processor, directory)


def check_page_path(page: Path) -> None:
    """Make the folder of a page to come; UsageError where no page can be. Before long runs."""
    from lavendersim.figures.html_page import check_page_path as check

    check(page)


def write_report(
    results: Sequence[Any], path: Path, about: Mapping[str, str] | None = None
) -> list[str]:
    """Write one self-contained HTML page of finished runs (`runner.Finished`): a row per case.

    about: how they were made, in words, by what it says. Returns a sentence of each log that is
    damaged; they stand in the page as well.
    """
    from lavendersim.figures.report import write_report as write_page

    return write_page(results, path, about or {})


def write_matrix(
    cases: Sequence[Any],
    solvers: Sequence[str],
    entries: Sequence[Any],
    left_out: Mapping[str, str],
    *,
    shown: Mapping[str, Any],
    processor: str,
    path: Path,
    what: str = "solver",
    about: Mapping[str, Mapping[str, str]] | None = None,
) -> None:
    """Write one self-contained HTML page: a matrix of cases and solvers, or engines (`what`).

    cases: `runner.solver_matrix.Case`; entries: `runner.matrix_entry.Entry`, those there are;
    left_out: case -> why; shown: case -> the cell whose last state is drawn; about: solver ->
    what is to be known of it, by term, its law among them.
    """
    from lavendersim.figures.report_matrix import Matrix
    from lavendersim.figures.report_matrix import write_matrix as write_page

    given = (cases, solvers, entries, left_out, shown, processor, what, about or {})
    write_page(Matrix(*given), path)
