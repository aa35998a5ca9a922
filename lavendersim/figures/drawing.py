"""What panels have in common: labels and scales, levels, bands, ideals, ticks and legends."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.ticker import FixedLocator, NullFormatter, NullLocator

from lavendersim.figures.series import Band
from lavendersim.figures.style import DARK, GREY, Look

FEW_TICKS = 8
MANY_MARKERS = 50  # on one line: more would hide it, so every so manyth is drawn
TWO_DECADES = 100.0
LABEL_WIDTH = 0.07  # of the axis: ticks that are nearer would have labels over each other


def describe(
    axes: Any,
    title: str,
    x_label: str,
    y_label: str,
    x_scale: str = "linear",
    y_scale: str = "linear",
) -> None:
    """Set title, labels and scales."""
    axes.set_title(title, loc="left")
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    if x_scale != "linear":  # as axes begin; to set it again would take ticks and labels away
        axes.set_xscale(x_scale)
    if y_scale != "linear":
        axes.set_yscale(y_scale)


def draw_levels(axes: Any, levels: Sequence[Any]) -> None:
    """Draw the constants to compare with as dashed lines."""
    labels = list(dict.fromkeys(level.label for level in levels))
    for place, level in enumerate(levels):
        index = labels.index(level.label)
        dashes = ((0, (5, 3)), (0, (1, 2)), (0, (5, 2, 1, 2)))[index % 3]
        # Levels of one label, such as the two ends of a range, share one entry of the legend.
        first = all(earlier.label != level.label for earlier in levels[:place])
        label = level.label if first else None
        axes.axhline(level.value, color=GREY, linewidth=1.1, linestyle=dashes, label=label)


def limit(axes: Any, panel: Any) -> None:
    """Apply the panel's own limits; called last, since drawing rescales."""
    if panel.x_limits is not None:
        axes.set_xlim(*panel.x_limits)
    if panel.y_limits is not None:
        axes.set_ylim(*panel.y_limits)


def draw_band(
    axes: Any, band: Band, look: Look, label: str, *, joined: bool = False, size: float = 6.0
) -> None:
    """Draw means as markers and the spread as a band; `joined` adds a thin line for the eye."""
    if band.spread:
        axes.fill_between(
            band.places, band.low, band.high, color=look.colour, alpha=0.22, linewidth=0
        )
    axes.plot(
        band.places,
        band.mean,
        linestyle="-" if joined or look.joined else "none",
        linewidth=1.4 if look.joined else 0.9,
        color=look.colour,
        marker=look.marker,
        markersize=size,
        markeredgecolor="white",
        markeredgewidth=0.6,
        markevery=1 + len(band.places) // MANY_MARKERS if joined else None,
        label=label if look.named else None,
        zorder=3,
    )


def draw_ideal(
    axes: Any, places: Any, values: Any, label: str | None, *, order: float = 2.0
) -> None:
    """Draw the ideal as a thin dark line; lines of higher order lie above."""
    axes.plot(places, values, color=DARK, linewidth=1.1, label=label, zorder=order)


def ticks_at_values(axes: Any, values: Any) -> None:
    """On a logarithmic x axis that spans little, put the ticks on the swept values themselves.

    One that is too near the one before for two labels has none.
    """
    unique = np.unique(values)
    if axes.get_xscale() != "log" or len(unique) > FEW_TICKS:
        return
    if unique[0] <= 0 or unique[-1] / unique[0] >= TWO_DECADES * 4:
        return
    shown = [unique[0]]
    for value in unique[1:]:
        if value / shown[-1] >= (unique[-1] / unique[0]) ** LABEL_WIDTH:
            shown.append(value)
    axes.xaxis.set_major_locator(FixedLocator(shown))
    axes.xaxis.set_major_formatter(lambda value, _: _few_digits(value))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_minor_formatter(NullFormatter())


def _few_digits(value: float) -> str:
    """Return three digits, or the whole number; a reader should not have to count 1e+04."""
    whole = value >= 1000.0 and value == round(value) and value < 1e6
    return f"{value:.0f}" if whole else f"{value:.3g}"


def legend(axes: Any) -> None:
    """Draw a legend if anything has a label."""
    handles, _ = axes.get_legend_handles_labels()
    if handles:
        axes.legend(loc="best")
