"""Files that are there whole or not at all, after a kill, on a full disk and after a power loss.

    write aside -> flush the file -> rename -> flush the folder

The one door through which files are written, but for logs: these grow for hours, and what is whole
of them is to be readable after a kill. To flush takes half a millisecond of a disk. So what counts
only together is flushed together: `flush=False` for each, `flush_tree` before what makes it count.
"""

from __future__ import annotations

import contextlib
import hashlib
import itertools
import os
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Final

# Files of a tree that are flushed for themselves, so many at once that a file system with a journal
# writes it once for several. Of more files all of the file system is flushed: 300 logs of a sweep
# take 35 ms so, 100 ms for themselves, 390 ms in turn; but what others wrote goes along.
FEW: Final = 32
AT_ONCE: Final = 16
BUFFER: Final = 1024 * 1024  # [B] of a file that is written in pieces
DIGITS: Final = 8  # of the digest of a name that is cut
MOST_BYTES: Final = 150  # of a name in a path, of 255: a time and a digest stand beside it
_number = itertools.count()


def path_name(name: str, most: int = MOST_BYTES) -> str:
    """Return a name with `_` for what a terminal would obey, of at most so many bytes of UTF-8.

    A longer one is cut and ends with a digest of the whole, by which it is another's no more.
    """
    shown = "".join(one if one.isprintable() else "_" for one in name)
    if len(shown.encode()) <= most:
        return shown
    digest = hashlib.sha256(name.encode("utf-8", "surrogateescape")).hexdigest()[:DIGITS]
    return f"{shown.encode()[: most - DIGITS - 1].decode('utf-8', 'ignore')}-{digest}"


@contextlib.contextmanager
def written_aside(path: Path, *, flush: bool = True, anew: bool = False) -> Iterator[Path]:
    """Give the name of a file that becomes `path` when it is whole; its folder is made.

    flush: false where something else flushes it before it counts, or where half of it would be
    found out. anew: FileExistsError where there is such a file by then. An earlier file stays as it
    was where anything fails.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = _aside(path)
    try:
        with named(path, unfinished):
            yield unfinished
            if flush:
                _flush(unfinished)
            _move(unfinished, path, anew)
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(unfinished)
    if flush:
        flush_folder(path.parent)


def write_whole(path: Path, content: bytes | str, *, flush: bool = True, mode: int = 0o666) -> None:
    """Write a file; a text in UTF-8. mode: who may read and write it, less the user's mask."""
    write_together({path: content}, flush=flush, mode=mode)


def write_together(
    contents: Mapping[Path, bytes | str], *, flush: bool = True, mode: int = 0o666
) -> None:
    """Write files: all of them aside before the first takes its place."""
    aside = {path: _aside(path) for path in contents}
    try:
        for path, content in contents.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            data = content.encode() if isinstance(content, str) else content
            with named(path, aside[path]):
                _write(aside[path], data, flush, mode)
        for path, unfinished in aside.items():
            with named(path, unfinished):
                os.replace(unfinished, path)
    finally:
        for unfinished in aside.values():
            with contextlib.suppress(FileNotFoundError):
                os.unlink(unfinished)
    if flush:
        for folder in {path.parent for path in contents}:
            flush_folder(folder)


def write_in_pieces(path: Path, pieces: Iterable[str], *, flush: bool = True) -> None:
    """Write a file from pieces of text, in UTF-8; they are taken as they are written."""
    with (
        written_aside(path, flush=flush) as unfinished,
        named(path, unfinished),
        unfinished.open("w", BUFFER, encoding="utf-8", newline="") as file,
    ):
        file.writelines(pieces)


def flush_folder(folder: Path) -> None:
    """Flush the names in a folder to the disk; where a system has no such call, nothing."""
    if os.name == "posix":
        _flush(folder)


def flush_tree(folder: Path) -> None:
    """Flush all files below a folder, and the names in it, to the disk."""
    folders, files = [], []
    for place, _, names in os.walk(folder):
        folders.append(Path(place))
        files += [os.path.join(place, name) for name in names]
    if len(files) > FEW and flush_file_system(folder):
        return
    from concurrent.futures import ThreadPoolExecutor  # late: runs are listed without

    with ThreadPoolExecutor(AT_ONCE) as threads:
        list(threads.map(_flush, map(Path, files)))
    for each in folders:
        flush_folder(each)


def flush_file_system(folder: Path) -> bool:
    """Flush the file system that a folder is in; false where the system has no such call."""
    if sys.platform != "linux":
        return False
    import ctypes  # late: runs are listed without

    handle = os.open(folder, os.O_RDONLY)
    try:
        library = ctypes.CDLL(None, use_errno=True)
        if library.syncfs(handle):
            error = ctypes.get_errno()
            raise OSError(error, os.strerror(error), str(folder))
    finally:
        os.close(handle)
    return True


def _aside(path: Path) -> Path:
    """Return a name beside a file that nobody else takes; some libraries go by the suffix."""
    return path.with_name(f".{path.stem}.{os.getpid()}-{next(_number)}.unfinished{path.suffix}")


@contextlib.contextmanager
def named(path: Path, aside: Path | None = None) -> Iterator[None]:
    """Let an error of the system say which file it is of: a full disk does not.

    aside: the file that is written in place of it.
    """
    try:
        yield
    except OSError as error:
        nameless = error.filename is None or str(error.filename) == str(aside)
        if error.errno is not None and nameless:  # of the system, which knows the name aside
            error.filename = str(path)
        raise


def _write(path: Path, data: bytes, flush: bool, mode: int) -> None:
    flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | getattr(os, "O_BINARY", 0)
    handle = os.open(path, flags, mode)
    try:
        left = memoryview(data)
        while left:
            left = left[os.write(handle, left) :]
        if flush:
            os.fsync(handle)
    finally:
        os.close(handle)


def _flush(path: Path) -> None:
    folder = path.is_dir()
    handle = os.open(path, os.O_RDONLY if folder or os.name == "posix" else os.O_RDWR)
    try:
        with named(path):
            os.fsync(handle)
    finally:
        os.close(handle)


def _move(unfinished: Path, path: Path, anew: bool) -> None:
    if not anew:
        os.replace(unfinished, path)
        return
    try:
        os.link(unfinished, path)
    except FileExistsError:
        raise
    except OSError:  # a file system without links
        os.replace(unfinished, path)
