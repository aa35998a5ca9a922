"""The figure that a config describes: its panels side by side, drawn from the logs of a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from matplotlib.figure import Figure

from lavendersim.errors import TraceError
from lavendersim.figures import panels
from lavendersim.figures.drawing import describe, draw_levels, legend, limit
from lavendersim.figures.page import Page, blank, legend_below, write
from lavendersim.figures.registration import FUNCTIONS
from lavendersim.figures.series import looks_of, series_of
from lavendersim.figures.specs.catalogue import FigureSpec
from lavendersim.figures.style import PANEL_HEIGHT, PANEL_WIDTH
from lavendersim.measures.interfaces import Cell
from lavendersim.measures.selection import select
from lavendersim.measures.values import Values

SIDE_BY_SIDE: Final = 3  # panels in one row
FEW_NAMED: Final = 3  # of many cells with damaged logs
FEW_ENTRIES: Final = 4  # of a legend that finds space among the lines
NARROWEST: Final = 6.8  # [inch] a single panel is wider, for its caption


# By the index of a cell: its measures that were taken already.
Taken = Mapping[int, Mapping[str, Any]]

panels.load_all()


def draw(run: Any, directory: Path) -> list[Path]:
    """Write `<experiment>.png` and `.svg` into the directory; returns them, none without a figure.

    `run` has `.experiment`, `.cells` and, where it differs from the file's, a `.name`; in the
    process that ran it `.taken`, the measures of its cells. Cells without a readable log are left
    out and counted in the caption; where damaged logs are drawn it says of which cells.
    """
    experiment = run.experiment
    if experiment.config.figure is None:
        return []
    name = getattr(run, "name", experiment.name)  # a run kept its file as config.yaml
    taken = getattr(run, "taken", {})
    return write(Path(directory) / name, compose, experiment, list(run.cells), taken)


def compose(experiment: Any, cells: Sequence[Cell], taken: Taken = MappingProxyType({})) -> Figure:
    """Return the page as a matplotlib Figure; taken: measures of the cells, by their index."""
    spec: FigureSpec = experiment.config.figure
    readable = [cell for cell in cells if (taken and cell.index in taken) or _is_readable(cell)]
    missing = len(cells) - len(readable)
    note = f" Left out: {missing} of {len(cells)} cells have no readable log." if missing else ""
    known = [] if taken else readable  # of a run in the process that made it nothing is missing
    rows, columns = _grid(len(spec.panels))
    page = Page(
        caption=_incomplete(known, len(cells)) + spec.caption + note,
        width=max(NARROWEST, PANEL_WIDTH * columns),
        height=PANEL_HEIGHT * rows,
        question=experiment.config.question,
        legend_below=_shared_entries(spec, readable),
    )
    figure = blank(page)
    values = Values(experiment.measures, taken)
    _draw_panels(figure, experiment, readable, values, shared=page.legend_below > 0)
    if page.legend_below:
        legend_below(figure, page)
    return figure


def _shared_entries(spec: FigureSpec, cells: Sequence[Cell]) -> int:
    """Return how many entries a legend below all panels has; 0 where each panel has its own.

    Panels of the same many series would hide their lines behind their legends.
    """
    split = {panel.series for panel in spec.panels}
    if len(split) != 1 or None in split:
        return 0
    all_series = series_of(cells, spec.panels[0].series)
    entries = sum(look.named for look in looks_of(all_series))
    return entries if entries > FEW_ENTRIES else 0


def _grid(panels: int) -> tuple[int, int]:
    """Return rows and columns: up to three panels side by side, more in two rows."""
    rows = 1 if panels <= SIDE_BY_SIDE else 2
    return rows, -(-panels // rows)


def _draw_panels(
    figure: Figure, experiment: Any, cells: Sequence[Cell], values: Values, shared: bool
) -> None:
    shown_panels = experiment.config.figure.panels
    places = figure.subplots(*_grid(len(shown_panels)), squeeze=False).ravel()
    for axes in places[len(shown_panels) :]:
        axes.set_axis_off()
    for axes, panel in zip(places, shown_panels, strict=False):
        describe(axes, panel.title, panel.x_label, panel.y_label, panel.x_scale, panel.y_scale)
        draw_levels(axes, panel.levels)
        measure = experiment.measures.get(getattr(panel, "measure", ""))
        shown = select(cells, panel.at, measure.at if measure is not None else {})
        FUNCTIONS[type(panel)](axes, panel, shown, values, experiment)
        limit(axes, panel)
        if not shared:
            legend(axes)


def _incomplete(cells: Sequence[Cell], count: int) -> str:
    """Return what a caption begins with where logs are damaged: how much is drawn of which."""
    parts = []
    for cell in cells:
        trace = cell.trace()
        if getattr(trace, "damage", ""):
            name = cell.label or "the cell"
            parts.append(f"{name}: {len(trace.step)} steps up to {trace.step['time'][-1]:.4g} s")
    if not parts:
        return ""
    more = f"; and {len(parts) - FEW_NAMED} more" if len(parts) > FEW_NAMED else ""
    drawn = f"{'; '.join(parts[:FEW_NAMED])}{more}"
    return f"INCOMPLETE: the logs of {len(parts)} of {count} cells are damaged; drawn is {drawn}. "


def _is_readable(cell: Cell) -> bool:
    try:
        return len(cell.trace().step) > 0
    except (TraceError, OSError):
        return False
