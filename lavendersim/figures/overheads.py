"""What effects cost: a panel per scene with the overhead of each, and one of compile times.

    effect |   | scene 1, ns   |   | scene 2, ns   |  compile time, s
    drag   |   |     o         |-2 |               |   o s
Numbers are those of `results.json`; nothing is timed here.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from lavendersim.figures.drawing import describe
from lavendersim.figures.page import Page, blank, write
from lavendersim.figures.style import GREY, look
from lavendersim.measures.overhead_table import OverheadRow, OverheadTable, OverheadTiming

ROW: Final = 0.27  # [inch]
SCENE_WIDTH, COMPILE_WIDTH, NAMES_WIDTH = 3.6, 2.6, 2.0  # [inch]
GAPS: Final = (0.08, 0.04167)  # [inch] around a panel
LOWEST, HIGHEST = 0.1, 1e4  # [ns] of the axis; less stands in a strip, as a number
LESS: Final = 0.02  # [ns] where the strip has its name
STRIP: Final = 12.0  # [-] what is left of the axis for it, as a ratio of overheads
IDLE, MOVES, REQUIRED = look(0).colour, look(1).colour, look(4).colour
MARKERS: Final = {"body": "o", "contact": "s"}
CAPTION: Final = (
    "Nanoseconds a step that an effect adds, per body (circles) or per contact (squares): medians "
    "of {repeats} interleaved repeats, with the interval that holds the median in 19 of 20 cases; "
    "hollow where that reaches zero. Blue: the scene does not require it, and the engine carries "
    "it idle through the same motion. Orange: the scene requires it. Vermilion: the motion "
    "without it is another. Less than 0.1 ns stands as a number in the strip; it may be negative: "
    "two engines are two programs. Right: what the engine with the effect takes to compile, once; "
    "lines, the engine of the plan alone. {processor}.{short}"
)
ONLY_REQUIRED: Final = " Quick: of {scenes} only effects that the scene requires are timed."


def draw_overheads(runs: Sequence[Any], directory: Path) -> list[Path]:
    """Write one figure for all runs that have overheads; returns its files, none without any.

    A run has `.name` and `.overheads()`. One gives `<name>_overheads`, several give `overheads`.
    """
    tables = [(str(run.name), table) for run in runs if (table := run.overheads()) is not None]
    if not tables:
        return []
    stem = f"{tables[0][0]}_overheads" if len(tables) == 1 else "overheads"
    return write(Path(directory) / stem, compose, tables)


def compose(tables: Sequence[tuple[str, OverheadTable]]) -> Figure:
    """Return the page as a matplotlib Figure."""
    effects = list(dict.fromkeys(row.effect for _, table in tables for row in table.rows))
    places = {effect: place for place, effect in enumerate(effects)}
    width = NAMES_WIDTH + SCENE_WIDTH * len(tables) + COMPILE_WIDTH
    repeats = sorted({table.repeats for _, table in tables})
    processors = sorted({table.processor for _, table in tables})
    only = ", ".join(name for name, table in tables if table.only_required)
    short = ONLY_REQUIRED.format(scenes=only) if only else ""
    short += "".join(
        f" {name}: {table.interrupted}." for name, table in tables if table.interrupted
    )
    caption = CAPTION.format(
        repeats=" or ".join(map(str, repeats)),
        processor="Processor: " + ", ".join(processors),
        short=short,
    )
    height = ROW * (len(effects) + 1) + 1.1
    figure = blank(Page(caption, width, height, gaps=GAPS))
    widths = [*(SCENE_WIDTH for _ in tables), COMPILE_WIDTH]
    axes = figure.subplots(1, len(widths), squeeze=False, sharey=True, width_ratios=widths)[0]
    axes[0].set_yticks(list(places.values()), labels=[name.replace("_", " ") for name in effects])
    axes[0].set_ylim(len(effects) - 0.4, -0.6)  # in the order of the step, from the top
    timed = [row.timing for _, table in tables for row in table.rows if row.timing is not None]
    highest = max([HIGHEST, *(2.0 * one.overhead.high for one in timed)])
    for panel, (name, table) in zip(axes, tables, strict=False):
        _draw_scene(panel, name, table, places, highest)
    _draw_compile_times(axes[-1], tables, places)
    return figure


def _draw_scene(
    axes: Any, name: str, table: OverheadTable, places: dict[str, int], highest: float
) -> None:
    bodies, contacts = table.bodies, table.contacts_per_step
    title = f"{name}: {bodies} {'body' if bodies == 1 else 'bodies'}, {contacts:.3g} contacts"
    describe(axes, title, "overhead [ns per body or contact and step]", "")
    axes.set_xscale("log")
    axes.axvspan(LOWEST / STRIP, LOWEST, color="#ececec", zorder=0)
    for row in table.rows:
        place = places[row.effect]
        if row.timing is None:
            _write_why_not(axes, place, row.why_not)
            continue
        overhead, colour = row.timing.overhead, _colour(row, row.timing)
        if overhead.high > LOWEST:
            interval = [max(overhead.low, LOWEST), overhead.high]
            axes.plot(interval, [place, place], color=colour, linewidth=1.6)
        if overhead.median < LOWEST:
            _write_number(axes, place, overhead.median)
        axes.plot(
            overhead.median if overhead.median >= LOWEST else LOWEST / STRIP**0.8,
            place,
            linestyle="none",
            marker=MARKERS[row.unit],
            markersize=6.5,
            color=colour,
            markerfacecolor="white" if row.timing.within_noise else colour,
            markeredgewidth=1.3,
            zorder=3,
        )
    axes.set_xlim(LOWEST / STRIP, highest)
    decades = range(-1, 1 + int(np.log10(highest)))
    ticks = [LESS, *(10.0**decade for decade in decades)]
    axes.xaxis.set_major_locator(FixedLocator(ticks))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(_short))


def _write_number(axes: Any, place: int, overhead: float) -> None:
    """Write an overhead that has no place on the axis into its strip."""
    number = _short(float(f"{overhead:.2g}"), 0)
    axes.text(LOWEST / STRIP**0.62, place, number, va="center", fontsize=9)


def _short(value: float, _: int) -> str:
    """Return a tick's label, with k for a thousand: 10000 would not fit beside 1000."""
    if value == LESS:
        return "less"
    return f"{value / 1000.0:g}k" if abs(value) >= 1000.0 else f"{value:g}"


