"""Which cells the workers of a folder have ended, by what each notes beside its logs.

    DIR/shards/*/ended.jsonl    two lines a cell: its log is closed; it is measured

A cell is done when it is measured. One whose log is closed, complete and whole is only to be
measured, by whoever goes on: its worker was killed in between.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from lavendersim.errors import TraceError
from lavendersim.trace.whole import INTERRUPTED

from .leases import SHARDS
from .run_index import ENDED

if TYPE_CHECKING:
    from lavendersim.trace import Trace

    from .cell_outcome import CellOutcome, EndedCell
    from .cells_index import IndexRow

COMPLETE: Final = "complete"


class EndedLogs:
    """What the workers of a folder have ended; of each file only what is new is read."""

    def __init__(self, into: Path) -> None:
        self._shards = into / SHARDS
        self._read: dict[Path, int] = {}  # bytes of it
        self._names: set[str] = set()
        self._closed: dict[str, tuple[Path, Mapping[str, Any]]] = {}  # shards and lines, by logs

    def read(self) -> set[str]:
        """Return the names of the logs that have been measured, of the size they had."""
        for file in sorted(self._shards.glob(f"*/{ENDED}")):
            with file.open("rb") as opened:
                opened.seek(self._read.get(file, 0))
                text = opened.read()
            whole = text[: text.rfind(b"\n") + 1]  # what follows is cut, or being written
            self._read[file] = self._read.get(file, 0) + len(whole)
            for line in whole.splitlines():
                self._note(file, line)
        return self._names

    def closed(self, log: str) -> tuple[Path, CellOutcome] | None:
        """Return the file and the outcome of a cell that was not measured though it is whole.

        log: its name. None where it has to be run.
        """
        from .cell_outcome import ended_of

        shard, row = self._closed.get(log, (None, None))
        if shard is None or row is None or log in self._names:
            return None
        path = shard / "cells" / log
        try:
            outcome = ended_of(row).outcome
        except (ValueError, KeyError, TypeError) as error:
            raise TraceError(f"{shard / ENDED}: damaged: {error}") from None
        try:
            whole_log(path, outcome)
        except (TraceError, OSError):
            return None
        return path, outcome

    def _note(self, file: Path, line: bytes) -> None:
        try:
            row = json.loads(line)
            if "measured" not in row:
                if row["status"] == COMPLETE and "outcome" in row:
                    self._closed[str(row["file"])] = file.parent, row
            elif not row["status"].startswith(INTERRUPTED):
                path = file.parent / "cells" / row["file"]
                if path.stat().st_size == row["log"]["bytes"]:
                    self._names.add(str(row["file"]))
        except FileNotFoundError:
            pass
        except (ValueError, KeyError, TypeError) as error:
            raise TraceError(f"{file}: damaged: {error}") from None


def whole_log(path: Path, outcome: CellOutcome) -> Trace:
    """Return a log that is byte for byte the one that was closed.

    TraceError where it is not, OSError where it cannot be read.
    """
    from lavendersim.trace import ExpectedLog, open_trace

    trace = open_trace(path, expected=ExpectedLog(digest=outcome.log))
    trace.verify()
    return trace


def outcome_by_log(path: Path, row: IndexRow) -> CellOutcome:
    """Return how a cell completed of which nothing is noted, from its log; what it took is lost.

    TraceError where the log does not show that it completed, OSError where it cannot be read.
    """
    from lavendersim.trace import digest_of_closed, open_trace

    from .accuracy import Accuracy
    from .cell_outcome import CellOutcome

    digest = digest_of_closed(path)
    trace = open_trace(path, expected=row.expected)
    if not trace.complete:
        raise TraceError(f"{path}: {trace.status}")
    if trace.config.engine is not None or trace.partly:
        raise TraceError(f"{path}: it does not tell how far every step converged")
    contact = trace.contact if trace.has("/contacts") else None
    accuracy = Accuracy(tolerance=trace.config.numerics.tolerance)
    accuracy = accuracy.after(trace.step, contact, trace.bodies)
    steps = int(trace.step["step"][-1])
    return CellOutcome(row.index, COMPLETE, steps, 0, 0, 0, accuracy, digest)


def ended_in(shards: Sequence[Path], unmeasured: bool) -> dict[str, list[tuple[Path, EndedCell]]]:
    """Return the cells that ended, by the names of their logs, each with the shards it is in.

    unmeasured: with those that completed and were not measured, behind others of the same cell.
    """
    from .cell_outcome import ended_cells

    found: dict[str, list[tuple[Path, EndedCell]]] = {}
    for shard in shards:
        for name, one in ended_cells(shard).items():
            status = one.outcome.status
            ended = not status.startswith(INTERRUPTED) if one.measured else status == COMPLETE
            if ended and (one.measured or unmeasured) and one.outcome.log is not None:
                found.setdefault(name, []).append((shard, one))
    return {name: sorted(ones, key=_is_unmeasured) for name, ones in found.items()}


def _is_unmeasured(one: tuple[Path, EndedCell]) -> bool:
    return not one[1].measured
