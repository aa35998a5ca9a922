"""The bytes of a config file, or of one that it names, up to a limit; a pipe is none."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from lavendersim.errors import UsageError
from lavendersim.experiment.text.parse import LARGEST_FILE


def read_file(file: Path, name: str, most: int | None = None) -> tuple[bytes, int]:
    """Return the beginning of a file and its size [byte]; name: how messages call it.

    most: bytes that it may have, as many as a config if None; of more, one is read. UsageError
    where it cannot be read.
    """
    try:
        if not stat.S_ISREG(file.stat().st_mode) and not file.is_dir():
            # Opened, a pipe without a writer would wait for one.
            raise UsageError(f"{name}: expected a file, this is a pipe or a device")
        with file.open("rb") as stream:
            raw = stream.read((LARGEST_FILE if most is None else most) + 1)
            size = os.fstat(stream.fileno()).st_size
    except OSError as error:
        raise UsageError(f"{name}: {(error.strerror or str(error)).lower()}") from None
    return raw, max(size, len(raw))
