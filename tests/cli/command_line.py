"""The command line, run as a user runs it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from tests.forked_python import python


def lavender(
    *arguments: object, where: Path, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run the command line in `where`, in a process of its own that had lavender imported."""
    words = ("-m", "lavender_cli.main", *arguments)
    return python(*words, where=where, **{"NO_COLOR": "1"} | environment)


def started_lavender(
    *arguments: object, where: Path, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run the command line in `where`, in an interpreter that starts with nothing imported."""
    return subprocess.run(
        [sys.executable, "-m", "lavender_cli.main", *map(str, arguments)],
        cwd=where,
        capture_output=True,
        text=True,
        env=os.environ | {"NO_COLOR": "1"} | environment,
        check=False,
    )
