"""Configs small enough to run in a test, and a Python of its own to run them in."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import lavendersim
from tests.drop_config import LOW
from tests.forked_python import LATE
from tests.forked_python import python as forked_python

DROPS = (
    """\
question: How high does a small ball rebound?
expected: e^2 h
"""
    + LOW
    + """\
duration: 0.5
sweep:
  e: {path: scene.bodies.ball.surface.restitution, values: [0.2, 0.5, 0.8]}
measure:
  rebound: {kind: first_apex, body: ball, above: floor}
expect:
  - {name: rebound, measure: rebound, increasing: {along: e}}
figure:
  caption: Rebound by restitution.
  panels:
    - kind: measure_against_axis
      measure: rebound
      axis: e
      title: rebound
      x_label: restitution e [-]
      y_label: rebound height [m]
"""
)

# Prints, as the last line, what a fresh process makes of a config: argv is config, root.
RUN = """
import json, sys, warnings
from hashlib import sha256
from pathlib import Path
warnings.simplefilter("error", UserWarning)
import lavendersim
from lavendersim.engine.sources import source_hash
from lavendersim.engine.kernel_store import directory
finished = lavendersim.run(Path(sys.argv[1]), root=Path(sys.argv[2]))
print(json.dumps({
    "package": lavendersim.__file__,
    "run": str(finished.run.path),
    "statuses": [outcome.status for outcome in finished.outcomes],
    "logs": [sha256(cell.path.read_bytes()).hexdigest() for cell in finished.run.cells],
    "hashes": [int(cell.trace().step["state_hash"][-1]) for cell in finished.run.cells],
    "heights": [float(cell.trace().pose[-1, 1, 2]) for cell in finished.run.cells],
    "contacts": [len(cell.trace().contact) for cell in finished.run.cells],
    "cache": [str(directory()[0]), directory()[1]],
    "source": source_hash(),
}))
"""


def write(folder: Path, text: str = DROPS, name: str = "drops.yaml") -> Path:
    """Write a config into a folder and return its path."""
    path = folder / name
    path.write_text(text)
    return path


def copy_package(folder: Path) -> Path:
    """Copy lavender's sources into a folder, to be edited there; returns the engine's.

    With their bytecode, but for what others are writing: an edited file is younger than its own.
    """
    package = folder / "lavendersim"
    skipped = shutil.ignore_patterns("*.pyc.*")
    shutil.copytree(Path(lavendersim.__file__).parent, package, ignore=skipped)
    return package / "engine"


def python(code: str, *arguments: Any, **environment: str) -> str:
    """Run code in a new Python process and return its last line of output.

    Without the working directory on its path, so that PYTHONPATH says which package is run.
    """
    done = subprocess.run(
        [sys.executable, "-P", "-c", code, *map(str, arguments)],
        env=os.environ | environment,
        capture_output=True,
        text=True,
        timeout=600,  # where no kernel is kept, two plans take a minute each to compile
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip().splitlines()[-1]


def run_in_new_process(config: Path, root: Path, **environment: str) -> dict[str, Any]:
    """Run a config in a new Python process and return what `RUN` prints of it.

    With another package, or other settings of numba, the process imports all anew.
    """
    new = python_forked if environment.keys() <= {*LATE} else python
    found: dict[str, Any] = json.loads(new(RUN, config, root, **environment))
    return found


def python_forked(code: str, *arguments: Any, **environment: str) -> str:
    """Do as `python` does, in a process that has imported lavender already."""
    done = forked_python("-c", code, *arguments, **environment)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip().splitlines()[-1]
