"""`lavender run --live`: a process of its own follows the log of the first cell."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

PATIENCE = 60.0  # [s] for it to show the last of a log


@contextmanager
def shown_live() -> Iterator[Callable[[Path], None]]:
    """Give what begins to show a run's first cell by its directory; waits until it is shown."""
    begun: list[subprocess.Popen[bytes]] = []

    def begin(directory: Path) -> None:
        command = ["-m", "lavender_cli.main", "replay", str(directory), "--live"]
        begun.append(subprocess.Popen([sys.executable, *command], start_new_session=True))

    try:
        yield begin
    finally:
        for process in begun:
            with suppress(subprocess.TimeoutExpired):
                process.wait(PATIENCE)
