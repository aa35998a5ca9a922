"""SHA-256 of a file while it is written, large parts in a thread beside the one that writes.

Of the file's bytes as they stand, so that `sha256sum` of anybody gives the same.
"""

from __future__ import annotations

import hashlib
import os
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Final

# So much is summed at once beside [byte]: handing it over costs a thousandth of summing it. Less
# than that, which is all of a short log, is summed where it is asked for.
BESIDE: Final = 1024 * 1024
# One thread for all files: parts of each are summed in their order. It sums a GB/s, compressed.
_thread = ThreadPoolExecutor(1, "lavender digest")


def _begin_forked() -> None:
    global _thread
    _thread = ThreadPoolExecutor(1, "lavender digest")  # no thread is forked along


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_begin_forked)


class FileDigest:
    """The digest of bytes that come part after part."""

    def __init__(self) -> None:
        self._sum = hashlib.sha256()
        self._parts: list[bytes] = []
        self._size = 0
        self._beside: Future[None] | None = None

    def update(self, data: bytes) -> None:
        """Count bytes in; they stay as they are."""
        self._parts.append(data)
        self._size += len(data)
        if self._size > BESIDE:
            self._beside = _thread.submit(self._take, self._parts)
            self._parts, self._size = [], 0

    def hexdigest(self) -> str:
        """Return the digest of all that came."""
        if self._beside is not None:
            self._beside.result()
        self._sum.update(b"".join(self._parts))  # of many parts are small, and a call is not
        self._parts = []
        return self._sum.hexdigest()

    def _take(self, parts: list[bytes]) -> None:
        for part in parts:
            self._sum.update(part)