def _colour(row: OverheadRow, timing: OverheadTiming) -> str:
    if not timing.same_motion:
        return MOVES
    return REQUIRED if row.required else IDLE


def _write_why_not(axes: Any, place: int, why_not: str) -> None:
    """Write into the row why it has no number."""
    axes.text(
        0.02,
        place,
        why_not,
        transform=axes.get_yaxis_transform(),
        va="center",
        fontsize=8.5,
        color=GREY,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5},
    )


def _draw_compile_times(
    axes: Any, tables: Sequence[tuple[str, OverheadTable]], places: dict[str, int]
) -> None:
    describe(axes, "compile time", "compile time [s]", "")
    handles = []
    for index, (name, table) in enumerate(tables):
        shown = look(index + 2)  # the first two colours mean something else on this page
        timed = [(row, row.timing) for row in table.rows if row.timing is not None]
        marks: dict[str, Any] = {"linestyle": "none", "marker": shown.marker, "color": shown.colour}
        axes.plot(
            [timing.compile_s_on for _, timing in timed],
            [places[row.effect] for row, _ in timed],
            **marks,
            markersize=5.5,
        )
        idle = [timing.compile_s_off for row, timing in timed if not row.required]
        alone = min(idle, default=None)
        if alone is not None:
            axes.axvline(alone, color=shown.colour, linewidth=1.1)
        handles.append(Line2D([], [], label=name, **marks))
    axes.set_xlim(0.0, 1.06 * axes.dataLim.x1)
    if len(handles) > 1:
        axes.legend(handles=handles, loc="best")
