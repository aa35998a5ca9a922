"""The command line, run as a user runs it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path


def lavender(
    *arguments: object, where: Path, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run the command line in `where`, in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "lavender_cli.main", *map(str, arguments)],
        cwd=where,
        capture_output=True,
        text=True,
        env=os.environ | {"NO_COLOR": "1"} | environment,
        check=False,
    )
