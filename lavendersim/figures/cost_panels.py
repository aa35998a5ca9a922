"""A panel of a cost table: error against cost of one solver, or engine, with the others as dots.

error |  x x    failed
      |  o--o   .
      |   `-o .    .    curves: one knob
      |    `--o--- front
      +------------------ cost
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from matplotlib.patches import Rectangle
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter, NullLocator

from lavendersim.figures.cost_looks import FAILED, FLOOR, PALE, RINGS, Looks, drawn
from lavendersim.figures.drawing import describe
from lavendersim.figures.engine_looks import EngineLooks
from lavendersim.figures.labels_beside import LineEnd, draw_labels_beside
from lavendersim.figures.style import DARK, GREY
from lavendersim.measures.cost_table import CostRow, CostTable

BAND: Final = 0.88  # share of the axis from which on settings that failed stand
MARGIN: Final = 0.06  # [-] of the axis, for markers and rings at its ends
LAST_TICK: Final = 0.93  # share of the axis below the strip, whose name stands above
TITLE: Final = 11.0  # [pt] the longest name of a solver fits above a panel
FEW_DECADES: Final = 30.0  # the highest cost over the lowest, up to which 1, 2, 5 have room
AnyLooks = Looks | EngineLooks


def draw_settings(axes: Any, table: CostTable, looks: AnyLooks, member: str) -> None:
    """Draw the settings of one solver or engine, those of others, the front and the targets."""
    _, size = unit_of(table)
    describe(axes, looks.members[member], "", "", "log", "log")
    axes.set_title(looks.members[member], loc="left", fontsize=TITLE)
    timed = [row for row in table.rows if row.ns_per_second is not None]
    stood = [row for row in timed if not row.failed and row.error is not None]
    own = [row for row in stood if looks.member_of(row) == member]
    others = [row for row in stood if looks.member_of(row) != member]
    axes.plot(
        [row.cost / size for row in others],
        [drawn(row) for row in others],
        **{"linestyle": "none", "marker": ".", "markersize": 4.0, "color": PALE, "zorder": 1},
    )
    for curve in looks.curves(own):
        axes.plot(
            [row.cost / size for row in curve],
            [drawn(row) for row in curve],
            color=looks.colour(curve[0]),
            linestyle=looks.line(curve[0]),
            linewidth=0.9,
            alpha=0.55,
        )
    for row in sorted(own, key=lambda row: row.is_own):  # nothing hides an engine's own defaults
        _draw_setting(axes, row, size, looks)
    _draw_front(axes, [row for row in stood if looks.shares_front(row, member)], size)
    for target in dict.fromkeys(target.target for target in table.targets):
        axes.axhline(target, color=GREY, linewidth=1.1, linestyle=(0, (5, 3)), zorder=1)
    failed = [row for row in timed if row not in stood and looks.member_of(row) == member]
    if len(stood) < len(timed):
        _draw_failed(axes, failed, size)


def limit_panels(panels: Sequence[Any], table: CostTable) -> tuple[float, float]:
    """Give panels the limits of all of them, with room for the strip; returns those of errors."""
    stood = [row for row in table.rows if row.is_answer]
    _, size = unit_of(table)
    costs = [row.cost / size for row in table.rows if row.ns_per_second is not None] or [1.0]
    errors = [drawn(row) for row in stood] + [target.target for target in table.targets] or [1.0]
    room = 2.0 * (max(errors) / min(errors)) ** MARGIN
    low, high = min(errors) / room, max(errors) * room
    last = high
    if any(row.ns_per_second is not None and not row.is_answer for row in table.rows):
        last = low * (high / low) ** LAST_TICK
        high *= (high / low) ** (1.0 / BAND - 1.0)
    room = 1.1 * (max(costs) / min(costs)) ** MARGIN
    least, most = min(costs) / room, max(costs) * room
    subs = (1.0, 2.0, 5.0) if most < FEW_DECADES * least else (1.0,)
    ticks = LogLocator(numticks=7).tick_values(low, last)
    for axes in panels:
        axes.set_xlim(least, most)
        axes.set_ylim(low, high)
        axes.xaxis.set_major_locator(LogLocator(subs=subs))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.yaxis.set_major_locator(FixedLocator([tick for tick in ticks if low <= tick <= last]))
        axes.yaxis.set_minor_locator(NullLocator())
    return low, high


def name_targets(axes: Any, table: CostTable, height: float) -> None:
    """Write what targets are, beside a panel whose axis is so high [pt]."""
    ends = [
        LineEnd(f"{100.0 * target:.3g} %", target, {"color": GREY})
        for target in dict.fromkeys(target.target for target in table.targets)
    ]
    draw_labels_beside(axes, ends, height)


def name_strip(axes: Any, table: CostTable) -> None:
    """Write what the strip is on the y axis."""
    if any(row.ns_per_second is not None and not row.is_answer for row in table.rows):
        level = 0.5 * (1.0 + BAND)
        axes.text(
            -0.03, level, "failed", transform=axes.transAxes, va="center", ha="right", fontsize=11
        )


def _draw_setting(axes: Any, row: CostRow, size: float, looks: AnyLooks) -> None:
    level, spread, colour = drawn(row), row.ns_per_second, looks.colour(row)
    assert spread is not None
    axes.plot([spread.low / size, spread.high / size], [level, level], color=colour, linewidth=1.4)
    if row.least_error is not None:  # over perturbed starts
        errors = [max(row.least_error, FLOOR), level]
        axes.plot([row.cost / size] * 2, errors, color=colour, linewidth=1.4)
    axes.plot(row.cost / size, level, **looks.mark(row), zorder=3)
    _draw_ring(axes, row, row.cost / size, level)


def _draw_failed(axes: Any, rows: Sequence[CostRow], size: float) -> None:
    """Draw settings that failed in a strip of their own, at their costs."""
    place = axes.get_xaxis_transform()
    strip = Rectangle((0.0, BAND), 1.0, 1.0 - BAND, transform=axes.transAxes, color="#ececec")
    axes.add_patch(strip)
    level = 0.5 * (1.0 + BAND)
    for row in rows:
        cross = {"marker": "x", "linestyle": "none", "color": GREY, **FAILED}
        axes.plot(row.cost / size, level, transform=place, zorder=3, **cross)
        _draw_ring(axes, row, row.cost / size, level, transform=place)


def _draw_ring(axes: Any, row: CostRow, cost: float, level: float, **place: Any) -> None:
    """Draw a ring around what the config specifies, and around the chapter's setting."""
    if row.role in RINGS:
        ring = {"markerfacecolor": "none", "markeredgecolor": DARK, "linestyle": "none"}
        axes.plot(cost, level, **ring, **RINGS[row.role], **place, zorder=4)


def _draw_front(axes: Any, rows: Sequence[CostRow], size: float) -> None:
    """Draw the front as a stair: what the cheapest setting of at most this cost reaches."""
    front = sorted((row for row in rows if row.front), key=lambda row: row.cost)
    costs, errors = [row.cost / size for row in front], [drawn(row) for row in front]
    axes.step(costs, errors, where="post", color=DARK, linewidth=1.3, zorder=2)


def unit_of(table: CostTable) -> tuple[str, float]:
    """Return the unit of costs and its size [ns]: what most settings take some of."""
    costs = sorted(row.cost for row in table.rows if row.ns_per_second is not None)
    middle = costs[len(costs) // 2] if costs else 1e6
    return ("ms", 1e6) if middle >= 5e5 else ("µs", 1e3)
