"""What a simulated second costs in each setting of a grid, repeat by repeat.

    compile all -> an engine a cell, at the step where timing begins -> rounds, forwards and back
Every round visits every setting, so that a slow minute of the machine falls on all of them. An
engine is that of the setting alone, without records: what is timed is physics. Compilation is done
before the first sample and has a number of its own. Other engines take their turns in the same
rounds, each in a process that times it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import ceil
from typing import NamedTuple

from lavendersim.engine.spec import Spec
from lavendersim.experiment.cell import Cell
from lavendersim.measures.spread import Spread
from lavendersim.quantities.scalars import exact
from lavendersim.scene.plan import plan_of_cell, union

from .compile_times import compile_times
from .rounds import Report, Taken, take_rounds
from .timed_elsewhere import Servers, TimedElsewhere, timing_servers
from .timed_engine import SAMPLE_NS, Diverged, Timed

Engines = list[tuple[Timed | TimedElsewhere, Fraction]]  # with their timesteps [s]


class Clocked(NamedTuple):
    """One setting to be timed."""

    cells: Sequence[Cell]
    steps: Sequence[int]  # that each of them got
    spec: Spec | None  # see `engine_timed`


class Times(NamedTuple):
    """What a setting costs."""

    samples: list[float]  # [ns per simulated second], mean over its cells; one a repeat
    compile_s: float  # of its engine, once
    seconds: float  # [s] simulated time that is timed, of all its cells


def times_of(
    settings: Sequence[Clocked], begin: float, repeats: int, workers: int, report: Report
) -> tuple[list[Times], Taken]:
    """Return the times of every setting, and the rounds that were taken, `repeats` at most.

    begin: the simulated time [s] at which timing begins.
    """
    own = list(dict.fromkeys(each.spec for each in settings if each.spec is not None))
    seconds = {}
    if own:
        seconds = compile_times(
            next(each for each in settings if each.spec is not None).cells[0].config,
            own,
            workers,
            lambda done, total: report("compiling engines to time", done, total),
        )
    with timing_servers() as servers:
        engines = []
        for done, each in enumerate(settings):
            report("settings made ready", done, len(settings))
            engines.append(_engines(each, begin, servers))
        samples: list[list[float]] = [[] for _ in settings]
        order = [place for place, timed in enumerate(engines) if timed]

        def one(repeat: int) -> None:
            for place in order if repeat % 2 == 0 else reversed(order):
                samples[place].append(_sample(engines[place]))

        def widths() -> Iterator[float]:
            for place in order:
                spread = Spread.of(samples[place])
                yield spread.width / spread.median

        taken = take_rounds("rounds of all settings", repeats, one, widths, report)
    times = [
        Times(
            [] if any(math.isnan(one) for one in found) else found[: taken.rounds],
            0.0 if each.spec is None else seconds[each.spec],
            sum(float(engine.steps * step) for engine, step in timed),
        )
        for each, found, timed in zip(settings, samples, engines, strict=True)
    ]
    return times, taken


def engine_timed(cells: Sequence[Cell]) -> Spec | None:
    """Return what is timed for the cells of a setting; None: another engine than lavender's."""
    if cells[0].config.engine is not None:
        return None
    return union([plan_of_cell(cell, False) for cell in cells]).spec


def _engines(each: Clocked, begin: float, servers: Servers) -> Engines:
    """Return an engine a cell, with its timestep [s]; none of cells that end before timing begins.

    A cell that diverged is timed up to the step before it did.
    """
    engines: Engines = []
    for cell, steps in zip(each.cells, each.steps, strict=True):
        timestep = cell.config.numerics.timestep
        first = ceil(exact(begin) / timestep)
        last = steps if steps >= cell.config.steps else steps - 1
        if last <= first:
            continue
        shortest = SAMPLE_NS // len(each.cells)
        if each.spec is None:
            timed = TimedElsewhere(cell.config, first, last - first, shortest, servers)
            engines.append((timed, timestep))
            continue
        try:
            own = Timed(cell.config, each.spec, first, last - first, shortest=shortest)
        except Diverged:  # without its records an engine takes the same steps: never
            continue
        engines.append((own, timestep))
    return engines


def _sample(engines: Engines) -> float:
    """Return what a simulated second costs [ns], the mean over cells; NaN where one gave none."""
    return sum(timed.sample() / float(step) for timed, step in engines) / len(engines)
