"""A row of the table: scenes, how far off each is, what was and what must be."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import NamedTuple

from .scene import States

RATES = (60, 240, 1000)  # steps a second
FINER = 4000  # of smooth rows, too: their order is that from 1/1000 on
SECOND = 1.8  # least observed order of what is of second order
ROUND_OFF = 1e-6  # solves leave 1e-9 m/s in each of 4000 steps, of some 0.5 m/s
Error = Callable[[States], float]
Scenes = Mapping[str, tuple[str, Error]]  # variant: config, and how far off its run is


class Row(NamedTuple):
    """A family of scenes under one law; its error is that of its worst variant."""

    name: str
    was: str  # at 1/60, 1/240 and 1/1000 when accuracy in time was asked for
    scenes: Callable[[int], Scenes]  # by the rate
    bars: tuple[float, float, float]  # at RATES; inf: none
    smooth: bool = False  # also of second order, where above round-off
    plan: str = "turning"  # rows of one plan run in one engine
    unit: str = ""


class Found(NamedTuple):
    """What a row's scenes came to: errors by rate and variant."""

    row: Row
    errors: Mapping[int, Mapping[str, float]]

    def worst(self, rate: int) -> tuple[float, str]:
        return max(((error, name) for name, error in self.errors[rate].items()), key=_size)

    @property
    def order(self) -> float:
        """Return the least observed order of the variants from 1/1000 to 1/4000; nan: none."""
        coarse, fine = (self.errors.get(rate, {}) for rate in (RATES[-1], FINER))
        orders = [
            math.log(coarse[name] / fine[name]) / math.log(FINER / RATES[-1])
            for name in coarse
            if name in fine and fine[name] > ROUND_OFF
        ]
        return min(orders, default=math.nan)

    @property
    def missed(self) -> list[str]:
        """Return every bar that is missed, in words."""
        lines = []
        for rate, bar in zip(RATES, self.row.bars, strict=True):
            if rate in self.errors:
                lines += [
                    f"{self.row.name}, {name}, 1/{rate}: {error:.3g}, at most {bar:g}"
                    for name, error in self.errors[rate].items()
                    if not error <= bar
                ]
        if self.row.smooth and self.order < SECOND:
            lines.append(f"{self.row.name}: order {self.order:.2f}, at least {SECOND}")
        return lines


def _size(pair: tuple[float, str]) -> float:
    return math.inf if math.isnan(pair[0]) else pair[0]


def table(found: list[Found]) -> str:
    """Return one line a row, as Markdown."""
    lines = ["| scene, and its error | was | 1/60 | 1/240 | 1/1000 | order | bar | met |"]
    lines.append("|---|---|---|---|---|---:|---|---|")
    for one in found:
        row = one.row
        cells = [_number(one.worst(rate)[0]) if rate in one.errors else "" for rate in RATES]
        bars = [f"{bar:.1g}" if math.isfinite(bar) else "-" for bar in row.bars]
        bar = bars[0] if len(set(bars)) == 1 else ", ".join(bars)
        bar += ", order 2" if row.smooth else ""
        order = "" if math.isnan(one.order) or not row.smooth else f"{one.order:.2f}"
        unit = f" [{row.unit}]" if row.unit else ""
        met = "no" if one.missed else "yes"
        lines.append(
            f"| {row.name}{unit} | {row.was} | {' | '.join(cells)} | {order} | {bar} | {met} |"
        )
    return "\n".join(lines)


def _number(value: float) -> str:
    return f"{value:.2g}" if math.isfinite(value) else "none"
