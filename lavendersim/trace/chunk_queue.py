"""Chunks that closed, laid out and compressed beside the simulation, written in their order.

Threads take chunks as they closed; whichever compressed the one that is next in the file writes it,
and all behind it that wait. So the simulation hands chunks over and goes on. It takes part where it
would have to wait, when too much is in memory or the log ends: it compresses what no thread has
begun.
"""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Final

from lavendersim.trace.container import Closed, Container

# Threads for all logs that this process writes, and how much of a log may wait for them [byte]:
# that bounds its memory. As many as cores: one fewer leaves the simulation undisturbed, and takes
# as long in all; where others use the cores, too, it takes longer.
COMPRESSORS: Final = min(4, os.cpu_count() or 1)
MOST_WAITING: Final = 64 * 1024 * 1024
_threads = ThreadPoolExecutor(COMPRESSORS, "lavender trace")


def _begin_forked() -> None:
    global _threads
    _threads = ThreadPoolExecutor(COMPRESSORS, "lavender trace")  # no thread is forked along


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_begin_forked)


class _Slot:
    """A chunk on its way into the file."""

    done: Future[None]

    def __init__(self, close: Callable[[], Closed], size: int) -> None:
        self.close, self.size = close, size
        self.closed: Closed | None = None  # once it is compressed


class ChunkQueue:
    """The chunks of one log that are not yet in its file."""

    def __init__(self, container: Container) -> None:
        self._container = container
        self._unwritten: deque[_Slot] = deque()  # in the order of the file
        self._asked: deque[_Slot] = deque()  # those that threads have; of the simulation alone
        self._writing = threading.Lock()
        self._failed = False

    def put(self, close: Callable[[], Closed], size: int) -> None:
        """Hand a chunk over; size: of its messages [byte]. What failed before is raised here.

        close: lays it out and compresses it, in any thread.
        """
        slot = _Slot(close, size)
        self._unwritten.append(slot)
        slot.done = _threads.submit(self._finish, slot)
        self._asked.append(slot)
        while self._asked and self._asked[0].done.done():
            self._asked.popleft().done.result()
        self._work_down(MOST_WAITING)

    def drain(self) -> None:
        """Return when every chunk is in the file."""
        self._work_down(0)

    def _work_down(self, most: int) -> None:
        """Return when threads have so much at the most [byte]."""
        while sum(slot.size for slot in self._asked) > most:
            mine = next((slot for slot in self._asked if slot.done.cancel()), None)
            if mine is None:
                self._asked.popleft().done.result()
            else:
                self._asked.remove(mine)
                self._finish(mine)

    def _finish(self, slot: _Slot) -> None:
        """Compress a chunk, and write it if it is next in the file, with those behind it."""
        slot.closed = slot.close()
        while self._is_next_ready() and self._writing.acquire(blocking=False):
            try:
                while not self._failed and self._is_next_ready():
                    self._write_next()
            finally:
                self._writing.release()
            # One that was compressed meanwhile found the lock taken: it is looked for once more.

    def _is_next_ready(self) -> bool:
        try:
            return not self._failed and self._unwritten[0].closed is not None
        except IndexError:  # written by another thread between the two
            return False

    def _write_next(self) -> None:
        closed = self._unwritten[0].closed
        assert closed is not None
        try:
            self._container.write_chunk(closed)
        except BaseException:
            self._failed = True  # nothing may stand behind a chunk that is not whole
            raise
        self._unwritten.popleft()
