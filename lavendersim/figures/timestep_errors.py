"""The panel of a cost table that shows error against timestep, each solved as well as it was."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, Final

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter, NullLocator

from lavendersim.figures.cost_looks import FLOOR, Looks, drawn
from lavendersim.figures.drawing import describe, ticks_at_values
from lavendersim.figures.engine_looks import EngineLooks
from lavendersim.figures.labels_beside import LineEnd, draw_labels_beside
from lavendersim.figures.page import POINTS_PER_INCH
from lavendersim.figures.style import GREY
from lavendersim.measures.cost_table import CostRow, CostTable

MS: Final = 1e3
MARGIN: Final = 1.06  # [-] of the timesteps at both sides
AROUND: Final = 1.0  # [inch] of title, ticks and label
SLOPES: Final = {1: (0, (1, 2)), 2: (0, (5, 2, 1, 2))}


def draw_timestep_errors(
    axes: Any,
    table: CostTable,
    looks: Looks | EngineLooks,
    errors: tuple[float, float],
    height: float,
) -> None:
    """Draw, for every solver and preset, the settings that were solved best, and slopes 1 and 2;
    for every engine the least error there is.

    errors: limits of the y axis; height: of the panel with its labels [inch].
    """
    which = "solved best" if isinstance(looks, Looks) else "least of an engine"
    describe(axes, f"error against timestep, {which}", "timestep [ms]", "", "log", "log")
    rows = [
        row
        for row in table.rows
        if row.error is not None and row.role != "chapter" and not row.is_controlled
    ]
    if not rows:
        axes.text(0.5, 0.5, "no setting has an error", transform=axes.transAxes, ha="center")
        return
    curves = best_solved(rows) if isinstance(looks, Looks) else least_errors(rows)
    low, high = errors
    ends: list[LineEnd] = []
    for curve in curves:
        steps = [MS * float(Fraction(row.timestep)) for row in curve]
        values = [drawn(row) for row in curve]
        low, high = min(low, *values), max(high, *values)
        colour, line = looks.colour(curve[0]), looks.line(curve[0])
        axes.plot(steps, values, color=colour, linestyle=line, linewidth=1.2, alpha=0.8)
        for row, step, error in zip(curve, steps, values, strict=True):
            axes.plot(step, error, **looks.mark(row), zorder=3)
        ends.append(LineEnd(looks.name_of(curve[0]), values[-1], {"color": colour}))
    steps = sorted({MS * float(Fraction(row.timestep)) for row in rows})
    axes.set_xlim(steps[0] / MARGIN, steps[-1] * MARGIN)
    axes.set_ylim(low, high)
    axes.yaxis.set_major_locator(LogLocator(numticks=7))
    axes.yaxis.set_minor_locator(NullLocator())
    ends += _draw_slopes(axes, [row for curve in curves for row in curve])
    draw_labels_beside(axes, ends, POINTS_PER_INCH * (height - AROUND))
    ticks_at_values(axes, steps)
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_minor_formatter(NullFormatter())


def shows_timesteps(table: CostTable) -> bool:
    """Return whether there are several timesteps, whose errors have a slope."""
    return len({row.timestep for row in table.rows if row.role != "chapter"}) > 1


def best_solved(rows: Sequence[CostRow]) -> list[list[CostRow]]:
    """Return a curve a solver and preset: most sweeps or least tolerance, warm where it can be."""
    curves: dict[tuple[str, str], dict[str, CostRow]] = {}
    for row in rows:
        curve = curves.setdefault((row.preset, row.solver), {})
        best = curve.get(row.timestep)
        if best is None or _solved(row) > _solved(best):
            curve[row.timestep] = row
    return [
        sorted(curve.values(), key=lambda row: Fraction(row.timestep)) for curve in curves.values()
    ]


def least_errors(rows: Sequence[CostRow]) -> list[list[CostRow]]:
    """Return a curve an engine: of each timestep the setting of least error, failed or not."""
    curves: dict[str, dict[str, CostRow]] = {}
    for row in rows:
        curve = curves.setdefault(row.family, {})
        best = curve.get(row.timestep)
        if best is None or drawn(row) < drawn(best):
            curve[row.timestep] = row
    return [
        sorted(curve.values(), key=lambda row: Fraction(row.timestep)) for curve in curves.values()
    ]


def _solved(row: CostRow) -> tuple[float, int, bool]:
    """Return how hard a setting tries: a tolerance outbids any number of sweeps."""
    tolerance = row.tolerance
    return (-np.inf if tolerance is None else -tolerance, row.sweeps, row.warm_start)


def _draw_slopes(axes: Any, rows: Sequence[CostRow]) -> list[LineEnd]:
    """Draw lines of order 1 and 2 that part at the least timestep, below the largest error."""
    errors = [drawn(row) for row in rows if drawn(row) > FLOOR]
    steps = np.array(sorted({MS * float(Fraction(row.timestep)) for row in rows}))
    if not errors or len(steps) < 2:
        return []
    common = max(errors) * (steps[0] / steps[-1]) ** max(SLOPES)
    ends = []
    for order, dashes in SLOPES.items():
        line = common * (steps / steps[0]) ** order
        look = {"color": GREY, "linewidth": 1.1, "linestyle": dashes}
        axes.plot(steps, line, **look, zorder=1)
        ends.append(LineEnd(f"order {order}", float(line[-1]), look))
    return ends
