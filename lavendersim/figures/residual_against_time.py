"""Residual or velocity error of solvers against the time they took, a panel per contact problem.

scaled residual |  o--o                  one curve per solver, each point a run of its own
                |  s-s  o--o             with a budget of 1, 2, 4, ... sweeps
                |     s----s--o
                +---------------- time of the run
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from lavendersim.figures.page import write
from lavendersim.figures.solver_marks import marks, page_of_solvers, span
from lavendersim.figures.style import GREY

PANEL: Final = (4.3, 3.1)  # [inch]
COLUMNS, PANELS_ON_PAGE = 3, 12
MILLI: Final = 1e-3
DECADE: Final = 10.0
FEW_TICKS: Final = 40.0  # the last time over the first, up to which there is room for 1, 2, 5
LOWEST, HIGHEST = 1e-16, 1e2  # [-] shown; beyond is round-off below and divergence above
NARROWEST: Final = 8.6  # [inch] for the caption and the legend beside a single panel
CAPTION: Final = (
    "What each solver achieved against the time it took: every point is a run of its own from "
    "nothing with 1, 2, 4, ... sweeps, judged afterwards by the scaled residual of its impulses. "
    "Dashed: the tolerance {tolerance:g}. {hollow}Wall time of a whole call without compilation, "
    "median of {repeats} that no other program interrupted, where there are such. {processor}."
)
ERRORS: Final = (
    "How far velocities are from the reference, |u - u*| / max(|u|, |u*|, |q|), against the time a "
    "solver took: every point is a run of its own from nothing with 1, 2, 4, ... sweeps. The "
    "reference is what two independent methods agree on, so that one of these ends at it; where "
    "methods do not agree, nothing is drawn. "
    "{hollow}Wall time of a whole call without compilation, median of {repeats}. {processor}."
)
HOLLOW: Final = "Hollow: not finite or above 100. "
REFERENCED: Final = "referenced"
LABELS: Final = {"scaled": "scaled residual [-]", "error": "velocity error [-]"}


def draw_curves(
    comparisons: Sequence[Any],
    tolerance: float,
    processor: str,
    directory: Path,
    quantity: str = "scaled",
) -> list[Path]:
    """Write `residual_against_time.png` and `.svg`, numbered where one page does not hold all.

    quantity: `scaled`, or `error` against the reference, which makes `error_against_time`.
    """
    drawn = [each for each in comparisons if any(one.points for one in each.attempts)]
    pages = [drawn[at : at + PANELS_ON_PAGE] for at in range(0, len(drawn), PANELS_ON_PAGE)]
    paths = []
    for number, page in enumerate(pages, start=1):
        stem = "residual_against_time" if quantity == "scaled" else "error_against_time"
        stem += f"_{number}" if len(pages) > 1 else ""
        paths += write(Path(directory) / stem, compose, page, tolerance, processor, quantity)
    return paths


def compose(
    comparisons: Sequence[Any], tolerance: float, processor: str, quantity: str = "scaled"
) -> Figure:
    """Return the page as a matplotlib Figure."""
    solvers = names(comparisons)
    columns = min(COLUMNS, len(comparisons))
    rows = -(-len(comparisons) // columns)
    points = [p for each in comparisons for one in each.attempts for p in one.points]
    caption = (CAPTION if quantity == "scaled" else ERRORS).format(
        tolerance=tolerance,
        hollow=HOLLOW if any(not _is_shown(point.scaled) for point in points) else "",
        repeats=span([point.repeats for point in points]),
        processor=processor,
    )
    width = max(NARROWEST, PANEL[0] * columns)
    figure = page_of_solvers(solvers, width, rows * PANEL[1], caption)
    for place, panel in enumerate(figure.subplots(rows, columns, squeeze=False).ravel()):
        if place >= len(comparisons):
            panel.set_axis_off()
            continue
        _draw_panel(panel, comparisons[place], solvers, tolerance, quantity)
        if place % columns == 0:
            panel.set_ylabel(LABELS[quantity])
        if place + columns >= len(comparisons):
            panel.set_xlabel("time [ms]")
    return figure


def names(comparisons: Sequence[Any]) -> list[str]:
    """Return the solvers in the order they were given in."""
    return list(dict.fromkeys(one.solver for each in comparisons for one in each.attempts))


def _is_shown(scaled: float) -> bool:
    return bool(scaled <= HIGHEST)  # false for NaN as well


def _draw_panel(
    axes: Any, comparison: Any, solvers: Sequence[str], tolerance: float, quantity: str
) -> None:
    count = comparison.contacts
    unsure = "" if comparison.truth in ("", REFERENCED) else f"\n{comparison.truth}"
    axes.set_title(
        f"{short(comparison.name)}, {count} contact{'' if count == 1 else 's'}{unsure}", loc="left"
    )
    axes.title.set_fontsize(11)
    axes.set_xscale("log")
    axes.set_yscale("log")
    if quantity == "scaled":
        axes.axhline(tolerance, color=GREY, linewidth=1.1, linestyle=(0, (5, 3)))
    elif comparison.truth != REFERENCED:
        axes.text(0.5, 0.5, "residuals only", transform=axes.transAxes, ha="center", color=GREY)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(NullLocator())
            axis.set_minor_locator(NullLocator())
        return
    for attempt in comparison.attempts:
        times = np.array([point.seconds for point in attempt.points]) / MILLI
        scaled = np.array([getattr(point, quantity) for point in attempt.points])
        shown = np.array([_is_shown(value) for value in scaled], dtype=bool)
        drawn = marks(solvers, attempt.solver)
        axes.plot(times[shown], np.maximum(scaled[shown], LOWEST), **drawn)
        lost = np.full((~shown).sum(), HIGHEST)
        axes.plot(times[~shown], lost, **drawn | {"linestyle": "none", "markerfacecolor": "white"})
    all_times = [point.seconds for one in comparison.attempts for point in one.points]
    _limit_times(axes, min(all_times) / MILLI, max(all_times) / MILLI)
    axes.yaxis.set_major_locator(LogLocator(numticks=7))
    axes.yaxis.set_minor_locator(NullLocator())


def _limit_times(axes: Any, low: float, high: float) -> None:
    """Show a decade at least, so that what calls differ by chance looks as small as it is."""
    low, high = low / 1.2, high * 1.2
    wider = max(1.0, DECADE * low / high)
    axes.set_xlim(low / wider**0.2, high * wider**0.8)
    subs = (1.0, 2.0, 5.0) if high * wider < FEW_TICKS * low else (1.0,)
    axes.xaxis.set_major_locator(LogLocator(subs=subs, numticks=9))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")


def short(name: str) -> str:
    """Return a file's name without what tells its format, cut where a title would not fit."""
    stem = Path(name).name
    for suffix in (".dat", ".hdf5", ".h5"):  # ".hdf5.dat" has two
        stem = stem.removesuffix(suffix)
    return stem if len(stem) <= 28 else f"{stem[:27]}…"
