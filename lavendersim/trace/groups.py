"""The groups of steps of a log that are whole, found chunk by chunk."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final, NamedTuple

from mcap.records import ChunkIndex, Schema
from numpy.typing import NDArray

from lavendersim.cell.record import Recorded
from lavendersim.clock import Clock
from lavendersim.errors import LavenderError
from lavendersim.trace.contact_rows import COLUMNS, POINTS, contact_rows
from lavendersim.trace.container import FileIndex
from lavendersim.trace.index import PARSERS, ChunkContent, note, parse, spans
from lavendersim.trace.layout import CHANNELS
from lavendersim.trace.rebuild import sequences_of
from lavendersim.trace.recorded import KEYS, is_recorded
from lavendersim.trace.source import PartOfLog
from lavendersim.trace.writer import ABSENT, DESCRIPTION

STEP: Final = CHANNELS["/step"]
GEOMETRY: Final = frozenset({CHANNELS["/robot_description"]})  # a chunk apart, before all groups


class Group(NamedTuple):
    """The steps of a group, the first and the last, and their times [ns]."""

    first: int
    last: int
    begin: int
    end: int


class Waiting(NamedTuple):
    """A whole chunk whose group is not yet at its end: where it stands, and how much it has."""

    entry: ChunkIndex
    counts: dict[int, int]  # channel -> messages
    contacts: dict[int, int]  # channel -> contacts, in chunks of points and of columns


class Groups:
    """Groups as their chunks come; those that are whole are entered into an index."""

    def __init__(self, path: Path, entries: FileIndex) -> None:
        self.whole: list[Group] = []
        self._path, self._entries = path, entries
        self._waiting: list[Waiting] = []
        self._spoilt = False  # the group that is not yet at its end
        self._config: tuple[Clock | None, dict[str, Recorded]] | None = None  # once read

    @property
    def unfinished(self) -> bool:
        """Whether chunks wait for the end of their group, or some of it are lost."""
        return self._spoilt or bool(self._waiting)

    def lose(self, channels: frozenset[int]) -> None:
        """Note that a chunk is lost; channels: its own, none where they are not known."""
        if channels != GEOMETRY:
            self._spoilt = True
        if STEP in channels:  # it was the last of its group
            self._waiting, self._spoilt = [], False

    def take(self, entry: ChunkIndex, content: ChunkContent) -> None:
        """Take a whole chunk."""
        for opcode, first, last in spans(content.prologue):
            note(self._entries, parse(content.prologue[first:last], PARSERS[opcode]))
        counts = {channel: len(rows) for channel, rows in content.messages.items()}
        contacts = {
            channel: contact_rows(content, channel, self._schema(channel))
            for channel in (POINTS, COLUMNS)
            if channel in counts and channel in self._entries.channels
        }
        chunk = Waiting(entry, counts, contacts)
        if chunk.counts.keys() == GEOMETRY:
            self._commit(chunk)
            return
        self._waiting.append(chunk)
        if STEP in chunk.counts:
            steps = sequences_of(content, STEP)
            begin, end = chunk.entry.message_start_time, chunk.entry.message_end_time
            group = Group(int(steps[0]), int(steps[-1]), begin, end)
            if not self._spoilt and self._is_whole(group, steps):
                for one in self._waiting:
                    self._commit(one)
                self.whole.append(group)
            self._waiting, self._spoilt = [], False

    def _schema(self, channel: int) -> Schema:
        return self._entries.schemas[self._entries.channels[channel].schema_id]

    def _is_whole(self, group: Group, steps: NDArray[Any]) -> bool:
        """Whether the chunks are of the steps of the light one, and all of them are there."""
        entries = [one.entry for one in self._waiting]
        inside = all(
            group.begin <= one.message_start_time and one.message_end_time <= group.end
            for one in entries
        )
        known = all(one.counts.keys() <= self._entries.channels.keys() for one in self._waiting)
        after = self.whole[-1].last if self.whole else -1
        if not (inside and known and group.first > after):
            return False
        points, columns = (
            sum(one.contacts.get(channel, 0) for one in self._waiting)
            for channel in (POINTS, COLUMNS)
        )
        if points != columns and COLUMNS in self._entries.channels:  # not in older logs
            return False
        for topic, expected in self._expected(steps).items():
            if sum(one.counts.get(CHANNELS[topic], 0) for one in self._waiting) != expected:
                return False
        return True

    def _expected(self, steps: NDArray[Any]) -> dict[str, int]:
        """Return how many messages of poses and of contacts there are of some steps."""
        if self._config is None:
            self._config = self._recorded()
        clock, recorded = self._config
        if clock is None:
            return {}
        return {t: int(is_recorded(which, clock, steps).sum()) for t, which in recorded.items()}

    def _recorded(self) -> tuple[Clock | None, dict[str, Recorded]]:
        """Return the times of steps, and of which the log has what; none where it is not known."""
        log = PartOfLog(self._path, self._entries)
        try:
            absent = json.loads(log.metadata().get(DESCRIPTION, {}).get(ABSENT, "{}"))
            config = log.config()
        except (LavenderError, ValueError):
            return None, {}
        kept = {topic: getattr(config.record, key) for topic, key in KEYS.items()}
        return config.clock, {topic: kept[topic] for topic in kept if topic not in absent}

    def _commit(self, chunk: Waiting) -> None:
        self._entries.chunks.append(chunk.entry)
        for channel, count in chunk.counts.items():
            self._entries.counts[channel] = self._entries.counts.get(channel, 0) + count
