"""A finished run in; one page of panels with question and caption, as PNG and SVG, out.

No pyplot: a page is a Figure with its own canvas, so drawing needs no display, keeps no global
state and starts faster. Equal logs give equal bytes: no date, fixed ids, a font of our own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final

from matplotlib import style
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath

from lavendersim.errors import TraceError
from lavendersim.experiment.models.figure import FigureSpec
from lavendersim.figures import (
    against_axis,
    by_name,
    row_against_index,
    spinning_top,
    stability_map,
    time_series,
)
from lavendersim.figures.drawing import dress, legend, limit
from lavendersim.figures.series import series_of
from lavendersim.figures.style import DPI, LINE_HEIGHT, PANEL_HEIGHT, PANEL_WIDTH, STYLE
from lavendersim.measures.selection import select
from lavendersim.measures.values import Values
from lavendersim.measures.views import Cell

PANELS: Final[dict[str, Callable[..., None]]] = {
    "measure_against_axis": against_axis.draw_panel,
    "row_against_index": row_against_index.draw_panel,
    "time_series": time_series.draw_panel,
    "free_rotation": spinning_top.draw_panel,
    "measure_by_name": by_name.draw_panel,
    "stability_map": stability_map.draw_panel,
}
POINTS_PER_INCH: Final = 72.0
HINTING: Final = 0.93  # letters placed on whole pixels run wider than their outlines
MARGIN: Final = 0.12  # [inch]
SIDE_BY_SIDE: Final = 3  # panels in one row
FEW_ENTRIES: Final = 4  # of a legend that finds room among the lines
ENTRY_WIDTH: Final = 3.2  # [inch] of an entry as long as the name of a solver
NARROWEST: Final = 6.8  # [inch] a single panel is wider, for its caption


def draw(run: Any, directory: Path) -> list[Path]:
    """Write `<experiment>.png` and `.svg` into the directory; returns them, none without a figure.

    `run` has `.experiment`, `.cells` and, where it differs from the file's, a `.name`. Cells
    without a readable log are left out and counted in the caption.
    """
    experiment = run.experiment
    if experiment.figure is None:
        return []
    name = getattr(run, "name", experiment.name)  # a run kept its file as config.yaml
    with style.context(STYLE, after_reset=True):
        return save(compose(experiment, list(run.cells)), Path(directory) / name)


def save(figure: Figure, stem: Path) -> list[Path]:
    """Write a page as PNG and SVG into a directory, made where missing; returns the files."""
    stem.parent.mkdir(parents=True, exist_ok=True)
    paths = [stem.with_name(f"{stem.name}.{suffix}") for suffix in ("png", "svg")]
    figure.savefig(paths[0], dpi=DPI, metadata={"Software": None})
    figure.savefig(paths[1], metadata={"Date": None, "Creator": "lavender"})
    return paths


def compose(experiment: Any, cells: Sequence[Cell]) -> Figure:
    """Return the page as a matplotlib Figure."""
    spec: FigureSpec = experiment.figure
    readable = [cell for cell in cells if _is_readable(cell)]
    missing = len(cells) - len(readable)
    note = f" Left out: {missing} of {len(cells)} cells have no readable log." if missing else ""
    lines, columns = _grid(len(spec.panels))
    width = max(NARROWEST, PANEL_WIDTH * columns)
    caption = wrapped(spec.caption + note, width)
    question = wrapped(experiment.question, width, weight="bold")
    entries = _shared_entries(spec, readable)
    rows = -(-entries // _columns(width))
    beneath = LINE_HEIGHT * (caption.count("\n") + 1) + 2 * MARGIN
    below = beneath + (LINE_HEIGHT * rows + MARGIN if rows else 0.0)
    above = LINE_HEIGHT * (question.count("\n") + 1) + 2 * MARGIN if question else MARGIN
    height = PANEL_HEIGHT * lines + below + above
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    figure.set_layout_engine(
        "constrained",
        rect=(0.0, below / height, 1.0, PANEL_HEIGHT * lines / height),
        w_pad=0.12,
        h_pad=0.1,
    )
    left = MARGIN / width
    figure.text(left, 1.0 - MARGIN / height, question, va="top", weight="bold")
    figure.text(left, MARGIN / height, caption, va="bottom", linespacing=1.25)
    _draw_panels(figure, experiment, readable, shared=entries > 0)
    if entries:
        _draw_shared_legend(figure, width, beneath / height)
    return figure


def _shared_entries(spec: FigureSpec, cells: Sequence[Cell]) -> int:
    """Return how many entries a legend beneath all panels has; 0 where each panel has its own.

    Panels of the same many series would hide their lines behind their legends.
    """
    split = {panel.series for panel in spec.panels}
    if len(split) != 1 or None in split:
        return 0
    entries = len(series_of(cells, spec.panels[0].series))
    return entries if entries > FEW_ENTRIES else 0


def _grid(panels: int) -> tuple[int, int]:
    """Return rows and columns: up to three panels side by side, more in two rows."""
    rows = 1 if panels <= SIDE_BY_SIDE else 2
    return rows, -(-panels // rows)


def _columns(width: float) -> int:
    return max(1, int(width / ENTRY_WIDTH))


def _draw_shared_legend(figure: Figure, width: float, bottom: float) -> None:
    named: dict[str, Any] = {}
    for axes in figure.axes:
        handles, labels = axes.get_legend_handles_labels()
        for handle, label in zip(handles, labels, strict=True):
            named.setdefault(label, handle)
    legend = figure.legend(
        list(named.values()),
        list(named),
        loc="lower center",
        bbox_to_anchor=(0.5, bottom),
        ncols=_columns(width),
        borderaxespad=0.0,
        borderpad=0.0,
    )
    legend.set_in_layout(False)  # its room is part of the page's height


def _draw_panels(figure: Figure, experiment: Any, cells: Sequence[Cell], shared: bool) -> None:
    values = Values(experiment.measures)
    panels = experiment.figure.panels
    places = figure.subplots(*_grid(len(panels)), squeeze=False).ravel()
    for axes in places[len(panels) :]:
        axes.set_axis_off()
    for axes, panel in zip(places, panels, strict=False):
        dress(axes, panel)
        measure = experiment.measures.get(getattr(panel, "measure", ""))
        shown = select(cells, panel.at, measure.at if measure is not None else {})
        PANELS[panel.kind](axes, panel, shown, values, experiment)
        limit(axes, panel)
        if not shared:
            legend(axes)


def _is_readable(cell: Cell) -> bool:
    try:
        return len(cell.trace().step) > 0
    except (TraceError, OSError):
        return False


def wrapped(text: str, width: float, weight: str = "normal") -> str:
    """Break a text into lines that end inside the page, by the true widths of its letters."""
    font = FontProperties(weight=weight, size=STYLE["font.size"], family=STYLE["font.family"])
    left = most = HINTING * (width - 2 * MARGIN) * POINTS_PER_INCH
    space = _text_width("n n", font) - _text_width("nn", font)
    lines: list[list[str]] = [[]]
    for word in text.split():
        needed = _text_width(word, font) + space
        if lines[-1] and needed > left:
            lines.append([])
            left = most
        lines[-1].append(word)
        left -= needed
    return "\n".join(" ".join(line) for line in lines)


def _text_width(text: str, font: FontProperties) -> float:
    return float(TextPath((0, 0), text, prop=font).get_extents().width)
