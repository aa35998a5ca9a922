"""Leases: which worker runs which cell, among workers that share nothing but a folder.

    DIR/leases/LOG         whose cell it is: made with an exclusive create, so by one worker only
    DIR/shards/NAME/alive  its worker lives: locked by it, and touched every few seconds

A lease of a worker that is dead counts for nothing; another takes its place. On the machine of the
worker its lock tells, at once: the system ends that with the process. On another machine the time
of its last touch does, beside one of now, both by the clock of the file server.

Leases save work; nothing rests on them. Where two workers run one cell all the same, they write the
same bytes, each into its own directory.
"""

from __future__ import annotations

import os
import socket
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from lavendersim.errors import UsageError

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

SHARDS, LEASES, ALIVE = "shards", "leases", "alive"
BEAT: Final = 5.0  # [s] between two touches
DEAD_AFTER: Final = 60.0  # [s] without a touch, of a worker on another machine


class Leases:
    """The leases in a folder."""

    def __init__(self, into: Path) -> None:
        self._folder, self._shards = into / LEASES, into / SHARDS
        self._folder.mkdir(exist_ok=True)

    def take(self, log: str, shard: str, dead: set[str]) -> bool:
        """Take the lease of a cell for a shard; false where another worker that lives has it.

        dead: shards whose workers are known to be, and those that are found out here.
        """
        lease = self._folder / log
        while True:
            try:
                handle = os.open(lease, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666)
            except FileExistsError:
                if not self._end_of_dead(lease, shard, dead):
                    return False
                continue
            try:
                os.write(handle, shard.encode())
            finally:
                os.close(handle)
            return True

    def _end_of_dead(self, lease: Path, shard: str, dead: set[str]) -> bool:
        """Remove a lease that counts for nothing; false where its worker lives."""
        try:
            owner = lease.read_text()
        except FileNotFoundError:  # somebody else removed it
            return True
        if owner not in (shard, *dead):
            # Without a name it is half made: by a worker that lives, unless it stays so.
            lives = self.is_alive(owner) if owner else self._age(lease) < DEAD_AFTER
            if lives:
                return False
            dead.add(owner)
        aside = lease.with_name(f".{lease.name}.{shard}")
        with suppress(FileNotFoundError):
            os.rename(lease, aside)
            if aside.read_text() != owner:  # another took the dead one's place in between
                with suppress(FileExistsError):
                    os.link(aside, lease)
            aside.unlink()
        return True

    def is_alive(self, shard: str) -> bool:
        """Whether the worker of a shard lives."""
        file = self._shards / shard / ALIVE
        try:
            with file.open("rb") as opened:
                if opened.read().decode() == socket.gethostname() and fcntl is not None:
                    fcntl.flock(opened, fcntl.LOCK_SH | fcntl.LOCK_NB)
                    return False
        except FileNotFoundError:
            return False
        except BlockingIOError:
            return True
        except OSError:  # a file system without locks
            pass
        return self._age(file) < DEAD_AFTER

    def run_by_others(self, logs: Iterable[str]) -> list[str]:
        """Return which of these logs a worker that lives has the lease of."""
        owners: dict[str, str] = {}
        for log in logs:
            with suppress(FileNotFoundError):
                owners[log] = (self._folder / log).read_text()
        living = {owner for owner in {*owners.values()} if owner and self.is_alive(owner)}
        return [log for log, owner in owners.items() if owner in living]

    def _age(self, file: Path) -> float:
        """Return how long ago [s] a file was touched, by the clock of its file system."""
        os.utime(self._folder)
        try:
            return self._folder.stat().st_mtime - file.stat().st_mtime
        except FileNotFoundError:
            return DEAD_AFTER


@contextmanager
def alive(shard: Path) -> Iterator[None]:
    """Say meanwhile that the worker of a shard lives. UsageError where another process does so."""
    file = shard / ALIVE
    handle = os.open(file, os.O_CREAT | os.O_RDWR, 0o666)
    try:
        if fcntl is not None:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise UsageError(f"{shard}: another process runs its cells") from None
            except OSError:  # a file system without locks: the touches alone tell
                pass
        os.ftruncate(handle, 0)
        os.write(handle, socket.gethostname().encode())
        ended = threading.Event()
        beat = threading.Thread(target=_touch, args=(file, ended), daemon=True)
        beat.start()
        try:
            yield
        finally:
            ended.set()
            beat.join()
    finally:
        os.close(handle)


def _touch(file: Path, ended: threading.Event) -> None:
    while not ended.wait(BEAT):
        with suppress(OSError):  # a file server may be away for a while
            os.utime(file)
