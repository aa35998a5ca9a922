"""Samples of what a contact costs in a sweep in; cost against contact count out, PNG and SVG."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib import style
from matplotlib.figure import Figure

from lavendersim.figures.page import save, wrapped
from lavendersim.figures.residual_against_time import marks, sheet
from lavendersim.figures.style import STYLE, look

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
    with style.context(STYLE, after_reset=True):
        return save(compose(found), Path(directory) / "contact_cost")


def compose(found: Mapping[str, Any]) -> Figure:
    """Return the page as a matplotlib Figure."""
    solvers = list(dict.fromkeys(row["solver"] for row in found["growth"]))
    caption = CAPTION.format(
        repeats=found["repeats"],
        sweeps=found["sweeps"],
        processor=found["environment"]["processor"],
    )
    figure, axes = sheet(solvers, (1, 1), WIDTH, HEIGHT, wrapped(caption, WIDTH))
    panel = axes[0, 0]
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
    panel.set_xscale("log")
    panel.set_ylim(bottom=0.0)
    panel.set_xlabel("contacts [-]")
    panel.set_ylabel("time per contact and sweep [ns]")
    return figure
