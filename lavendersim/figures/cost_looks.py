"""Colours, markers, lines, curves and legend of the settings on a work-precision page."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from itertools import groupby
from typing import Any, Final, NamedTuple, get_args

from matplotlib.lines import Line2D

from lavendersim.cell.choices import Solver
from lavendersim.figures.style import DARK, LOOKS, Look
from lavendersim.measures.cost_table import CostRow, CostTable

# Every solver has its colour in every figure; black is that of the front and of what failed.
COLOURED: Final = [one for one in LOOKS if one.colour != "#000000"]
SOLVER_LOOKS: Final = {
    name: COLOURED[place % len(COLOURED)]
    for place, name in enumerate(sorted(get_args(Solver), key=lambda name: name != "adaptive"))
}
MARKERS: Final = ("o", "s", "^", "D", "v", "P", "X", "*")  # of timesteps, the coarsest first
FLOOR: Final = 1e-15  # [-] smaller errors are round-off
CONTROLLED: Final = "<"  # marker of an accuracy that is asked for
RINGS: Final = {
    "specified": {"marker": "o", "markersize": 14, "markeredgewidth": 1.6},
    "chapter": {"marker": "s", "markersize": 14, "markeredgewidth": 1.6},
}
PALE: Final = "#bdbdbd"  # settings of the others
FAILED: Final = {"markersize": 5, "markeredgewidth": 1.0}


Key = Callable[[CostRow], Any]


class Looks(NamedTuple):
    """What colours, markers and lines stand for."""

    solvers: dict[str, Look]
    timesteps: dict[str, str]  # marker by timestep
    presets: dict[str, Any]  # line by preset

    @classmethod
    def of(cls, rows: Sequence[CostRow]) -> Looks:
        """Give every solver, timestep and preset its look, in the order of the grid."""
        shown = {row.solver for row in rows}
        fixed = [row for row in rows if not row.is_controlled]
        steps = sorted({row.timestep for row in fixed}, key=lambda step: -Fraction(step))
        presets = list(dict.fromkeys(row.preset for row in rows if row.role != "chapter"))
        lines = ("-", (0, (4, 2)))
        return cls(
            {name: one for name, one in SOLVER_LOOKS.items() if name in shown},
            {step: MARKERS[place % len(MARKERS)] for place, step in enumerate(steps)},
            {name: lines[place % len(lines)] for place, name in enumerate(presets)},
        )

    def colour(self, row: CostRow) -> str:
        """Return the colour of a setting."""
        return str(self.solvers[row.solver].colour)

    def line(self, row: CostRow) -> Any:
        """Return the line of the curve that a setting is on."""
        return self.presets.get(row.preset, "-")

    def curves(self, rows: Sequence[CostRow]) -> Iterator[list[CostRow]]:
        """Yield the settings that a line joins."""
        return curves_of(rows)

    @property
    def members(self) -> dict[str, str]:
        """Whose panels there are, with their titles."""
        return {name: name.replace("_", " ") for name in self.solvers}

    def member_of(self, row: CostRow) -> str:
        """Return in whose panel a setting is."""
        return row.solver

    def name_of(self, row: CostRow) -> str:
        """Return the name of the curve that a setting is on."""
        title = self.members[row.solver]
        return f"{title}, {row.preset}" if len(self.presets) > 1 else title

    def shares_front(self, row: CostRow, member: str) -> bool:
        """Whether the front in a panel may have a setting: that of all solvers is in each."""
        return True

    def mark(self, row: CostRow) -> dict[str, Any]:
        """Return the marker of a setting: full where it starts warm, hollow where cold."""
        colour = self.solvers[row.solver].colour
        return {
            "marker": CONTROLLED if row.is_controlled else self.timesteps[row.timestep],
            "markersize": 6.5,
            "markerfacecolor": colour if row.warm_start else "white",
            "markeredgecolor": colour,
            "markeredgewidth": 1.1,
            "linestyle": "none",
        }


def drawn(row: CostRow) -> float:
    """Return where the error of a setting that has one is drawn: round-off at the floor."""
    assert row.error is not None
    return max(row.error, FLOOR)


def curves_of(rows: Sequence[CostRow]) -> Iterator[list[CostRow]]:
    """Yield the settings that one knob joins: the one that a solver has most values of."""
    knobs: dict[str, Key] = {
        "timestep": lambda row: -Fraction(row.timestep),
        "effort": lambda row: (row.sweeps, -(row.tolerance or 0.0)),
    }
    grid = [row for row in rows if row.role != "chapter" and not row.is_controlled]
    for family in _grouped(grid, lambda row: (row.preset, row.solver, row.warm_start)):
        counts = {name: len({knob(row) for row in family}) for name, knob in knobs.items()}
        along, across = sorted(knobs, key=lambda name: -counts[name])
        for curve in _grouped(family, knobs[across]):
            yield sorted(curve, key=knobs[along])
    yield from _grouped([row for row in rows if row.is_controlled], lambda row: row.preset)


def _grouped(rows: Sequence[CostRow], key: Key) -> Iterator[list[CostRow]]:
    for _, group in groupby(sorted(rows, key=key), key):
        yield list(group)


def handles_of(table: CostTable, looks: Looks) -> list[Line2D]:
    """Return the legend: presets, timesteps, and what marks mean; panels name the solvers."""

    def dot(marker: str, label: str, **more: Any) -> Line2D:
        plain = {"color": DARK, "linestyle": "none", "markersize": 6.5, "markeredgewidth": 1.1}
        return Line2D([], [], marker=marker, label=label, **{**plain, **more})

    rows = table.rows
    handles: list[Line2D] = []
    if len(looks.presets) > 1:
        handles += [
            Line2D([], [], color=DARK, linewidth=1.1, linestyle=line, label=f"laws of {name}")
            for name, line in looks.presets.items()
        ]
    handles += [dot(marker, f"{step} s") for step, marker in looks.timesteps.items()]
    if any(row.is_controlled for row in rows):
        handles.append(dot(CONTROLLED, "accuracy asked for"))
    if not all(row.warm_start for row in rows):
        handles.append(dot("o", "cold start", markerfacecolor="white"))
    rings = {row.role: row for row in rows if row.role in RINGS}
    names = {"specified": "what the config specifies", "chapter": "the chapter's setting"}
    hollow = {"markerfacecolor": "none", "markeredgewidth": 1.6, "markersize": 11}
    handles += [dot(str(RINGS[role]["marker"]), names[role], **hollow) for role in rings]
    if any(row.failed for row in rows):
        handles.append(dot("x", "failed", **FAILED))
    if len(looks.members) > 1:
        handles.append(dot(".", "another solver", color=PALE))
    return [*handles, Line2D([], [], color=DARK, linewidth=1.3, label="front")]
