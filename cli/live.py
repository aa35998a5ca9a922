"""`lavender run --live`: a process of its own follows the log of the first cell, in a copy.

A log comes in chunks of thousands of steps; its copy is readable up to the last quarter second.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

PATIENCE = 60.0  # [s] for it to show the last of a log


@contextmanager
def shown_live() -> Iterator[tuple[Callable[[Path], None], Path]]:
    """Give what begins to show a run's first cell by its directory, and where the copy is expected.

    Waits until it is shown.
    """
    begun: list[subprocess.Popen[bytes]] = []
    with tempfile.TemporaryDirectory(prefix="lavender-live-") as folder:
        copy = Path(folder) / "copy.mcap"

        def begin(directory: Path) -> None:
            command = ["-m", "lavender_cli.main", "replay", str(directory), "--live"]
            command += ["--copy", str(copy)]
            begun.append(subprocess.Popen([sys.executable, *command], start_new_session=True))

        try:
            yield begin, copy
        finally:
            for process in begun:
                with suppress(subprocess.TimeoutExpired):
                    process.wait(PATIENCE)
