"""The overhead of each effect in a cell: interleaved timing of engines without and with it.

compile every engine -> take each to where timing begins -> rounds of pairs, off and on in turn
Both engines of a pair are sampled right after each other, in alternating order, and the overhead is
the median of their differences: a slow minute of the machine falls on both.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import ceil
from pathlib import Path
from typing import Final

from lavendersim.durable_files import write_whole
from lavendersim.engine.spec import Spec
from lavendersim.errors import ConfigError
from lavendersim.experiment import Experiment
from lavendersim.experiment.cell import Cell
from lavendersim.experiment.models.overhead import REQUIRED
from lavendersim.geometry.bodies import is_movable
from lavendersim.measures.overhead_table import OverheadRow, OverheadTable, OverheadTiming
from lavendersim.measures.spread import Spread
from lavendersim.quantities.found import nearest, quoted
from lavendersim.quantities.scalars import exact

from .compile_times import compile_times
from .environment import processor
from .overhead_pairs import EnginePair, names_of_effects, pairs_of
from .rounds import Report, Taken, take_rounds
from .timed_engine import Diverged, Timed, clock


def check_overheads(experiment: Experiment) -> None:
    """Raise ConfigError where the section `overhead` names what is no effect."""
    known = names_of_effects()
    defects = [
        experiment.cells()[0].defect(
            ("overhead", "effects", place),
            f"overhead.effects: no effect is called {quoted(name)}{nearest(name, known)}",
        )
        for place, name in enumerate(_named(experiment))
        if name not in known
    ]
    if defects:
        raise ConfigError(defects)


def _named(experiment: Experiment) -> tuple[str, ...]:
    spec = experiment.config.overhead
    return spec.effects if spec is not None and isinstance(spec.effects, tuple) else ()


def take_overheads(
    experiment: Experiment,
    pairs: Sequence[EnginePair],
    workers: int = 1,
    report: Report = lambda what, done, total: None,
) -> OverheadTable:
    """Return what the effects of an experiment's only cell cost, as plain data.

    pairs: see `pairs_timed`. workers: processes that compile. report: called with what is done, how
    far, and of how many.
    """
    spec = experiment.config.overhead
    assert spec is not None
    (cell,) = experiment.cells()
    specs = specs_of(pairs)
    seconds = compile_times(
        cell.config,
        specs,
        workers,
        lambda done, total: report("compiling engines for overheads", done, total),
    )
    first = ceil(exact(spec.begin) / cell.config.numerics.timestep)
    steps = cell.config.steps - first
    timed, diverged = _timed(cell, specs, first, steps)
    pairs = [_without_diverged(pair, diverged) for pair in pairs]
    samples, taken = _rounds(pairs, timed, spec.repeats, report)
    table = _table(cell, pairs, timed, samples, seconds, (first, steps, taken.rounds))
    return replace(table, interrupted=taken.interrupted, only_required=spec.effects == REQUIRED)


def pairs_timed(experiment: Experiment) -> list[EnginePair]:
    """Return the engines that are compiled and timed for the overheads of an experiment."""
    spec = experiment.config.overhead
    assert spec is not None
    (cell,) = experiment.cells()
    pairs = pairs_of(cell.config, _named(experiment))
    return [pair for pair in pairs if pair.required or spec.effects != REQUIRED]


def specs_of(pairs: Sequence[EnginePair]) -> list[Spec]:
    """Return what the engines of some pairs are composed of, each once."""
    return list(
        dict.fromkeys(each for pair in pairs for each in (pair.off, pair.on) if each is not None)
    )


def _timed(
    cell: Cell, specs: Sequence[Spec], first: int, steps: int
) -> tuple[dict[Spec, Timed], set[Spec]]:
    timed: dict[Spec, Timed] = {}
    diverged: set[Spec] = set()
    for spec in specs:
        try:
            timed[spec] = Timed(cell.config, spec, first, steps)
        except Diverged:
            diverged.add(spec)
    return timed, diverged


def _without_diverged(pair: EnginePair, diverged: set[Spec]) -> EnginePair:
    for which, spec in (("without", pair.off), ("with", pair.on)):
        if spec in diverged:
            return pair._replace(off=None, on=None, why_not=f"the scene diverges {which} it")
    return pair


def _rounds(
    pairs: Sequence[EnginePair], timed: dict[Spec, Timed], repeats: int, report: Report
) -> tuple[dict[str, list[tuple[float, float]]], Taken]:
    """Return (off, on) of every repeat, by effect [ns/step], and how many repeats there are."""
    samples: dict[str, list[tuple[float, float]]] = {pair.effect: [] for pair in pairs}

    def one(repeat: int) -> None:
        for pair in pairs:
            if pair.off is None or pair.on is None:
                continue
            off, on = timed[pair.off], timed[pair.on]
            if repeat % 2:
                later = on.sample()
                samples[pair.effect].append((off.sample(), later))
            else:
                earlier = off.sample()
                samples[pair.effect].append((earlier, on.sample()))

    def widths() -> Iterator[float]:
        for pairs_taken in filter(None, samples.values()):
            difference = Spread.of([on - off for off, on in pairs_taken])
            yield difference.width / Spread.of([on for _, on in pairs_taken]).median

    taken = take_rounds("rounds of overheads", repeats, one, widths, report)
    return {name: each[: taken.rounds] for name, each in samples.items()}, taken


def _table(
    cell: Cell,
    pairs: Sequence[EnginePair],
    timed: dict[Spec, Timed],
    samples: dict[str, list[tuple[float, float]]],
    seconds: dict[Spec, float],
    window: tuple[int, int, int],
) -> OverheadTable:
    bodies = sum(is_movable(body) for body in cell.config.scene.bodies.values())
    # Contacts of the scene's own motion: of an engine whose effects the scene requires, or idle.
    own = next(
        (
            timed[spec].contacts
            for pair in pairs
            for spec in ((pair.on,) if pair.required else (pair.off, pair.on))
            if spec is not None
        ),
        0.0,
    )
    first, steps, repeats = window
    rows = [_row(pair, timed, samples[pair.effect], seconds, bodies, own) for pair in pairs]
    return OverheadTable(first, steps, repeats, clock()[0], processor(), bodies, own, rows)


def _row(
    pair: EnginePair,
    timed: dict[Spec, Timed],
    samples: list[tuple[float, float]],
    seconds: dict[Spec, float],
    bodies: int,
    contacts: float,
) -> OverheadRow:
    # Below one contact a step the cost is that of looking for it, which every body has.
    by_contact = pair.of_contacts and contacts >= 1.0
    units = contacts if by_contact else max(bodies, 1)
    timing = None
    if pair.off is not None and pair.on is not None:
        off, on = timed[pair.off], timed[pair.on]
        difference = Spread.of([after - before for before, after in samples])
        timing = OverheadTiming(
            same_motion=off.motion == on.motion,
            contacts_off=off.contacts,
            contacts_on=on.contacts,
            compile_s_off=seconds[pair.off],
            compile_s_on=seconds[pair.on],
            off=Spread.of([before for before, _ in samples]).per(units),
            on=Spread.of([after for _, after in samples]).per(units),
            overhead=difference.per(units),
            within_noise=difference.low <= 0.0 <= difference.high,
            samples_off=[before for before, _ in samples],
            samples_on=[after for _, after in samples],
        )
    return OverheadRow(
        effect=pair.effect,
        required=pair.required,
        reason=pair.reason,
        unit="contact" if by_contact else "body",
        units=units,
        on_top_of=list(pair.on_top_of),
        why_not=pair.why_not,
        timing=timing,
    )


COLUMNS: Final = (
    *("effect", "required", "unit", "units", "off", "on", "overhead", "low", "high"),
    *("within_noise", "same_motion", "contacts_off", "contacts_on"),
    *("compile_s_off", "compile_s_on", "on_top_of", "why_not", "reason"),
)


def write_overheads(path: Path, overheads: OverheadTable) -> None:
    """Write a table of overheads as CSV: medians and ends of intervals, ns per unit and step."""
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, restval="", extrasaction="ignore")
    writer.writeheader()
    for row, data in zip(overheads.rows, overheads.as_data()["rows"], strict=True):
        numbers: dict[str, float] = {}
        if (timing := row.timing) is not None:
            numbers = {name: getattr(timing, name).median for name in ("off", "on", "overhead")}
            numbers |= {"low": timing.overhead.low, "high": timing.overhead.high}
        writer.writerow({**data, "on_top_of": " ".join(row.on_top_of), **numbers})
    write_whole(path, text.getvalue(), flush=False)
