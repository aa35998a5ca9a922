"""A film of rerun's viewer: a picture for each frame, joined by ffmpeg where it is installed."""

from __future__ import annotations

import math
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from lavendersim.durable_files import written_aside
from lavendersim.errors import LavenderError, UsageError
from lavendersim.replay import columns
from lavendersim.replay.blueprint import playback_speed
from lavendersim.replay.headless import pictures
from lavendersim.replay.pair import LogPair

if TYPE_CHECKING:
    from lavendersim.replay.viewpoint import Viewpoint
    from lavendersim.trace import Trace

FRAMES_PER_SECOND: Final = 25
FRAME: Final = "%05d.png"


def moments_of(times: npt.NDArray[np.int64], speed: float | None = None) -> list[np.timedelta64]:
    """Return the times of the steps that the frames show, each the nearest to its frame's.

    times [ns]: of all steps. speed: simulated seconds per second; by default that of the viewer.
    """
    seconds = float(times[-1] - times[0]) * 1e-9
    rate = playback_speed(seconds) if speed is None else speed
    count = math.ceil(seconds / rate * FRAMES_PER_SECOND) + 1  # the last step is shown
    due = times[0] + np.arange(count) * (rate * 1e9 / FRAMES_PER_SECOND)
    rows = np.searchsorted(0.5 * (times[1:] + times[:-1]), due)
    return [np.timedelta64(int(times[row]), "ns") for row in rows]


def write_film(trace: Trace | LogPair, path: Path, title: str, viewpoint: Viewpoint) -> Path:
    """Write the film to `path`, or its frames to a folder beside it; return what was written."""
    shown = trace.a if isinstance(trace, LogPair) else trace
    moments = moments_of(columns.time_in_nanoseconds(shown), viewpoint.speed)
    program = shutil.which("ffmpeg")
    frames = path.with_suffix(".frames")
    if program is None and frames.exists():
        raise UsageError(f"{frames}: is there already; frames go to a new folder")
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="lavender-film-", dir=path.parent) as scratch:
        folder = Path(scratch) / "frames"
        folder.mkdir()
        for number, picture in enumerate(pictures(trace, title, viewpoint, moments)):
            (folder / (FRAME % number)).write_bytes(picture)
        if program is None:
            folder.rename(frames)
            return frames
        with written_aside(path) as unfinished:
            _join(program, folder, Path(unfinished))
    return path


def _join(program: str, folder: Path, film: Path) -> None:
    command = [program, "-y", "-loglevel", "error", "-framerate", str(FRAMES_PER_SECOND)]
    command += ["-i", str(folder / FRAME), "-pix_fmt", "yuv420p", "-f", "mp4", str(film)]
    ended = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if ended.returncode:
        lines = ended.stderr.strip().splitlines() or [f"exit code {ended.returncode}"]
        raise LavenderError(f"{program} made no film: {lines[-1]}")
