"""The time of one contact in one sweep against the count of contacts, a curve per solver."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from lavendersim.figures.drawing import describe
from lavendersim.figures.page import write
from lavendersim.figures.solver_marks import marks, page_of_solvers
from lavendersim.figures.style import look

WIDTH, HEIGHT = 8.6, 4.2  # [inch]
CAPTION: Final = (
    "Time of one contact in one sweep, in the contacts of pyramids of boxes that stand: medians of "
    "{repeats} interleaved repeats of {sweeps} sweeps, bands hold the middle half of the samples. "
    "Compilation, packing and everything else that a solve does once are apart. {processor}."
)


def draw_contact_cost(found: Mapping[str, Any], directory: Path) -> list[Path]:
    """Write `contact_cost.png` and `.svg`; returns them.

    found: `repeats`, `sweeps`, `environment` with the `processor`, and rows `growth` with `solver`,
    `contacts` and `samples` [ns].
    """
    return write(Path(directory) / "contact_cost", compose, found)


def compose(found: Mapping[str, Any]) -> Figure:
    """Return the page as a matplotlib Figure."""
    solvers = list(dict.fromkeys(row["solver"] for row in found["growth"]))
    caption = CAPTION.format(
        repeats=found["repeats"],
        sweeps=found["sweeps"],
        processor=found["environment"]["processor"],
    )
    figure = page_of_solvers(solvers, WIDTH, HEIGHT, caption)
    panel = figure.subplots()
    describe(panel, "", "contacts [-]", "time per contact and sweep [ns]", x_scale="log")
    for solver in solvers:
        rows = [row for row in found["growth"] if row["solver"] == solver]
        rows.sort(key=lambda row: row["contacts"])
        contacts = [row["contacts"] for row in rows]
        low, middle, high = np.transpose(
            [np.quantile(row["samples"], (0.25, 0.5, 0.75)) for row in rows]
        )
        colour = look(solvers.index(solver)).colour
        panel.fill_between(contacts, low, high, color=colour, alpha=0.18, linewidth=0)
        panel.plot(contacts, middle, **marks(solvers, solver))
    panel.set_ylim(bottom=0.0)
    return figure
