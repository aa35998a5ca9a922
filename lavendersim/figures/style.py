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
    marker: str  # "" for none
    named: bool = True  # whether the legend has it
    joined: bool = False  # its points by a line, which is all there is to see without a marker


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


MOST_MARKED: Final = 5  # series of numbers with a colour and a marker each
# Red, green, blue of cividis, dark to light; the lightest part is lost on white and left out.
SEQUENTIAL: Final = ((0, 34, 78), (59, 73, 108), (112, 113, 115), (165, 156, 116), (195, 179, 105))


def sequential(rank: int, count: int) -> Look:
    """Return the look of the line whose value is the rank-th (from 0) of several, in rising order.

    The legend has the lowest, the highest and the one in the middle.
    """
    place = rank / (count - 1) * (len(SEQUENTIAL) - 1)
    low = min(int(place), len(SEQUENTIAL) - 2)
    between = zip(SEQUENTIAL[low], SEQUENTIAL[low + 1], strict=True)
    named = (0, (count - 1) // 2, count - 1)
    channels = (round(one + (place - low) * (other - one)) for one, other in between)
    return Look(
        "#" + "".join(f"{channel:02X}" for channel in channels), "", rank in named, joined=True
    )


def look(index: int) -> Look:
    """Return the look of the series with this index; looks repeat after the eighth."""
    return LOOKS[index % len(LOOKS)]
