"""Where the chunks, metadata and attachments of a log come from: its file, or who just wrote it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Protocol

from mcap.records import Attachment, Schema

from lavendersim.cell import CellConfig
from lavendersim.errors import OtherVersionError, TraceError
from lavendersim.trace import layout
from lavendersim.trace.container import CRC_KEY, FileIndex
from lavendersim.trace.former_config import former_config
from lavendersim.trace.index import (
    ChunkContent,
    damage,
    parse,
    parse_metadata,
    read_at,
    read_chunk,
)
from lavendersim.trace.rebuild import rebuilt_at
from lavendersim.trace.recorded import RECORDED, described
from lavendersim.trace.whole import ExpectedLog, check_bytes
from lavendersim.trace.writer import AS_WRITTEN, DESCRIPTION, RESOLVED, Written, description_of

FORMER_RESOLVED = "resolved.yaml"  # of logs before the config was JSON


class _OtherVersion(Exception):  # noqa: N818 - what pydantic says of a config
    pass


def _refused(constant: str) -> None:
    raise ValueError(f"{constant} is no number of a config")


def _config_of(data: dict[str, Any]) -> CellConfig:
    """Return a config. _OtherVersion where it has not the keys and values that this one reads."""
    try:
        return CellConfig.from_dict(data)
    except ValueError as error:
        raise _OtherVersion(str(error)) from None


class Source(Protocol):
    """What a trace reads of its log."""

    def verify(self) -> None:
        """Raise TraceError unless every byte of the log is as it was written."""

    def metadata(self) -> dict[str, dict[str, str]]:
        """Return the metadata records by their names."""

    def as_written(self) -> str:
        """Return the config file as its author wrote it."""

    def config(self) -> CellConfig:
        """Return the config of the cell; OtherVersionError where this version cannot read it."""

    def config_data(self) -> dict[str, Any]:
        """Return the config of the cell as the plain data that the log holds."""

    def schema(self, channel: int) -> Schema | None:
        """Return the schema of a channel; None where the log has no such channel."""

    def described(self, channel: int) -> dict[str, str]:
        """Return what the log says of a channel."""

    def chunks(self, channel: int) -> Iterator[ChunkContent]:
        """Yield the chunks that hold messages of a channel."""


class LogFile:
    """A log on disk; every record is checked, and all its bytes before the first that is read.

    Its metadata have checks of their own, and are read without that.
    """

    def __init__(self, path: Path, index: FileIndex, expected: ExpectedLog | None = None) -> None:
        """expected: what the run says of it, where it is read as that of a cell."""
        self._path, self._index = path, index
        self._expected = expected or ExpectedLog()
        self._verified = False

    def verify(self) -> None:
        """Raise TraceError unless every byte of the log is as it was written, of its cell."""
        if not self._verified:
            check_bytes(self._path, self._expected.digest)
            self._verified = True
            if self._expected.digest is None:
                self.check_config()

    def check_config(self) -> None:
        """Raise TraceError where the log has the config of another cell."""
        if not self._expected.config:
            return
        try:
            text = self._attachment(RESOLVED)
        except TraceError:
            return  # lost of a damaged log, which is called one
        if hashlib.sha256(text).hexdigest() != self._expected.config:
            raise TraceError(f"{self._path}: the log of another cell: it has another config")

    def metadata(self) -> dict[str, dict[str, str]]:
        """Return the metadata records by their names."""
        found = {}
        with self._path.open("rb") as stream:
            for entry in self._index.metadata:
                record = parse_metadata(read_at(stream, entry.offset, entry.length))
                found[record.name] = {k: v for k, v in record.metadata.items() if k != CRC_KEY}
        return found

    def as_written(self) -> str:
        """Return the config file as its author wrote it."""
        return self._attachment(AS_WRITTEN).decode()

    def config(self) -> CellConfig:
        """Return the config of the cell; OtherVersionError where this version cannot read it."""
        data = self.config_data()
        try:
            with damage(self._path, "its config"):
                return _config_of(data)
        except _OtherVersion as error:  # pydantic's: a count, then a key and what is wrong with it
            why = ": ".join(line.strip() for line in str(error).splitlines()[1:3])
            raise OtherVersionError(
                f"{self._path}: its config was written by another version: {why}"
            ) from None

    def config_data(self) -> dict[str, Any]:
        """Return the config of the cell as the plain data that the log holds."""
        names = [entry.name for entry in self._index.attachments]
        name = FORMER_RESOLVED if FORMER_RESOLVED in names else RESOLVED
        with damage(self._path, name):
            text = self._attachment(name)
            loaded = (
                json.loads(text, parse_constant=_refused)
                if name == RESOLVED
                else former_config(text)
            )
            if not isinstance(loaded, dict):
                raise ValueError("it is no mapping")
            return loaded

    def schema(self, channel: int) -> Schema | None:
        """Return the schema of a channel; None where the log has no such channel."""
        found = self._index.channels.get(channel)
        return None if found is None else self._index.schemas[found.schema_id]

    def described(self, channel: int) -> dict[str, str]:
        """Return what the log says of a channel."""
        return dict(self._index.channels[channel].metadata)

    def chunks(self, channel: int) -> Iterator[ChunkContent]:
        """Yield the chunks that hold messages of a channel."""
        self.verify()
        with self._path.open("rb") as stream:
            for entry in self._index.chunks:
                if channel in entry.message_index_offsets:
                    yield read_chunk(stream, entry)

    def _attachment(self, name: str) -> bytes:
        self.verify()
        entry = next((entry for entry in self._index.attachments if entry.name == name), None)
        if entry is None:
            raise TraceError(f"{self._path}: this log has lost its attachment {name}")
        with damage(self._path, f"attachment {name}"), self._path.open("rb") as stream:
            record: Attachment = parse(read_at(stream, entry.offset, entry.length), Attachment)
            if record.name != name:
                raise ValueError("another one stands in its place")
            return record.data


class PartOfLog(LogFile):
    """What is whole of a damaged log; record by record it is checked, all its bytes cannot be."""

    def verify(self) -> None:
        """Accept what was found whole."""

    def metadata(self) -> dict[str, dict[str, str]]:
        """Return the metadata records by their names; those that follow from the config always."""
        found = super().metadata()
        if DESCRIPTION not in found or RECORDED not in found:
            try:
                config = self.config()
            except TraceError:
                return found
            channels = self._index.channels
            why = "the log is damaged"
            absent = {topic: why for topic, c in layout.CHANNELS.items() if c not in channels}
            found.setdefault(DESCRIPTION, description_of(config, absent))
            if partly := described(config.record):
                found.setdefault(RECORDED, partly)
        return found

    def chunks(self, channel: int) -> Iterator[ChunkContent]:
        """Yield the chunks that hold messages of a channel."""
        with damage(self._path, "the log"), self._path.open("rb") as stream:
            for entry in self._index.chunks:
                if channel in entry.message_index_offsets:
                    yield rebuilt_at(stream, entry).content


class JustWritten:
    """A log that this process wrote: what describes it is still in memory."""

    def __init__(self, written: Written) -> None:
        self._written = written
        self._file = LogFile(written.path, written.entries)

    def verify(self) -> None:
        """Raise TraceError where the log is read from its file, and that has changed."""
        if self._written.blocks is None:
            self._file.verify()

    def metadata(self) -> dict[str, dict[str, str]]:
        """Return the metadata records by their names."""
        return self._written.metadata

    def as_written(self) -> str:
        """Return the config file as its author wrote it."""
        return self._written.as_written

    def config(self) -> CellConfig:
        """Return the config of the cell."""
        return self._written.config

    def config_data(self) -> dict[str, Any]:
        """Return the config of the cell as the plain data that the log holds."""
        return dict(json.loads(self._written.config.as_json()))

    def schema(self, channel: int) -> Schema | None:
        """Return the schema of a channel; None where the log has no such channel."""
        return self._file.schema(channel)

    def described(self, channel: int) -> dict[str, str]:
        """Return what the log says of a channel."""
        return self._file.described(channel)

    def chunks(self, channel: int) -> Iterator[ChunkContent]:
        """Yield the chunks that hold messages of a channel."""
        yield from self._file.chunks(channel)
