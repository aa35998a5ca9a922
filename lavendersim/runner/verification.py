"""Everything of a run read and compared: tables, logs, and what is measured in them again.

    seal -> tables;  index -> logs;  logs -> measures and verdicts -> results

As `restic check --read-data`: every byte is read. Refined runs in the directory of a run are part
of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from lavendersim.errors import LavenderError, OtherVersionError, TraceError
from lavendersim.measures.own_file import NoSourceError

from .judge_again import JudgedAgain, judge_again
from .run_directory import REFINED, RESULTS, Run, list_runs
from .run_results import CellResult, RunResults
from .run_seal import read_sealed, sealed

# What a verdict is compared by: a message has paths, and a run may have moved.
JUDGED = ("node", "passed", "measured", "expected", "tolerance", "follows", "margin")


def problems_of(run: Run) -> Iterator[str]:
    """Yield a sentence for everything of a run that is not as it was written; none: it is whole."""
    try:
        found = [*_tables(run)]
        yield from found
        if not found:
            yield from _contents(run)
    except NoSourceError:  # no problem of the run's
        raise
    except LavenderError as error:
        yield str(error)
    for refined in list_runs(run.path / REFINED):
        yield from problems_of(refined)


def has_digests(run: Run) -> bool:
    """Whether the run has digests of its tables, or is to have them; those of old have none."""
    return bool(sealed(run.path)) or not run.finished


def _tables(run: Run) -> Iterator[str]:
    for name in sealed(run.path):
        try:
            read_sealed(run.path / name)
        except TraceError as error:
            yield str(error)


def _contents(run: Run) -> Iterator[str]:
    if run.not_understood:
        yield from filter(None, (cell.damage() for cell in run.cells))
        yield f"{run.not_understood}; its measures and verdicts are not compared"
        return
    judged = judge_again(run)
    yield from judged.damaged
    if not run.finished:
        ended = sum(not cell.damage() for cell in judged.cells)
        yield f"{run.path}: did not finish: {ended} of {len(judged.cells)} logs are whole"
        return
    results = run.results()
    if older := _of_another_version(judged):
        yield older
        return
    yield from _cells(run, judged, results.cells)
    if not judged.damaged:
        yield from _verdicts(run, judged, results)


def _of_another_version(judged: JudgedAgain) -> str:
    """Return why nothing can be measured again; empty where it can. A run is of one version."""
    for cell in judged.cells:
        if not cell.damage():
            try:
                _ = cell.config
            except OtherVersionError as error:
                return f"{error}; its measures and verdicts are not compared"
            finally:
                cell.release()
            return ""
    return ""


def _cells(run: Run, judged: JudgedAgain, rows: Sequence[CellResult]) -> Iterator[str]:
    for cell, again, row in zip(judged.cells, judged.table()["cells"], rows, strict=True):
        if cell.damage():
            continue
        where = f"{run.path / RESULTS}: cell {cell.index}{f' ({cell.label})' if cell.label else ''}"
        if row.status != again["status"]:
            yield f"{where}: {row.status!r}, its log says {again['status']!r}"
        written = row.as_json["measures"]
        for name, value in again["measures"].items():
            stored = written.get(name, "nothing")
            if stored != value:
                yield f"{where}: {name} is {stored!r}, its log gives {value!r}"


def _verdicts(run: Run, judged: JudgedAgain, results: RunResults) -> Iterator[str]:
    table, checks = judged.table(), results["checks"]
    for one, other in zip(checks, table["checks"], strict=False):
        if any(one[key] != other[key] for key in JUDGED):
            yield f"{run.path / RESULTS}: {other['node']}: judged again it is another verdict"
    if len(checks) != len(table["checks"]) or results.passed != table["passed"]:
        yield f"{run.path / RESULTS}: judged again the run has another verdict"
