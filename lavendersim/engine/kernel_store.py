"""Where compiled code is kept on disk: one private directory, files written whole, within a limit.

What has not been used for longest makes room for what is new.
"""

from __future__ import annotations

import contextlib
import hashlib
import math
import os
import stat
import time
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Final, NamedTuple

from lavendersim.durable_files import write_whole

from .sources import source_hash

DIRECTORY_VARIABLE = "LAVENDER_CACHE_DIR"
LIMIT = 1_000_000_000  # [byte] of all that is kept: some thousand plans
NAMES = ".names"  # what kernels a plan has (`composition`)
KERNEL = ".kernel"  # before it `-` and the key of its arguments
SUFFIXES = (KERNEL, ".part", ".object", NAMES)
ANEW = "kernels are compiled anew in every process"


def _is_private(path: Path) -> bool:
    """Whether nobody else may write here: what is loaded from here is run."""
    if os.name != "posix":
        return True
    status = path.lstat()  # through a link somebody else could have it elsewhere later
    own = stat.S_ISDIR(status.st_mode) and status.st_uid == os.getuid()
    return own and not status.st_mode & 0o022


A_TICK: Final = 2_000_000_000  # [ns] that no file system's clock exceeds
# What `kernels_on_disk` found, and when the directory had changed last [ns]; 0: any time.
_listed: dict[Path, tuple[int, set[str]]] = {}
_unseen = math.inf  # [byte] written by this process since it looked whether all fits
_why_not = ""  # nothing may be kept, whatever the place


def keep_nothing(why: str) -> None:
    """Keep no compiled code from now on: that of this compiler could be taken for another's."""
    global _why_not
    _why_not = f"{why}: {ANEW}"


def directory() -> tuple[Path, str]:
    """Return where kernels are kept and a sentence when that is not the usual place.

    The path is empty when there is no such place.
    """
    return (Path(), _why_not) if _why_not else _place()


@cache
def _place() -> tuple[Path, str]:
    asked = os.environ.get(DIRECTORY_VARIABLE)
    usual = Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "lavender"
    path = Path(asked) if asked else usual
    with contextlib.suppress(OSError):
        path.mkdir(parents=True, exist_ok=True, mode=0o700)
        if _is_private(path) and os.access(path, os.W_OK):
            return path, ""
    # Never in a shared temporary folder: who made the directory there first, would be believed.
    refusal = f"{path} is no directory that this user alone can write"
    return Path(), f"{refusal}, {DIRECTORY_VARIABLE} names another: {ANEW}"


def kernels_on_disk() -> set[str]:
    """Return what the names of all whole kernels that are kept begin with, before their keys."""
    place = directory()[0]
    if not place.name:
        return set()
    with contextlib.suppress(OSError):
        begun, changed = time.time_ns(), place.stat().st_mtime_ns
        if _listed.get(place, (0, set()))[0] != changed:
            names = os.listdir(place)
            found = {name.rpartition("-")[0] for name in names if name.endswith(KERNEL)}
            # What is written within one tick of a file system's clock changes no time once more.
            _listed[place] = (changed if begun - changed > A_TICK else 0), found
        return _listed[place][1]
    return set()


def read(path: Path) -> bytes | None:
    """Return what is kept in a file; None where it is absent, damaged or somebody else's.

    A directory that vanishes while a process runs may be made again by others.
    """
    try:
        with path.open("rb") as file:
            if os.name == "posix" and os.fstat(file.fileno()).st_uid != os.getuid():
                return None
            stored = file.read()
    except OSError:
        return None
    checksum, payload = stored[:32], stored[32:]
    if hashlib.sha256(payload).digest() != checksum:
        return None
    with contextlib.suppress(OSError):  # when it was used last, whatever the disk notes itself
        os.utime(path, ns=(time.time_ns(), path.stat().st_mtime_ns))
    return payload


def write(path: Path, payload: bytes) -> None:
    """Keep something in a file, in one move, so that no reader sees half of it.

    It is not flushed, which a new plan with its hundred parts would wait for: what a power loss
    leaves half, its checksum shows, and it is compiled again. To look for room takes a tenth of a
    second for twenty thousand files: it is done at the first and after each hundredth of `LIMIT`.
    """
    global _unseen
    with contextlib.suppress(OSError):  # a full or read-only disk costs time, not the run
        write_whole(path, hashlib.sha256(payload).digest() + payload, flush=False, mode=0o600)
    _unseen += len(payload)
    if _unseen > LIMIT / 100:
        _unseen = 0
        make_room()


class Kept(NamedTuple):
    """Compiled code on disk: a whole kernel, or a part of some."""

    path: Path
    size: int  # [byte]
    used: int  # [ns] since the epoch, when it was last written or loaded
    current: bool  # whether this numba on this machine, as it is set, would load it


def _files(folder: Path) -> Iterator[tuple[os.DirEntry[str], os.stat_result]]:
    """Yield what is kept in a folder; another process may delete any of it at any time."""
    with contextlib.suppress(OSError):  # a disk may go away while a process runs
        for entry in [*os.scandir(folder)] if folder.name else ():
            if entry.name.endswith(SUFFIXES):
                with contextlib.suppress(OSError):
                    yield entry, entry.stat()


def kept_kernels() -> list[Kept]:
    """Return the compiled code on disk, what was used last at the end."""
    from .compile_options import build  # late: numba

    own = {build(), source_hash()[:8]}
    found = [
        Kept(
            Path(entry.path),
            status.st_size,
            status.st_atime_ns,
            not own.isdisjoint(Path(entry.name).stem.split("-")),
        )
        for entry, status in _files(directory()[0])
    ]
    return sorted(found, key=lambda kept: (kept.used, kept.path))


def make_room() -> None:
    """Delete what was not used for longest until the rest fits `LIMIT`."""
    total = sum(status.st_size for _, status in _files(directory()[0]))
    if total <= LIMIT:
        return
    for each in kept_kernels():
        with contextlib.suppress(OSError):
            each.path.unlink()
        total -= each.size
        if total <= LIMIT:
            return
