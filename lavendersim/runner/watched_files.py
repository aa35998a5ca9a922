"""The files that a run of configs reads, and whether they were saved again since."""

from __future__ import annotations

import os
import re
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from lavendersim.errors import UsageError
from lavendersim.measures.specs.own import FILE as OWN_MEASURES

from .configs import find_configs

POLL: Final = 0.3  # [s] between two looks
_EXTENDS: Final = re.compile(rb"^extends:\s*[\"']?([^\"'#\r\n]+)", re.MULTILINE)

Stamps = dict[Path, tuple[int, int]]  # when it was last written [ns], bytes


def stamps_of(configs: Sequence[Path]) -> Stamps:
    """Return what tells a saved file from before: of configs, those they extend, their measures.

    A file that is not there now, as while an editor puts a new one in its place, has none.
    """
    try:
        waiting = find_configs(list(configs))
    except UsageError:  # gone for now
        return {}
    stamps: Stamps = {}
    while waiting:
        file = waiting.pop()
        try:
            status = file.stat()
            text = file.read_bytes() if file.suffix != ".py" else b""
        except OSError:
            continue
        if file in stamps:
            continue
        stamps[file] = status.st_mtime_ns, status.st_size
        parents = [os.fsdecode(name).strip() for name in _EXTENDS.findall(text)]
        waiting += [file.parent / name for name in parents]
        waiting += [file.parent / OWN_MEASURES] * (file.suffix != ".py")
    return stamps


def saves(configs: Sequence[Path]) -> Iterator[int]:
    """Yield at once, and then whenever one of the files was saved; how many are watched."""
    seen: Stamps | None = None
    while True:
        now = stamps_of(configs)
        if now and now != seen:
            seen = now
            yield len(now)
        else:
            time.sleep(POLL)
