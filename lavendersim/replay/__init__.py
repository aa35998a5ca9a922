"""Replay of a log in rerun: a viewer, an .rrd file or a picture of the viewer.

The only package that knows rerun. Rerun takes 0.4 s to import, so it is imported when something
is shown, not when this package is. Nothing is computed here that the log does not hold: replay
scales, colours and places what was recorded.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from lavendersim.replay.viewpoint import DEFAULT_VIEW, Viewpoint

if TYPE_CHECKING:
    from lavendersim.replay.pair import LogPair
    from lavendersim.trace import Trace

__all__ = ["Viewpoint", "follow", "open_viewer", "pair_of", "save", "screenshot", "video"]


def pair_of(a: Trace, b: Trace, names: tuple[str, str], overlay: bool = False) -> LogPair:
    """Two logs to be shown together, side by side or the second as a ghost over the first."""
    from lavendersim.replay.pair import LogPair

    return LogPair(a, b, *names, overlay=overlay)


def open_viewer(
    trace: Trace | LogPair,
    title: str | None = None,
    at: float | None = None,
    viewpoint: Viewpoint = DEFAULT_VIEW,
) -> None:
    """Show `trace` in a rerun window, which stays open after this process ends.

    A viewer that is already open is used. `title` names the recording; by default the log's name.
    at: time [s] at which it stands still, instead of playing.
    Raises MissingDriverError where there is no display to open a window on, UsageError for a time
    that the log does not reach.
    """
    from lavendersim.replay.viewer import show_in_window

    show_in_window(trace, title or Path(trace.path).stem, at, viewpoint)


def follow(
    path: Path,
    is_written: Callable[[], bool],
    title: str | None = None,
    viewpoint: Viewpoint = DEFAULT_VIEW,
    *,
    save_to: Path | None = None,
    copy: Path | None = None,
) -> None:
    """Show a log in a rerun window as it grows, until it is whole or nobody writes it any more.

    is_written: whether somebody may write more. save_to: writes a recording (.rrd) in place of the
    window. copy: of the log, written with every block of steps; the log itself comes in chunks.
    Raises MissingDriverError where there is no display to open a window on, TraceError where
    nothing whole was ever written.
    """
    from lavendersim.replay.live import follow_file

    follow_file(path, is_written, title or Path(path).stem, viewpoint, save_to, copy)


def save(
    trace: Trace | LogPair,
    path: str | Path,
    title: str | None = None,
    viewpoint: Viewpoint = DEFAULT_VIEW,
) -> None:
    """Write `trace` with its blueprint to `path` (.rrd), whole or not at all."""
    from lavendersim.replay.recording import write_rrd

    write_rrd(trace, Path(path), title or Path(trace.path).stem, viewpoint)


def screenshot(
    trace: Trace | LogPair,
    path: str | Path,
    title: str | None = None,
    at: float | None = None,
    viewpoint: Viewpoint = DEFAULT_VIEW,
) -> list[str]:
    """Write a picture (.png) of the viewer; needs no display.

    at: the time [s] it shows; by default that of the trace's last loaded contact.
    Returns what the viewer complained about, one sentence each; empty when all is well.
    Raises MissingDriverError where no Vulkan driver is installed.
    """
    from lavendersim.replay.headless import take_screenshot

    return take_screenshot(trace, Path(path), title or Path(trace.path).stem, at, viewpoint)


def video(
    trace: Trace | LogPair,
    path: str | Path,
    title: str | None = None,
    viewpoint: Viewpoint = DEFAULT_VIEW,
) -> Path:
    """Write a film (.mp4) of the viewer; needs no display.

    Returns its path or, where ffmpeg is not installed, the new folder of its frames beside it.
    Raises MissingDriverError where no Vulkan driver is installed, UsageError where that folder
    is there already.
    """
    from lavendersim.replay.film import write_film

    return write_film(trace, Path(path), title or Path(trace.path).stem, viewpoint)
