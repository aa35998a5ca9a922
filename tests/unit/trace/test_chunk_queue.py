"""Chunks stand in the file in the order in which they closed, whichever thread is done first."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from lavendersim.trace import chunk_queue
from lavendersim.trace.chunk_queue import ChunkQueue


class File:
    """Takes chunks as a container does; `full` of them fit into it."""

    def __init__(self, full: int = 1000) -> None:
        self.written: list[Any] = []
        self._full = full

    def write_chunk(self, one: Any) -> None:
        if len(self.written) >= self._full:
            raise OSError(28, "No space left on device")
        self.written.append(one)


def queue_of(file: File) -> ChunkQueue:
    return ChunkQueue(file)  # type: ignore[arg-type]


def closing(number: int, seconds: float) -> Callable[[], Any]:
    def close() -> Any:
        time.sleep(seconds)
        return number

    return close


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("threads", [1, 2, 5])
def test_chunks_stand_in_their_order(
    monkeypatch: pytest.MonkeyPatch, threads: int, seed: int
) -> None:
    with chunk_queue.ThreadPoolExecutor(threads) as pool:
        monkeypatch.setattr(chunk_queue, "_threads", pool)
        file, random = File(), np.random.default_rng(seed)
        queue = queue_of(file)
        for number, seconds in enumerate(random.uniform(0.0, 2e-3, 60).tolist()):
            queue.put(closing(number, seconds), 1)
        queue.drain()
    assert file.written == list(range(60))


def test_the_first_chunk_holds_up_all_behind_it() -> None:
    file, first = File(), threading.Event()
    queue = queue_of(file)

    def close() -> Any:
        first.wait()
        return 0

    queue.put(close, 1)
    for number in range(1, 4):
        queue.put(closing(number, 0.0), 1)
    assert file.written == []
    first.set()
    queue.drain()
    assert file.written == [0, 1, 2, 3]


def test_no_more_waits_than_may(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of ten chunks of one byte at most three wait when `put` returns."""
    monkeypatch.setattr(chunk_queue, "MOST_WAITING", 3)
    file = File()
    queue = queue_of(file)
    for number in range(10):
        queue.put(closing(number, 1e-3), 1)
        # Not what is written: whoever has the file may be held up by other processes.
        assert len([slot for slot in queue._asked if not slot.done.done()]) <= 3
    queue.drain()
    assert file.written == list(range(10))


def test_a_full_disk_is_reported_and_nothing_is_written_behind() -> None:
    file = File(full=2)
    queue = queue_of(file)

    def fill() -> None:
        for number in range(20):
            queue.put(closing(number, 1e-4), 1)
        queue.drain()

    with pytest.raises(OSError, match="No space"):
        fill()
    assert file.written == [0, 1]


def test_an_error_of_a_chunk_is_raised() -> None:
    queue = queue_of(File())

    def close() -> Any:
        raise ValueError("no chunk")

    queue.put(close, 1)
    with pytest.raises(ValueError, match="no chunk"):
        queue.drain()
