"""The performance profile of solvers (Dolan and More, 2002), from their times over the best.

    share of problems |            ___________  rho(tau): the share that a solver solves in at most
                      |     ______|   ____      tau times the time of the fastest on that problem
                      |  __|  _______|
                      +----------------- tau
At tau = 1 stands how often a solver is the fastest, at the right end how many it solves at all.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator

from lavendersim.figures.drawing import describe
from lavendersim.figures.page import write
from lavendersim.figures.solver_marks import marks, page_of_solvers, span

WIDTH, HEIGHT = 8.6, 4.0  # [inch]
LEAST_RANGE: Final = 10.0  # tau shown at least
WIDEST: Final = 3.0  # [point] by which the first line is wider than the last
BEYOND: Final = 1.5  # tau shown beyond the largest ratio
CAPTION: Final = (
    "Share of {problems} that a solver brings to a scaled residual of {tolerance:g} within tau "
    "times the time of the fastest solver on the same problem. Left: how often it is the fastest; "
    "right: how many it solves at all; what it does not solve counts as infinite. Wall time of a "
    "whole call without compilation, median of {repeats} that no other program interrupted, where "
    "there are such. {processor}."
)


def draw_profile(
    ratios: dict[str, list[float]],
    comparisons: Sequence[Any],
    tolerance: float,
    processor: str,
    directory: Path,
) -> list[Path]:
    """Write `performance_profile.png` and `.svg`; returns the files, none without problems."""
    if not comparisons:
        return []
    repeats = [one.timing.repeats for each in comparisons for one in each.attempts]
    count = len(comparisons)
    caption = CAPTION.format(
        problems=f"{count} problem{'' if count == 1 else 's'}",
        tolerance=tolerance,
        repeats=span(repeats),
        processor=processor,
    )
    return write(Path(directory) / "performance_profile", compose, ratios, caption)


def compose(ratios: dict[str, list[float]], caption: str) -> Figure:
    """Return the page as a matplotlib Figure."""
    solvers = list(ratios)
    figure = page_of_solvers(solvers, WIDTH, HEIGHT, caption)
    axes = figure.subplots()
    describe(axes, "", "tau: time over that of the fastest [-]", "problems solved [%]", "log")
    finite = [ratio for each in ratios.values() for ratio in each if np.isfinite(ratio)]
    end = max([LEAST_RANGE, *(BEYOND * ratio for ratio in finite)])
    for order, solver in enumerate(solvers):
        taus, shares = profile(ratios[solver], end)
        # Curves that lie on each other stay visible: earlier ones are wider and beneath.
        width = 1.3 + WIDEST * (1.0 - (order + 1) / len(solvers))
        drawn = marks(solvers, solver) | {"linewidth": width, "zorder": 2.0 + 0.01 * order}
        axes.plot(taus, shares, drawstyle="steps-post", clip_on=False, **drawn)
    axes.set_xlim(1.0, end)
    axes.set_ylim(0.0, 100.0)
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if end < 200.0 else (1.0,)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    return figure


def profile(ratios: Sequence[float], end: float) -> tuple[np.ndarray, np.ndarray]:
    """Return where the share changes, from 1 to `end`, and the share [%] from there on."""
    finite = np.sort([ratio for ratio in ratios if np.isfinite(ratio)])
    taus, counts = np.unique(finite, return_counts=True)
    shares = 100.0 * np.cumsum(counts) / max(len(ratios), 1)
    if len(taus) == 0 or taus[0] > 1.0:
        taus, shares = np.insert(taus, 0, 1.0), np.insert(shares, 0, 0.0)
    return np.append(taus, end), np.append(shares, shares[-1])
