"""Makes a well-formed log of what is whole of a damaged one, beside it.

What stands around the numbers (header, indexes, summary) is made again. Where nothing else was
damaged the new log has the bytes of the old one as it was, which its CRC proves; a part of a log is
marked by its status. One chunk is in memory at a time.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Final, Literal, NamedTuple

import numpy as np
from mcap.records import Attachment

from lavendersim.durable_files import written_aside
from lavendersim.errors import TraceError, UsageError
from lavendersim.trace.container import Closed, Container, Messages, Registered, closed
from lavendersim.trace.groups import STEP
from lavendersim.trace.index import PARSERS, damage, note, parse, read_at, read_summary, spans
from lavendersim.trace.reader import RECOVERED
from lavendersim.trace.rebuild import Rebuilt, rebuilt_at
from lavendersim.trace.scan import Remaining, scan
from lavendersim.trace.source import LogFile, PartOfLog
from lavendersim.trace.whole import check_bytes
from lavendersim.trace.wire import NANOSECONDS
from lavendersim.trace.writer import ENDING

Outcome = Literal["whole", "part"]
SUFFIX: Final = ".recovered.mcap"  # of a log that is recovered beside another
EXCHANGED: Final = "no record for certain: the CRC over all of them is another's"


class RecoveryReport(NamedTuple):
    """What was recovered of a log."""

    path: Path
    out: Path | None  # None where the log is whole, or was recovered itself
    outcome: Outcome
    steps: int  # rows of /step in the log
    last_time: float  # of the last of them [s]
    lost: tuple[str, ...]  # what is not in the new log, in words
    status: str  # of the new log


def beside(path: Path) -> Path:
    """Return where a log is recovered to where nothing else is asked for."""
    return path.with_name(path.name.removesuffix(".mcap") + SUFFIX)


def needs_recovery(path: Path) -> bool:
    """Whether a log is not as it was written; all its bytes are read."""
    try:
        check_bytes(path)
    except TraceError:
        return True
    return False


def recover(path: str | Path, out: str | Path | None = None) -> RecoveryReport:
    """Write what is whole of a damaged log to a new file; by default that of `beside`.

    Nothing is written of a log that is whole, or that was recovered itself. TraceError when nothing
    can be recovered; UsageError where a file of that name exists.
    """
    path = Path(path)
    out = beside(path) if out is None else Path(out)
    if not path.is_file():
        raise TraceError(f"{path}: no such log")
    if not needs_recovery(path):
        return _as_it_is(path)
    if out.exists():
        raise UsageError(f"{out}: exists already, and recover writes to no file that does")
    with damage(path, "the log"):
        part = scan(path)
        status = _ending(path, part) if part.ended and not part.lost else ""
        with _new_file(out) as unfinished:
            if not status or not _write(path, part, status, unfinished):
                lost = part.lost or [EXCHANGED]
                part = part._replace(lost=lost)
                status = _marked(part)
                _write(path, part, status, unfinished)
    return _report(path, out, part, status)


def _report(path: Path, out: Path, part: Remaining, status: str) -> RecoveryReport:
    steps, last = _extent(part)
    outcome: Outcome = "part" if part.lost else "whole"
    return RecoveryReport(path, out, outcome, steps, last, tuple(part.lost), status)


def _extent(part: Remaining) -> tuple[int, float]:
    """Return how many steps there are, and the time of the last [s]."""
    steps = sum(group.last - group.first + 1 for group in part.groups)
    return steps, part.groups[-1].end / NANOSECONDS


def _marked(part: Remaining) -> str:
    steps, last = _extent(part)
    return f"{RECOVERED}: {steps} steps, up to {last:.9g} s; lost: {'; '.join(part.lost)}"


def _as_it_is(path: Path) -> RecoveryReport:
    """Return the report on a log that needs no recovery."""
    with damage(path, "the log"):
        entries = read_summary(path)
        status = LogFile(path, entries).metadata()[ENDING]["status"]
        statistics = entries.statistics()
    outcome: Outcome = "part" if status.startswith(RECOVERED) else "whole"
    lost = (status,) if outcome == "part" else ()
    last = statistics.message_end_time / NANOSECONDS
    return RecoveryReport(path, None, outcome, entries.counts.get(STEP, 0), last, lost, status)


def _ending(path: Path, part: Remaining) -> str:
    return PartOfLog(path, part.entries).metadata()[ENDING]["status"]


@contextlib.contextmanager
def _new_file(out: Path) -> Iterator[Path]:
    """Give the name of a file that becomes `out` when it is whole, unless there is one by then."""
    try:
        with written_aside(out, anew=True) as unfinished:
            yield unfinished
    except FileExistsError:
        raise UsageError(f"{out}: exists already") from None


def _write(path: Path, part: Remaining, status: str, out: Path) -> bool:
    """Write what is whole; tells whether that is what the CRC of the old log, if any, is of."""
    log, container = PartOfLog(path, part.entries), Container(out)
    try:
        with path.open("rb") as stream:
            for place in part.entries.attachments:
                a: Attachment = parse(read_at(stream, place.offset, place.length), Attachment)
                container.attach(a.name, a.media_type, a.data)
            for name, values in log.metadata().items():
                if name != ENDING:
                    container.describe(name, values)
            for entry in part.entries.chunks:
                container.write_chunk(_with_records(container, part, rebuilt_at(stream, entry)))
        container.describe(ENDING, {"status": status})
        crc = container.crc
        container.finish()
    finally:
        container.abandon()
    return part.crc in (None, crc)


def _with_records(container: Container, part: Remaining, one: Rebuilt) -> Closed:
    """Return a chunk for the new log, opened by the records of channels that it has not yet."""
    content, known = one.content, container.index
    found = type(known)()
    for opcode, first, last in spans(content.prologue):
        note(found, parse(content.prologue[first:last], PARSERS[opcode]))
    container.register(Registered.of(found.schemas.values(), found.channels.values()))
    missing = [part.entries.channels[c] for c in content.messages if c not in known.channels]
    messages = [Messages(*group) for group in content.messages.items()]
    payload = content.data.tobytes()
    if not missing:
        return Closed(one.chunk, messages)
    schemas = {channel.schema_id: part.entries.schemas[channel.schema_id] for channel in missing}
    records = Registered.of(
        (schema for number, schema in schemas.items() if number not in known.schemas), missing
    )
    container.register(records)
    moved = [Messages(group.channel, group.entries.copy()) for group in messages]
    for group in moved:
        group.entries["offset"] += np.uint64(len(records.data))
    return closed(records.data + payload, moved)
