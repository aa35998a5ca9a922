"""The work-precision page of a cost table: error against cost, and error against timestep.

    error |  x x x  failed, no error      error |        /
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

from lavendersim.figures.cost_looks import FLOOR, RINGS, Looks, drawn, handles_of
from lavendersim.figures.drawing import describe
from lavendersim.figures.engine_looks import EngineLooks
from lavendersim.figures.engine_looks import handles_of as handles_of_engines
from lavendersim.figures.page import Page, blank, write
from lavendersim.figures.style import DARK, GREY
from lavendersim.figures.timestep_errors import draw_timestep_errors
from lavendersim.measures.cost_table import CostRow, CostTable

WIDTH, LEGEND_WIDTH, HEIGHT = 5.6, 2.9, 5.0  # [inch] of a panel, of the legend
SECOND_WIDTH: Final = 4.2  # [inch]
GAPS: Final = (0.1, 0.04167)  # [inch] around a panel
BAND: Final = 0.94  # share of the axis from which on settings without an error stand
PERTURBED: Final = "perturbed starts, markers at the greatest"
AnyLooks = Looks | EngineLooks
CAPTION: Final = (
    "Error of {measure}{truth}, against the processor's time for a simulated second of physics: "
    "left is cheap, down is accurate. Medians of {repeats} interleaved repeats; the bars, most of "
    "them shorter than a marker is wide, hold the median in 19 of 20 cases. Crossed: the setting "
    "failed (it diverged, did not converge to its tolerance, or broke a claim of the experiment). "
    "Thin lines join settings that differ in one knob, accuracies asked for among them; the dark "
    "line is the front: no setting is cheaper and as good. Errors below 1e-15 are round-off and "
    "drawn there. Neither compilation "
    "nor logging is in any time. {processor}, clock {clock}. {targets}"
)
OF_ENGINES: Final = (
    "Error of {measure}{truth}, against the processor's time for a simulated second of an engine's "
    "steps alone, one thread: left is cheap, down is accurate. Medians of {repeats} repeats, in "
    "which all engines take turns; bars hold the median in 19 of 20 cases. Hollow: an engine's own "
    "defaults, or what the config specifies. Crossed: the setting failed (it ended early, did not "
    "converge, or broke a claim of the experiment). Thin lines join settings that differ in their "
    "timestep; thick lines are the front of each engine: none of its settings is cheaper and as "
    "good. Errors below 1e-15 are round-off and drawn there. {processor}, clock {clock}. {targets}"
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
    figure = blank(Page(_caption(table), sum(widths), HEIGHT, table.question, gaps=GAPS))
    work, orders, legend = figure.subplots(1, 3, width_ratios=widths)
    of_engines = table.compares_engines
    looks: AnyLooks = EngineLooks.of(table.rows) if of_engines else Looks.of(table.rows)
    draw_settings(work, table, looks)
    draw_timestep_errors(orders, table, looks)
    limits = [*work.get_ylim(), *orders.get_ylim()]
    for axes in (work, orders):
        axes.set_ylim(min(limits), max(limits))
    legend.set_axis_off()
    handles = (
        handles_of_engines(table, looks)
        if isinstance(looks, EngineLooks)
        else handles_of(table, looks)
    )
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
    for curve in looks.curves(timed):
        shown = [row for row in curve if row.error is not None]
        axes.plot(
            [row.cost / size for row in shown],
            [drawn(row) for row in shown],
            color=looks.colour(curve[0]),
            linestyle=looks.line(curve[0]),
            linewidth=0.9,
            alpha=0.55,
        )
    for row in timed:
        _draw_setting(axes, row, size, looks)
    for family in table.engines:
        _draw_front(axes, [row for row in timed if row.family == family], size, looks)
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
    if any(row.error is None for row in timed):
        band = Rectangle((0.0, BAND), 1.0, 1.0 - BAND, transform=axes.transAxes, color="#ececec")
        axes.add_patch(band)
        axes.text(0.01, 0.97, "no error", transform=axes.transAxes, va="center", fontsize=9)
        high *= (high / low) ** 0.12
    axes.set_ylim(low, high)


def _draw_setting(axes: Any, row: CostRow, size: float, looks: AnyLooks) -> None:
    place: dict[str, Any] = {}
    level = drawn(row) if row.error is not None else 0.5 * (1.0 + BAND)
    if row.error is None:
        place["transform"] = axes.get_xaxis_transform()
    spread = row.ns_per_second
    assert spread is not None
    colour = looks.colour(row)
    ends = [spread.low / size, spread.high / size]
    axes.plot(ends, [level, level], color=colour, linewidth=1.4, **place)
    if row.least_error is not None and row.error is not None:  # over perturbed starts
        errors = [max(row.least_error, FLOOR), level]
        axes.plot([row.cost / size] * 2, errors, color=colour, linewidth=1.4)
    axes.plot(row.cost / size, level, **looks.mark(row), **place, zorder=3)
    if row.failed:
        crossed = {"marker": "x", "markersize": 9, "color": DARK, "markeredgewidth": 1.2}
        axes.plot(row.cost / size, level, linestyle="none", **crossed, **place, zorder=5)
    if row.role in RINGS:
        ring = {"markerfacecolor": "none", "markeredgecolor": DARK, "linestyle": "none"}
        axes.plot(row.cost / size, level, **ring, **RINGS[row.role], **place, zorder=4)


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
