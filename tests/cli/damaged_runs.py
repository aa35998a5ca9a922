"""Finished runs whose logs are then damaged, and the verbs that read them, in this process."""

from __future__ import annotations

import contextlib
import io
import shutil
import signal
import sys
from pathlib import Path
from typing import Any, NamedTuple
from unittest import mock

from lavender_cli.main import main
from lavendersim import open_run
from lavendersim.trace import writer
from lavendersim.trace.encode import Streams
from tests.drop_config import DROP

FIGURE = """\
figure:
  caption: The ball falls and rebounds.
  panels:
    - kind: time_series
      column: residual
      series: e
      title: residual
      x_label: time [s]
      y_label: residual [m/s]
"""
SWEEP = """\
sweep:
  e: {path: scene.bodies.ball.surface.restitution, values: [0.5, 0.52]}
"""
# With these chunks long enough for three groups of steps, of which a damaged log may keep some.
KIB = 1024
CHUNK_BYTES = Streams(4096 * KIB, 1024 * KIB, 1024 * KIB, 128 * KIB)
DRAWN = DROP.replace("duration: 0.5\nmeasure:\n", f"duration: 4\n{SWEEP}measure:\n") + FIGURE


class Done(NamedTuple):
    """What became of a verb."""

    code: int
    stdout: str
    stderr: str


def verb(*arguments: object) -> Done:
    """Run the command line in this process, which takes milliseconds where a new one takes one s.

    Colours are off, and signals are left alone.
    """
    out, err = io.StringIO(), io.StringIO()
    code: Any = 0
    with (
        mock.patch.object(sys, "argv", ["lavender", *map(str, arguments)]),
        mock.patch.object(signal, "signal"),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
    ):
        try:
            main()
        except SystemExit as end:
            code = end.code
    return Done(int(code or 0), out.getvalue(), err.getvalue())


def made(text: str, folder: Path) -> Path:
    """Run a config and draw its figure; returns the directory of the run."""
    config = folder / "drop.yaml"
    config.write_text(text)
    with mock.patch.object(writer, "CHUNK_BYTES", CHUNK_BYTES):
        done = verb("run", config, "--runs", folder / "runs", "--plot")
    assert done.code in (0, 1), done.stderr
    return open_run(None, folder / "runs").path


def copied(run: Path, folder: Path) -> Path:
    """Return a copy of a run, to be damaged."""
    return Path(shutil.copytree(run, folder / run.name))


def logs(run: Path) -> list[Path]:
    """Return the logs of a run, in no order that means anything."""
    return sorted((run / "cells").glob("*.mcap"))


def cut(log: Path, share: float) -> None:
    """Leave of a log a share of its bytes."""
    data = log.read_bytes()
    log.write_bytes(data[: int(share * len(data))])


def flip(log: Path, position: int, bit: int = 0) -> None:
    """Change one bit of a log."""
    data = bytearray(log.read_bytes())
    data[position] ^= 1 << bit
    log.write_bytes(data)
