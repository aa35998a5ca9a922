"""Logs that are whole by every checksum, and claim what cannot be; put to every verb that reads.

    python tests/cli/strange_logs.py RUN OTHER KIND

writes the log KIND over that of the first cell of RUN, as if the run had written it, puts RUN to
every verb in this process, of bounded memory, and prints what became of each as JSON. OTHER is a
whole run, for `diff`.
"""

from __future__ import annotations

import hashlib
import json
import resource
import signal
import sys
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import zstandard
from mcap.records import Chunk

sys.path.insert(0, str(Path(__file__).parents[2]))
sys.path.insert(0, str(Path(__file__).parent))

from damaged_runs import Done, logs, verb

from lavendersim.runner.run_directory import CELLS, SEALED
from lavendersim.runner.run_index import as_row
from lavendersim.runner.run_seal import DONE, seal_of
from lavendersim.trace import layout
from lavendersim.trace.container import Closed, Container, Messages, Registered
from lavendersim.trace.decode import body_of, message_class
from lavendersim.trace.index import message_indexes, open_chunk, parse, read_at, read_summary
from lavendersim.trace.source import LogFile
from lavendersim.trace.wire import INDEX_ENTRY, Template
from lavendersim.trace.writer import DESCRIPTION, ENDING, RESOLVED, TIMESTEP_CHANGES

MEMORY = 7 * 1024**3 // 2  # [byte] of addresses; libraries and their threads take up to 3.2 GB
LONGEST = 120  # [s] of ten verbs, on a busy machine
COLUMNS = layout.CHANNELS["/contact_columns"]


class Log:
    """What a log is made of, to be changed and written again."""

    def __init__(self, path: Path) -> None:
        entries = read_summary(path)
        file = LogFile(path, entries)
        self.metadata = file.metadata()
        self.attachments = {
            entry.name: file._attachment(entry.name) for entry in entries.attachments
        }
        self.registered = Registered.of(entries.schemas.values(), entries.channels.values())
        self.schemas = entries.schemas
        self.chunks: list[tuple[Chunk, list[Messages]]] = []
        with path.open("rb") as stream:
            for entry in entries.chunks:
                record = read_at(stream, entry.chunk_start_offset, entry.chunk_length)
                begin = entry.chunk_start_offset + entry.chunk_length
                indexes = read_at(stream, begin, entry.message_index_length)
                self.chunks.append((parse(record, Chunk), message_indexes(indexes)))

    def write(self, path: Path) -> Any:
        """Write it with every checksum right; returns its digest."""
        out = Container(path)
        out.register(self.registered)
        for name, data in self.attachments.items():
            out.attach(name, "", data)
        first = {name: of for name, of in self.metadata.items() if name != ENDING}
        for name, values in first.items():
            out.describe(name, values)
        for chunk, messages in self.chunks:
            out.write_chunk(Closed(chunk, messages))
        if ENDING in self.metadata:
            out.describe(ENDING, self.metadata[ENDING])
        return out.finish()

    def describe(self, **values: str) -> None:
        """Change what the log says of itself."""
        self.metadata[DESCRIPTION] |= values


def resolved(log: Log, change: Callable[[dict[str, Any]], None]) -> None:
    """Change the resolved config of a log."""
    data = json.loads(log.attachments[RESOLVED])
    change(data)
    log.attachments[RESOLVED] = json.dumps(data).encode()


def former(log: Log, text: bytes) -> None:
    """Give a log the config of older ones, in YAML."""
    del log.attachments[RESOLVED]
    log.attachments["resolved.yaml"] = text


def claim(log: Log, size: int) -> None:
    """Let the last chunk claim so many bytes, in its record and in its zstd frame."""
    chunk, messages = log.chunks[-1]
    head = b"\x28\xb5\x2f\xfd\xe0" + size.to_bytes(8, "little")  # one segment, eight bytes of size
    log.chunks[-1] = (_like(chunk, head + b"\x01\0\0", size, 0), messages)


def zeros(log: Log, size: int, times: int) -> None:
    """Let chunks be of so many zeros, which zstd makes a ten thousandth of."""
    made = zstandard.ZstdCompressor(level=1).compressobj(size=size)
    block, crc, left, pieces = bytes(1 << 20), 0, size, []
    while left:
        part = block[: min(left, len(block))]
        crc, left = zlib.crc32(part, crc), left - len(part)
        pieces.append(made.compress(part))
    data = b"".join([*pieces, made.flush()])
    chunk, messages = log.chunks[-1]
    log.chunks[-1:] = [(_like(chunk, data, size, crc), messages)] * times


def _like(chunk: Chunk, data: bytes, size: int, crc: int) -> Chunk:
    times = chunk.message_start_time, chunk.message_end_time
    return Chunk("zstd", data, times[1], times[0], crc, size)


def contact_columns(log: Log, change: Callable[[Any], None]) -> None:
    """Change the first message of the columns of contacts."""
    for number, (chunk, messages) in enumerate(log.chunks):
        if [group.channel for group in messages] != [COLUMNS]:
            continue
        content = open_chunk(chunk, messages)
        entries = content.messages[COLUMNS]
        schema = log.schemas[7]
        message = message_class(schema.name, schema.data)()
        message.ParseFromString(body_of(content, int(entries["offset"][0])))
        change(message)
        form = layout.record("/contact_columns", Template().constant(message.SerializeToString()))
        record = form.rows(1)
        at = int(entries["offset"][0])
        head = content.data[at + 9 : at + 9 + layout.MESSAGE_HEADER]
        record[0, 9 : 9 + layout.MESSAGE_HEADER] = head
        payload = content.prologue + record.tobytes()
        rows = np.array([(int(entries["time"][0]), len(content.prologue))], INDEX_ENTRY)
        data = zstandard.ZstdCompressor().compress(payload)
        made = _like(chunk, data, len(payload), zlib.crc32(payload))
        made.message_end_time = made.message_start_time
        log.chunks[number] = (made, [Messages(COLUMNS, rows)])
        return
    raise AssertionError("the log has no columns of contacts")


