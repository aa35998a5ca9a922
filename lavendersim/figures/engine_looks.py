"""Colours, markers, lines and legend of the settings on a work-precision page of several engines.

A colour is an engine, a marker a timestep; hollow is an engine's own defaults, or what the config
specifies of lavender's. An engine has its colour in every figure, whichever others are beside it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import groupby
from typing import Any, Final, NamedTuple

from matplotlib.lines import Line2D

from lavendersim.figures.cost_looks import COLOURED, CONTROLLED, FAILED, MARKERS, PALE, RINGS
from lavendersim.figures.style import DARK, Look
from lavendersim.measures.cost_table import ENGINES, CostRow, CostTable

COLOURS: Final[dict[str, Look]] = {
    name: COLOURED[place % len(COLOURED)] for place, name in enumerate(ENGINES)
}


class EngineLooks(NamedTuple):
    """What colours and markers stand for."""

    titles: dict[str, str]  # of engines, by name
    timesteps: dict[str, str]  # marker by timestep

    @classmethod
    def of(cls, rows: Sequence[CostRow]) -> EngineLooks:
        """Give every timestep its marker, the coarsest first."""
        fixed = {row.timestep for row in rows if not row.is_controlled}
        steps = sorted(fixed, key=lambda step: -Fraction(step))
        markers = {step: MARKERS[place % len(MARKERS)] for place, step in enumerate(steps)}
        return cls({row.family: row.title for row in rows}, markers)

    def colour(self, row: CostRow) -> str:
        """Return the colour of a setting."""
        return str(COLOURS[row.family].colour)

    def line(self, row: CostRow) -> Any:
        """Return the line of the curve that a setting is on."""
        return "-"

    @property
    def members(self) -> dict[str, str]:
        """Whose panels there are, with their titles."""
        return self.titles

    def member_of(self, row: CostRow) -> str:
        """Return in whose panel a setting is."""
        return row.family

    def name_of(self, row: CostRow) -> str:
        """Return the name of the curve that a setting is on."""
        return self.titles[row.family]

    def shares_front(self, row: CostRow, member: str) -> bool:
        """Whether the front in a panel may have a setting: each engine has its own."""
        return row.family == member

    def curves(self, rows: Sequence[CostRow]) -> Iterator[list[CostRow]]:
        """Yield the settings that differ in their timestep alone, the coarsest first."""
        fixed = [row for row in rows if row.role != "chapter" and not row.is_controlled]
        for _, curve in groupby(sorted(fixed, key=_beside_timestep), _beside_timestep):
            yield sorted(curve, key=lambda row: -Fraction(row.timestep))

    def mark(self, row: CostRow) -> dict[str, Any]:
        """Return the marker of a setting."""
        colour = self.colour(row)
        return {
            "marker": CONTROLLED if row.is_controlled else self.timesteps[row.timestep],
            "markersize": 6.5,
            "markerfacecolor": "white" if row.is_own else colour,
            "markeredgecolor": colour,
            "markeredgewidth": 1.1,
            "linestyle": "none",
        }


def _beside_timestep(row: CostRow) -> tuple[str, ...]:
    """Return what of a setting is not its timestep."""
    effort = row.preset, row.solver, row.sweeps, row.tolerance, row.warm_start
    return (row.engine, *map(str, effort), str(sorted(row.settings.items())))


def handles_of(table: CostTable, looks: EngineLooks) -> list[Line2D]:
    """Return the legend: timesteps, and what marks mean; panels name the engines."""

    def dot(marker: str, label: str, **more: Any) -> Line2D:
        plain = {"color": DARK, "linestyle": "none", "markersize": 6.5, "markeredgewidth": 1.1}
        return Line2D([], [], marker=marker, label=label, **{**plain, **more})

    rows = table.rows
    handles = [dot(marker, f"{step} s") for step, marker in looks.timesteps.items()]
    if any(row.is_controlled for row in rows):
        handles.append(dot(CONTROLLED, "accuracy asked for"))
    handles.append(dot("o", "an engine's own defaults", markerfacecolor="white"))
    hollow = {"markerfacecolor": "none", "markeredgewidth": 1.6, "markersize": 11}
    names = {"specified": "what the config specifies", "chapter": "the chapter's setting"}
    roles = {row.role for row in rows}
    handles += [
        dot(str(RINGS[role]["marker"]), name, **hollow)
        for role, name in names.items()
        if role in roles
    ]
    if any(row.failed for row in rows):
        handles.append(dot("x", "failed", **FAILED))
    if len(looks.members) > 1:
        handles.append(dot(".", "another engine", color=PALE))
    return [*handles, Line2D([], [], color=DARK, linewidth=1.3, label="front of the engine")]
