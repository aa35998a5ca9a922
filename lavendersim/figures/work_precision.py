"""The work-precision page of a cost table: error against cost, and error against timestep.

    a solver       another         and so on: a panel each, the others as grey dots in it
    [ x x    ]     [    x x ]
    [ o-o .. ]     [ .. o-o ]
    error against timestep, every line named beside the panel      legend of the marks
Numbers are those of `cost.json`; nothing is timed or measured here.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from lavendersim.figures.cost_looks import Looks, handles_of
from lavendersim.figures.cost_panels import (
    AnyLooks,
    draw_settings,
    limit_panels,
    name_strip,
    name_targets,
    unit_of,
)
from lavendersim.figures.engine_looks import EngineLooks
from lavendersim.figures.engine_looks import handles_of as handles_of_engines
from lavendersim.figures.page import POINTS_PER_INCH, Page, blank, write
from lavendersim.figures.timestep_errors import (
    AROUND,
    draw_timestep_errors,
    shows_timesteps,
)
from lavendersim.measures.cost_table import CostTable

WIDTH: Final = 12.7  # [inch] of the page
COLUMNS: Final = 4  # panels side by side
HEIGHT, ONLY_HEIGHT = 2.7, 4.0  # [inch] of a row of panels; of one row of few
BELOW_HEIGHT, LEGEND_HEIGHT = 3.6, 0.7  # [inch] errors against timestep; a legend alone
GAPS: Final = (0.08, 0.06)  # [inch] around a panel
PERTURBED: Final = "perturbed starts, markers at the greatest"
CAPTION: Final = (
    "Error of {measure}{truth}, against the processor's time for a simulated second of physics: "
    "left is cheap, down is accurate. Medians of {repeats} interleaved repeats; the bars, most of "
    "them shorter than a marker is wide, hold the median in 19 of 20 cases. Crosses in the strip "
    "above are settings that failed (diverged, did not converge to their tolerance, or broke a "
    "claim of the experiment). Pale dots are the settings of the other solvers. "
    "Thin lines join settings that differ in one knob, accuracies asked for among them; the dark "
    "line, the same in every panel, is the front: no setting is cheaper and as good. Errors below "
    "1e-15 are round-off and drawn there. Neither compilation "
    "nor logging is in any time. {processor}, clock {clock}. {targets}"
)
OF_ENGINES: Final = (
    "Error of {measure}{truth}, against the processor's time for a simulated second of an engine's "
    "steps alone, one thread: left is cheap, down is accurate. Medians of {repeats} repeats, in "
    "which all engines take turns; bars hold the median in 19 of 20 cases. Hollow: an engine's own "
    "defaults, or what the config specifies. Crosses in the strip above are settings that failed "
    "(ended early, did not converge, or broke a claim of the experiment); pale dots are those of "
    "the other engines. Thin lines join settings that differ in their timestep; the dark line is "
    "the front of the engine: none of its settings is cheaper and as good. Errors below 1e-15 are "
    "round-off and drawn there. {processor}, clock {clock}. {targets}"
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
    looks: AnyLooks = EngineLooks.of(table.rows) if table.compares_engines else Looks.of(table.rows)
    columns = min(COLUMNS, len(looks.members))
    rows = -(-len(looks.members) // columns)
    above = rows * HEIGHT if rows > 1 else ONLY_HEIGHT
    below = BELOW_HEIGHT if shows_timesteps(table) else LEGEND_HEIGHT
    figure = blank(Page(_caption(table), WIDTH, above + below, table.question, gaps=GAPS))
    parts: Any = figure.subfigures(2, 1, height_ratios=(above, below))
    upper, lower = parts
    panels = upper.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    drawn = list(panels.ravel())[: len(looks.members)]
    for axes, member in zip(drawn, looks.members, strict=True):
        draw_settings(axes, table, looks, member)
    errors = limit_panels(drawn, table)
    unit, _ = unit_of(table)
    for axes in panels.ravel()[len(drawn) :]:
        axes.set_axis_off()
    for place, axes in enumerate(drawn):
        if place + columns >= len(drawn):  # nothing stands below it
            axes.set_xlabel(f"cost [{unit} per simulated second]", fontsize=11)
            axes.tick_params(labelbottom=True)
        if place % columns == 0:
            axes.set_ylabel(f"relative error of\n{table.error.measure} [-]")
            name_strip(axes, table)
        if place % columns == columns - 1:
            name_targets(axes, table, POINTS_PER_INCH * (above / rows - AROUND))
    _draw_below(lower, table, looks, errors)
    _settle(figure, parts)
    return figure


def _settle(figure: Figure, parts: Sequence[Any]) -> None:
    """Lay the page out, and round where its parts and axes stand.

    The solver of nested layouts leaves them another last digit from time to time, of which names
    in an SVG are made.
    """
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    for part in parts:
        part.bbox_relative.set_points(part.bbox_relative.get_points().round(9))
    for axes in figure.axes:
        axes.set_position(Bbox(axes.get_position().get_points().round(9)))


def _draw_below(part: Any, table: CostTable, looks: AnyLooks, errors: tuple[float, float]) -> None:
    """Draw errors against timesteps, where there are several, and the legend of marks."""
    if shows_timesteps(table):
        timesteps, legend = part.subplots(1, 2, width_ratios=(3.0, 1.0))
        draw_timestep_errors(timesteps, table, looks, errors, BELOW_HEIGHT)
        timesteps.set_ylabel(f"relative error of\n{table.error.measure} [-]")
        place, entries = "upper left", 1
    else:
        legend, place, entries = part.subplots(), "upper left", COLUMNS
    legend.set_axis_off()
    handles = (
        handles_of_engines(table, looks)
        if isinstance(looks, EngineLooks)
        else handles_of(table, looks)
    )
    legend.legend(handles=handles, loc=place, borderaxespad=0.0, ncols=entries)


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