def counted(number: int) -> Callable[[Any], None]:
    """Return what gives each of the first step's contacts such a count."""

    def change(message: Any) -> None:
        counts = np.frombuffer(message.counts, "<i8").copy()
        counts[0] = number
        message.counts = counts.tobytes()

    return change


def without_columns(message: Any) -> None:
    """Let a message have contacts without a column."""
    counted(2**40)(message)
    del message.names[:]
    del message.kinds[:]
    message.keys = message.planes = message.predictors = b""


BILLION = b"a: &a [x, x, x, x, x, x, x, x, x, x]\n" + b"".join(
    b"%c: &%c [%s]\n" % (one + 1, one + 1, b", ".join([b"*%c" % one] * 10))
    for one in range(97, 107)
)
KINDS: dict[str, Callable[[Log], None]] = {
    "timestep of 1e30000000": lambda log: log.describe(timestep="1e30000000"),
    "timestep divided by zero": lambda log: log.describe(timestep="1/0"),
    "timestep below zero": lambda log: log.describe(timestep="-1/240"),
    "timestep of a million digits": lambda log: log.describe(timestep="9" * 1_000_000),
    "timestep changes 200,000 times": lambda log: log.describe(
        **{TIMESTEP_CHANGES: json.dumps([[k, f"1/{2 * k + 3}"] for k in range(200_000)])}
    ),
    "times of huge ratios": lambda log: log.describe(
        **{TIMESTEP_CHANGES: json.dumps([[k, f"1/{10**400 + k}"] for k in range(5000)])}
    ),
    "nested names": lambda log: log.describe(bodies="[" * 200_000),
    "names that are none": lambda log: log.describe(bodies="7"),
    "no format": lambda log: log.metadata.update({DESCRIPTION: {}}),
    "nested config": lambda log: log.attachments.update({RESOLVED: b"[" * 200_000}),
    "config of a list": lambda log: log.attachments.update({RESOLVED: b"[1]"}),
    "config with a timestep of 1e30000000": lambda log: resolved(
        log, lambda data: data["numerics"].update(timestep="1e30000000")
    ),
    "config with a mass of NaN": lambda log: resolved(
        log, lambda data: data["scene"]["bodies"]["ball"].update(mass=float("nan"))
    ),
    "YAML with a tag": lambda log: former(log, b"scene: !!python/object/apply:os.getcwd []\n"),
    "YAML of aliases": lambda log: former(log, BILLION),
    "YAML nested": lambda log: former(log, b"a: " + b"[" * 100_000),
    "chunk of 100 GB": lambda log: claim(log, 100 * 10**9),
    "chunk of 2^63": lambda log: claim(log, 2**63),
    "1 GiB of zeros": lambda log: zeros(log, 1 << 30, 1),
    "30 chunks of zeros": lambda log: zeros(log, 60 << 20, 30),
    "count of 2^62": lambda log: contact_columns(log, counted(2**62)),
    "count below zero": lambda log: contact_columns(log, counted(-5)),
    "count without columns": lambda log: contact_columns(log, without_columns),
}


def plant(run: Path, kind: str) -> Path:
    """Write the log of this kind over one of a run, as if the run had written it."""
    path = logs(run)[0]
    log = Log(path)
    KINDS[kind](log)
    digest = log.write(path)
    index = json.loads((run / CELLS).read_text())
    for row in index["cells"]:
        if row["file"].endswith(path.name):
            row["log"] = as_row(digest)
            if RESOLVED in log.attachments:
                row["config"] = hashlib.sha256(log.attachments[RESOLVED]).hexdigest()
            else:
                row["config"] = ""
    (run / CELLS).write_text(json.dumps(index))
    (run / DONE).write_text(seal_of(run, SEALED))
    return path


def every_verb(run: Path, other: Path, log: Path) -> dict[str, Done]:
    """Put a run to every verb that reads logs."""
    cell = next(
        k
        for k, row in enumerate(json.loads((run / CELLS).read_text())["cells"])
        if row["file"].endswith(log.name)
    )
    out = run.parent / "out"
    calls: dict[str, tuple[object, ...]] = {
        "ls": ("ls", "--runs", run.parent),
        "show": ("show", run),
        "verify": ("verify", run),
        "judge": ("judge", run),
        "plot": ("plot", run, "-o", out / "figures"),
        "plot what is whole": ("plot", run, "--allow-incomplete", "-o", out / "part"),
        "replay": ("replay", run, "--cell", cell, "--save", out / "a.rrd"),
        "export": ("export", run, "--to", "csv", "-o", out / "csv"),
        "diff": ("diff", run, other),
        "recover": ("recover", log, "--output", out / "saved.mcap"),
    }
    out.mkdir(exist_ok=True)
    return {name: verb(*arguments) for name, arguments in calls.items()}


def main() -> None:
    """Plant a log, put it to every verb, print what became of each; ended where that takes long."""
    signal.alarm(LONGEST)
    run, other, kind = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
    log = plant(run, kind) if kind in KINDS else logs(run)[0]
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    done = every_verb(run, other, log)
    print(json.dumps({name: one._asdict() for name, one in done.items()}))


if __name__ == "__main__":
    main()
