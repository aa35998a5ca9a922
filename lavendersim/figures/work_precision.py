"""The work-precision page of a cost table: error against cost, and error against timestep.

    error |  x x x  failed                error |        /
          |  o--o                               |      o/   slope 1
          |   \\  `-o   curves: one knob         |    o /
          |    `--o--- front                    |  o  /
          +------------------ cost              +---------- timestep
Numbers are those of `cost.json`; nothing is timed or measured here.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from lavendersim.figures.cost_looks import FAILED, FLOOR, RINGS, Looks, drawn, handles_of
from lavendersim.figures.drawing import describe
from lavendersim.figures.engine_looks import EngineLooks
from lavendersim.figures.engine_looks import handles_of as handles_of_engines
from lavendersim.figures.page import Page, blank, write
from lavendersim.figures.style import DARK, GREY
from lavendersim.figures.timestep_errors import (
    draw_timestep_errors,
    shows_timesteps,
    slope_handles,
)
from lavendersim.measures.cost_table import CostRow, CostTable

WIDTH, LEGEND_WIDTH, HEIGHT = 5.6, 2.9, 5.0  # [inch] of a panel, of the legend
SECOND_WIDTH: Final = 4.2  # [inch]
GAPS: Final = (0.1, 0.04167)  # [inch] around a panel
BAND: Final = 0.9  # share of the axis from which on settings that failed stand
PERTURBED: Final = "perturbed starts, markers at the greatest"
AnyLooks = Looks | EngineLooks
CAPTION: Final = (
    "Error of {measure}{truth}, against the processor's time for a simulated second of physics: "
    "left is cheap, down is accurate. Medians of {repeats} interleaved repeats; the bars, most of "
    "them shorter than a marker is wide, hold the median in 19 of 20 cases. Crosses in the strip "
    "above are settings that failed (diverged, did not converge to their tolerance, or broke a "
    "claim of the experiment), a line of them a solver. "
    "Thin lines join settings that differ in one knob, accuracies asked for among them; the dark "
    "line is the front: no setting is cheaper and as good. Errors below 1e-15 are round-off and "
    "drawn there. Neither compilation "
    "nor logging is in any time. {processor}, clock {clock}. {targets}"
)
OF_ENGINES: Final = (
    "Error of {measure}{truth}, against the processor's time for a simulated second of an engine's "
    "steps alone, one thread: left is cheap, down is accurate. Medians of {repeats} repeats, in "
    "which all engines take turns; bars hold the median in 19 of 20 cases. Hollow: an engine's own "
    "defaults, or what the config specifies. Crosses in the strip above are settings that failed "
    "(ended early, did not converge, or broke a claim of the experiment). Thin lines join settings "
    "that differ in their timestep; thick lines are the front of each engine: none of its settings "
    "is cheaper and as good. Errors below 1e-15 are round-off and drawn there. {processor}, clock "
    "{clock}. {targets}"
)


def draw_work_precision(run: Any, directory: Path) -> list[Path]:
    """Write `<experiment>_cost.png` and `.svg` of a run that has `.name` and `.cost()`.

    Returns the files; none where the run took no cost.
    """
    table = run.cost()
    if table is None:
        return []
    return write(Path(directory) / f"{run.name}_cost", compose, table)


def compose(table: CostTable) -> Figure:
    """Return the page as a matplotlib Figure."""
    widths = [WIDTH, SECOND_WIDTH, LEGEND_WIDTH]
    if not shows_timesteps(table):
        widths = [WIDTH + SECOND_WIDTH, LEGEND_WIDTH]
    figure = blank(Page(_caption(table), sum(widths), HEIGHT, table.question, gaps=GAPS))
    panels = list(figure.subplots(1, len(widths), width_ratios=widths))
    legend = panels.pop()
    of_engines = table.compares_engines
    looks: AnyLooks = EngineLooks.of(table.rows) if of_engines else Looks.of(table.rows)
    draw_settings(panels[0], table, looks)
    for axes in panels[1:]:
        draw_timestep_errors(axes, table, looks)
    limits = [limit for axes in panels for limit in axes.get_ylim()]
    for axes in panels:
        axes.set_ylim(min(limits), max(limits))
    legend.set_axis_off()
    handles = (
        handles_of_engines(table, looks)
        if isinstance(looks, EngineLooks)
        else handles_of(table, looks)
    )
    if len(panels) > 1:
        handles += slope_handles()
    legend.legend(handles=handles, loc="upper left", borderaxespad=0.0)
    return figure


def _caption(table: CostTable) -> str:
    truth = table.truth
    reference = ""
    if truth is not None:
        reference = f", against the same run at a timestep of {truth.timestep} s"
    if table.axes:
        reference += f" (the worst of {table.cells_per_setting} cells of {', '.join(table.axes)})"
    sentences = [*(table.sentences or [target.sentence for target in table.targets])]
    sentences += [f"{engine}: {effort}" for engine, effort in table.efforts.items()]
    sentences += [f"{engine} refused: {why}" for engine, why in table.refused.items()]
    if table.quick:
        sentences = [
            "Quick: the grid has every other value of the config's lists, and their last",
            *sentences,
        ]
    if table.interrupted:
        sentences = [table.interrupted[0].upper() + table.interrupted[1:], *sentences]
    if any(row.least_error is not None for row in table.rows):
        sentences = [f"Upright lines end at the least error over {PERTURBED}", *sentences]
    return (OF_ENGINES if table.compares_engines else CAPTION).format(
        measure=table.error.measure,
        truth=reference,
        repeats=table.repeats,
        processor=table.machine["processor"],
        clock=table.clock,
        targets=". ".join(sentences).replace(" us ", " µs ") + ".",
    )


def draw_settings(axes: Any, table: CostTable, looks: AnyLooks) -> None:
    """Draw every setting, the curves between neighbours, the front and the targets."""
    unit, size = unit_of(table)
    cost, error = f"cost [{unit} per simulated second]", table.error.measure
    describe(axes, "error against cost", cost, f"relative error of {error} [-]", "log", "log")
    timed = [row for row in table.rows if row.ns_per_second is not None]
    stood = [row for row in timed if not row.failed and row.error is not None]
    for curve in looks.curves(stood):
        axes.plot(
            [row.cost / size for row in curve],
            [drawn(row) for row in curve],
            color=looks.colour(curve[0]),
            linestyle=looks.line(curve[0]),
            linewidth=0.9,
            alpha=0.55,
        )
    for row in sorted(stood, key=lambda row: row.is_own):  # nothing hides an engine's own defaults
        _draw_setting(axes, row, size, looks)
    for family in table.engines:
        _draw_front(axes, [row for row in stood if row.family == family], size, looks)
    for target in table.targets:
        axes.axhline(target.target, color=GREY, linewidth=1.1, linestyle=(0, (5, 3)), zorder=1)
        axes.text(
            1.01,
            target.target,
            f"{100.0 * target.target:.3g} %",
            transform=axes.get_yaxis_transform(),
            ha="left",
            va="center",
            fontsize=10,
            color=GREY,
        )
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    low, high = axes.get_ylim()
    if len(stood) < len(timed):
        _draw_failed(axes, [row for row in timed if row not in stood], size, looks)
        high *= (high / low) ** (1.0 / BAND - 1.0 + 0.03)
    axes.set_ylim(low, high)


def _draw_setting(axes: Any, row: CostRow, size: float, looks: AnyLooks) -> None:
    level, spread, colour = drawn(row), row.ns_per_second, looks.colour(row)
    assert spread is not None
    axes.plot([spread.low / size, spread.high / size], [level, level], color=colour, linewidth=1.4)
    if row.least_error is not None:  # over perturbed starts
        errors = [max(row.least_error, FLOOR), level]
        axes.plot([row.cost / size] * 2, errors, color=colour, linewidth=1.4)
    axes.plot(row.cost / size, level, **looks.mark(row), zorder=3)
    _draw_ring(axes, row, row.cost / size, level)


def _draw_failed(axes: Any, rows: Sequence[CostRow], size: float, looks: AnyLooks) -> None:
    """Draw settings that failed in a strip of their own, at their costs, a line a solver."""
    place = axes.get_xaxis_transform()
    strip = Rectangle((0.0, BAND), 1.0, 1.0 - BAND, transform=axes.transAxes, color="#ececec")
    axes.add_patch(strip)
    axes.text(0.01, 0.5 * (1.0 + BAND), "failed", transform=axes.transAxes, va="center", fontsize=9)
    for row in rows:
        cross = {"marker": "x", "linestyle": "none", "color": looks.failed_colour(row), **FAILED}
        level = 1.0 - (1.0 - BAND) * looks.rank(row)
        axes.plot(row.cost / size, level, transform=place, zorder=3, **cross)
        _draw_ring(axes, row, row.cost / size, level, transform=place)


def _draw_ring(axes: Any, row: CostRow, cost: float, level: float, **place: Any) -> None:
    """Draw a ring around what the config specifies, and around the chapter's setting."""
    if row.role in RINGS:
        ring = {"markerfacecolor": "none", "markeredgecolor": DARK, "linestyle": "none"}
        axes.plot(cost, level, **ring, **RINGS[row.role], **place, zorder=4)


def _draw_front(axes: Any, rows: Sequence[CostRow], size: float, looks: AnyLooks) -> None:
    """Draw the front as a stair: what the cheapest setting of at most this cost reaches."""
    front = sorted((row for row in rows if row.front), key=lambda row: row.cost)
    costs, errors = [row.cost / size for row in front], [drawn(row) for row in front]
    colour = looks.front_colour(front[0]) if front else DARK
    axes.step(costs, errors, where="post", color=colour, linewidth=1.6, zorder=2)


def unit_of(table: CostTable) -> tuple[str, float]:
    """Return the unit of costs and its size [ns]: what most settings take some of."""
    costs = sorted(row.cost for row in table.rows if row.ns_per_second is not None)
    middle = costs[len(costs) // 2] if costs else 1e6
    return ("ms", 1e6) if middle >= 5e5 else ("µs", 1e3)
