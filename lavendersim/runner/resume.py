"""A run that did not finish, continued: which of its cells are done, and why others run again.

    newest run of the experiment -> its cells that ended -> logs that are whole -> done

A cell is done when it completed, and its log is byte for byte the one that its run wrote, or where
no line says what it wrote, is whole by its own CRCs; with the versions that are installed. One
whose log was closed but not yet measured is measured now. All else is run again into the same
directory, so that in the end it holds what a run holds that was never interrupted.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from lavendersim.durable_files import write_whole
from lavendersim.errors import TraceError
from lavendersim.experiment import Experiment
from lavendersim.trace.whole import INTERRUPTED

from .ended_logs import COMPLETE, outcome_by_log, whole_log
from .leftovers import UNFINISHED
from .run_directory import CONFIG, Run, list_runs
from .run_index import ENDED, PENDING, kept_lines

if TYPE_CHECKING:
    from .cell_outcome import CellOutcome, EndedCell


def newest_run(experiment: Experiment, root: Path) -> Run | None:
    """Return the newest run of an experiment with the same options, finished or not."""
    found = [run for run in list_runs(root) if _is_of(run, experiment)]
    return found[-1] if found else None


def _is_of(run: Run, experiment: Experiment) -> bool:
    try:
        return run.name == experiment.name and run.options == experiment.options
    except TraceError:  # a damaged index is nothing to go on from
        return False


def finished_run(experiment: Experiment, root: Path) -> Run | None:
    """Return the newest run of an experiment where it is of the same config and came to its end."""
    run = newest_run(experiment, root)
    return run if run is not None and run.finished and _same_text(run, experiment) else None


def unfinished_run(
    experiment: Experiment, root: Path, logs: Collection[str], note: Callable[[str], None]
) -> Run | None:
    """Return the run to go on with, None where a new one has to begin; note: receives why.

    logs: the names of the logs that the experiment makes, which say its engine.
    """
    run = newest_run(experiment, root)
    if run is None or run.finished:
        why = f"no run of it in {root}" if run is None else f"{run.path} is finished"
        note(f"nothing to resume, {why}: a new run begins")
        return None
    changed = ""
    if not _same_text(run, experiment):
        changed = "the config"
    elif {log.name for log in run.rows()} != set(logs):
        changed = "the engine"
    if changed:
        note(f"{changed} has changed since {run.path}: all {len(logs)} cells are run again")
        return None
    return run


def take_over(run: Run, logs: Collection[str], note: Callable[[str], None]) -> dict[str, EndedCell]:
    """Return the cells that are done by the names of their logs; what else a kill left is removed.

    Of those whose logs were closed and not measured, nothing is measured yet. For who holds the
    run's directory. note: receives how many are run again, and why.
    """
    from .cell_outcome import EndedCell, ended_cells, note_closed  # late: it needs numpy

    rows = {path.name: row for path, row in run.rows().items()}
    ended = ended_cells(run.path)
    done: dict[str, EndedCell] = {}
    again = Counter[str]()
    closed: dict[Path, CellOutcome] = {}  # of which no line is left
    for name in sorted(logs):
        log, row = run.path / "cells" / name, rows[name]
        if name not in ended and row.status in (PENDING, COMPLETE):
            with suppress(TraceError, OSError):
                closed[log] = outcome_by_log(log, row)
                ended[name] = EndedCell(closed[log], {})
        why = _why_again(log, COMPLETE if log in closed else row.status, ended.get(name))
        if why:
            again[why] += 1
        else:
            done[name] = ended[name]
    # Lines are appended to it: none may stand behind one that a kill has cut.
    write_whole(run.path / ENDED, kept_lines(run.path, done), flush=False)
    for log, outcome in closed.items():
        if log.name in done:
            note_closed(log, outcome)
    for left in run.path.rglob(UNFINISHED):
        left.unlink()
    note(f"goes on with {run.path}: {len(done)} of {len(logs)} cells are done")
    if count := sum(not one.measured for one in done.values()):
        note(f"{count} measured now: the log was closed")
    for why, count in again.items():
        note(f"{count} run again: {why}")
    return done


def _same_text(run: Run, experiment: Experiment) -> bool:
    try:
        return (run.path / CONFIG).read_bytes() == experiment.text.encode()
    except FileNotFoundError:  # killed before it was written
        return False


def _why_again(log: Path, status: str, ended: EndedCell | None) -> str:
    """Say why a cell is to be run again; nothing where it is done."""
    from .environment import versions

    if status == PENDING or status.startswith(INTERRUPTED):
        return "did not end"
    if status != COMPLETE:
        return "failed: diverged, broke a bound or lost its process"
    if ended is None:
        return "it was not noted how it ended"
    try:
        trace = whole_log(log, ended.outcome)
    except (TraceError, OSError):
        return "its log is cut, damaged or missing"
    return "" if trace.metadata.get("versions") == versions() else "other versions are installed"
