"""How a cell ended and what was measured of it, as the process that ran it notes both.

A line of `ended.jsonl` has them all, so a run that is resumed measures no log twice.
JSON gives back every number as it was, NaN and infinities included.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from lavendersim.errors import TraceError
from lavendersim.measures.verdict import Outcome
from lavendersim.trace.whole import LogDigest

from .accuracy import Accuracy, Worst
from .measured import Measured
from .run_index import ENDED, append_lines, digest_of, ended_row, ended_rows


class CellOutcome(NamedTuple):
    """How a cell ended and what it cost. Times never enter the log."""

    cell: int  # index in the sweep
    status: str  # `complete`, `diverged: ...` or `beyond bounds: ...`
    steps: int
    compile_ns: int  # composing, compiling or loading the kernel
    physics_ns: int  # inside the kernel
    logging_ns: int  # encoding and writing
    accuracy: Accuracy
    log: LogDigest | None = None  # of its log as it was written


class EndedCell(NamedTuple):
    """A cell that ended: how, and what was measured of it."""

    outcome: CellOutcome
    # By the cells of the sweep that its log is of; of none while it is not measured.
    measured: dict[int, Measured]


def note_closed(log: Path, outcome: CellOutcome) -> None:
    """Append how a cell ended, when its log is closed."""
    append_lines(log.parent.parent / ENDED, _closed(log, outcome))


def note_measured(log: Path, ended: EndedCell) -> None:
    """Append what was measured of a log to how its cell ended."""
    append_lines(log.parent.parent / ENDED, _measured(log, ended))


def _closed(log: Path, outcome: CellOutcome, **more: Any) -> dict[str, Any]:
    accuracy = outcome.accuracy
    return ended_row(
        log,
        outcome.status,
        outcome.log,
        outcome=outcome._asdict() | {"accuracy": None, "log": None},
        accuracy=accuracy._asdict()
        | {"worst": dict(accuracy.worst), "at_limit": dict(accuracy.at_limit)},
        **more,
    )


def _measured(log: Path, ended: EndedCell) -> dict[str, Any]:
    measured = {
        index: [one.values, {name: list(found) for name, found in one.always.items()}]
        for index, one in ended.measured.items()
    }
    return _closed(log, ended.outcome, measured=measured)


class Notes:
    """Notes how cells ended: of one when its log is closed, and again when that is measured.

    Several that are run together are brief, and noted together when this is left, however it is:
    each once, with its measures if it has some by then. To open the file for each takes as long as
    to close its log.
    """

    def __init__(self, cells: int) -> None:
        self._together = cells > 1
        self._rows: dict[Path, Callable[[], dict[str, Any]]] = {}  # by the log

    def __enter__(self) -> Notes:
        """Return this."""
        return self

    def closed(self, log: Path, outcome: CellOutcome) -> None:
        """Note that the log of a cell is closed."""
        if self._together:
            self._rows[log] = partial(_closed, log, outcome)
        else:
            note_closed(log, outcome)

    def measured(self, log: Path, ended: EndedCell) -> None:
        """Note that it is measured."""
        if self._together:
            self._rows[log] = partial(_measured, log, ended)
        else:
            note_measured(log, ended)

    def __exit__(self, *error: object) -> None:
        """Append what is noted."""
        if self._rows:
            path = next(iter(self._rows)).parent.parent / ENDED
            append_lines(path, *(row() for row in self._rows.values()))


def ended_cells(directory: Path) -> dict[str, EndedCell]:
    """Return the cells that have ended in a run, by the names of their logs.

    Of one that was not measured before its process ended, nothing is. TraceError where the file
    that says so is damaged.
    """
    try:
        return {
            name: ended_of(row) for name, row in ended_rows(directory).items() if _is_noted(row)
        }
    except (ValueError, KeyError, TypeError) as error:
        raise TraceError(f"{directory / ENDED}: damaged: {error}") from None


def _is_noted(row: dict[str, Any]) -> bool:
    """Whether a line has how the cell ended; those of older versions do when it is measured."""
    return "outcome" in row or "measured" in row


def ended_of(row: Mapping[str, Any]) -> EndedCell:
    """Return what a line says of a cell that ended; errors of its table where it is damaged."""
    accuracy = row["accuracy"]
    worst = {part: Worst(*found) for part, found in accuracy["worst"].items()}
    log: LogDigest | None = digest_of(row["log"])
    outcome = row["outcome"] | {"accuracy": Accuracy(**accuracy | {"worst": worst}), "log": log}
    measured = {
        int(index): Measured(values, {name: Outcome(*one) for name, one in always.items()})
        for index, (values, always) in row.get("measured", {}).items()
    }
    return EndedCell(CellOutcome(**outcome), measured)
