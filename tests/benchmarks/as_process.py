"""A benchmark, run as its docstring says."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def benchmark(name: str, *options: str) -> subprocess.CompletedProcess[str]:
    """Run `python -m tests.benchmarks.NAME` with options, in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", f"tests.benchmarks.{name}", *options],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
