"""How a cell ended and what was measured of it, as the process that ran it notes both.

A line of `ended.jsonl` has them all, so a run that is resumed reads no log to go on from there.
JSON gives back every number as it was, NaN and infinities included.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from lavendersim.errors import TraceError
from lavendersim.measures.verdict import Outcome
from lavendersim.trace.whole import LogDigest

from .accuracy import Accuracy, Worst
from .measured import Measured
from .run_index import ENDED, append_line, as_row, digest_of, ended_rows


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
    measured: dict[int, Measured]  # by the cells of the sweep that its log is of


def note_measured(log: Path, ended: EndedCell) -> None:
    """Append what was measured of a log to how its cell ended."""
    outcome, measured = ended
    row = {
        "file": log.name,
        "status": outcome.status,
        "log": as_row(outcome.log),
        "outcome": outcome._replace(accuracy=None, log=None)._asdict(),  # type: ignore[arg-type]
        "accuracy": outcome.accuracy._asdict()
        | {"worst": dict(outcome.accuracy.worst), "at_limit": dict(outcome.accuracy.at_limit)},
        "measured": {
            index: [one.values, {name: list(found) for name, found in one.always.items()}]
            for index, one in measured.items()
        },
    }
    append_line(log.parent.parent / ENDED, row)


def ended_cells(directory: Path) -> dict[str, EndedCell]:
    """Return the cells that have ended and were measured in a run, by the names of their logs.

    TraceError where the file that says so is damaged.
    """
    try:
        return {
            name: _ended(row) for name, row in ended_rows(directory).items() if "measured" in row
        }
    except (ValueError, KeyError, TypeError) as error:
        raise TraceError(f"{directory / ENDED}: damaged: {error}") from None


def _ended(row: dict[str, Any]) -> EndedCell:
    accuracy = row["accuracy"]
    worst = {part: Worst(*found) for part, found in accuracy["worst"].items()}
    log: LogDigest | None = digest_of(row["log"])
    outcome = row["outcome"] | {"accuracy": Accuracy(**accuracy | {"worst": worst}), "log": log}
    measured = {
        int(index): Measured(values, {name: Outcome(*one) for name, one in always.items()})
        for index, (values, always) in row["measured"].items()
    }
    return EndedCell(CellOutcome(**outcome), measured)
