"""How a cell ended and what was measured of it, as the process that ran it notes both.

A line of `ended.jsonl` has them all, so a run that is resumed measures no log twice.
JSON gives back every number as it was, NaN and infinities included.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from lavendersim.errors import TraceError
from lavendersim.measures.verdict import Outcome
from lavendersim.trace.whole import LogDigest

from .accuracy import Accuracy, Worst
from .measured import Measured
from .run_index import ENDED, digest_of, ended_rows, note_ended


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


def note_closed(log: Path, outcome: CellOutcome, **more: Any) -> None:
    """Append how a cell ended, and more that is known of it, when its log is closed."""
    accuracy = outcome.accuracy
    note_ended(
        log,
        outcome.status,
        outcome.log,
        outcome=outcome._replace(accuracy=None, log=None)._asdict(),  # type: ignore[arg-type]
        accuracy=accuracy._asdict()
        | {"worst": dict(accuracy.worst), "at_limit": dict(accuracy.at_limit)},
        **more,
    )


def note_measured(log: Path, ended: EndedCell) -> None:
    """Append what was measured of a log to how its cell ended."""
    measured = {
        index: [one.values, {name: list(found) for name, found in one.always.items()}]
        for index, one in ended.measured.items()
    }
    note_closed(log, ended.outcome, measured=measured)


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
