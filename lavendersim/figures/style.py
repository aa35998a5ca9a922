"""The one style sheet of all figures: fonts, sizes, colours and markers.

Colours are Okabe and Ito's, distinguished by colour-blind readers; every series has a marker of its
own as well, so grey prints read too. Sizes are chosen for a figure shown at half its size.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

PANEL_WIDTH: Final = 4.9  # [inch]
PANEL_HEIGHT: Final = 3.7  # [inch]
LINE_HEIGHT: Final = 0.235  # of caption and question [inch]
DPI: Final = 150

DARK: Final = "#222222"  # ideals, text
GREY: Final = "#777777"  # levels to compare with

STYLE: Final[dict[str, Any]] = {
    "font.family": "DejaVu Sans",  # ships with matplotlib: the same glyphs everywhere
    "font.size": 12,
    "axes.titlesize": 13,
    "axes.labelsize": 12,
    "xtick.labelsize": 11,
    "ytick.labelsize": 11,
    "legend.fontsize": 10.5,
    "legend.frameon": True,
    "legend.framealpha": 0.85,
    "legend.edgecolor": "none",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": DARK,
    "axes.labelcolor": DARK,
    "text.color": DARK,
    "xtick.color": DARK,
    "ytick.color": DARK,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.8,
    "axes.axisbelow": True,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "svg.hashsalt": "lavender",  # else every SVG gets random ids
    "svg.fonttype": "path",  # the text looks the same without the font
    "path.simplify": True,
}


class Look(NamedTuple):
    """How one series is drawn."""

    colour: str
    marker: str


LOOKS: Final[tuple[Look, ...]] = (
    Look("#0072B2", "o"),  # blue
    Look("#D55E00", "s"),  # vermilion
    Look("#009E73", "^"),  # bluish green
    Look("#CC79A7", "D"),  # reddish purple
    Look("#E69F00", "v"),  # orange
    Look("#56B4E9", "P"),  # sky blue
    Look("#000000", "X"),
    Look("#B3A600", "*"),  # yellow, darkened to be seen on white
)


def look(index: int) -> Look:
    """Return the look of the series with this index; looks repeat after the eighth."""
    return LOOKS[index % len(LOOKS)]
