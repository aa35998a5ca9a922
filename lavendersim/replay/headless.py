"""A picture of rerun's viewer, drawn without a display.

The viewer runs as a child process in its headless mode, opens the recording from a file and is
steered over its local port. Every wait is bounded and the child is ended whatever happens.
"""

from __future__ import annotations

import os
import socket
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from rerun.experimental import ViewerClient

from lavendersim.durable_files import write_whole
from lavendersim.errors import LavenderError, MissingDriverError
from lavendersim.replay.drivers import (
    NO_DRIVER,
    VIEWER_HAS_NO_DRIVER,
    require_vulkan,
    viewer_program,
)
from lavendersim.replay.recording import moment_to_show, write_rrd
from lavendersim.replay.timeline import TIMELINE
from lavendersim.replay.viewpoint import DEFAULT_VIEW, Viewpoint

if TYPE_CHECKING:
    from rerun.experimental import ViewerState

    from lavendersim.replay.pair import LogPair
    from lavendersim.trace import Trace

Answer = TypeVar("Answer")

WINDOW = "1600x1000"  # points; wide enough for the plots' tick labels beside the scene
START_SECONDS = 60.0  # a software rasteriser on two busy cores starts in 1-5 s
STOP_SECONDS = 5.0
POLL_SECONDS = 0.1
NOTICE_SECONDS = 4.5  # for 4 s after the start the viewer's notices lie over the plots

# Expected wherever there is no graphics card; the picture is the same, only slower.
HARMLESS = ("Software rasterizer detected",)


def take_screenshot(
    trace: Trace | LogPair,
    path: Path,
    title: str,
    at: float | None = None,
    viewpoint: Viewpoint = DEFAULT_VIEW,
) -> list[str]:
    """Write the picture to `path`; return the viewer's complaints."""
    moment = moment_to_show(trace, at)
    with _loaded_viewer(trace, title, viewpoint) as viewer:
        picture, complaints = viewer.ask(lambda client: _shoot(client, moment))
    write_whole(path, picture)
    return complaints


def pictures(
    trace: Trace | LogPair,
    title: str,
    viewpoint: Viewpoint,
    moments: Sequence[np.timedelta64],
) -> Iterator[bytes]:
    """Yield a picture (.png) of the viewer at each of these moments."""
    with _loaded_viewer(trace, title, viewpoint) as viewer:
        viewer.ask(lambda client: _settle(client, moments[0]))
        for moment in moments:
            yield viewer.ask(partial(_shoot_next, moment=moment))


@contextmanager
def _loaded_viewer(trace: Trace | LogPair, title: str, viewpoint: Viewpoint) -> Iterator[_Viewer]:
    """A headless viewer that has loaded a recording."""
    require_vulkan()
    program = viewer_program()
    with tempfile.TemporaryDirectory(prefix="lavender-replay-") as folder:
        recording = Path(folder) / "recording.rrd"
        write_rrd(trace, recording, title, viewpoint)
        with _headless_viewer(program, recording, Path(folder) / "stderr.txt") as viewer:
            viewer.wait_for(_is_loaded, "load the recording")
            yield viewer


class _Viewer:
    """A running viewer: its process, its port and what it wrote to stderr."""

    def __init__(self, process: subprocess.Popen[bytes], port: int, log: Path) -> None:
        self._process = process
        self._url = f"rerun+http://127.0.0.1:{port}/proxy"
        self._log = log
        self._client: ViewerClient | None = None

    def wait_for(self, reached: Callable[[ViewerState], bool], what: str) -> None:
        """Poll until the viewer's state is as wished; raise when it ends or takes too long."""
        deadline = time.monotonic() + START_SECONDS
        while time.monotonic() < deadline:
            if self._process.poll() is not None:
                raise self._failure("ended unexpectedly")
            try:
                if self._client is None:
                    self._client = ViewerClient.connect(self._url)
                if reached(self._client.get_state()):
                    return
            except (ConnectionError, RuntimeError):
                self._client = None  # not listening yet
            time.sleep(POLL_SECONDS)
        raise self._failure(f"did not {what} within {START_SECONDS:.0f} s")

    def ask(self, question: Callable[[ViewerClient], Answer]) -> Answer:
        """Ask the connected viewer; it answers within 15 s or the client raises."""
        assert self._client is not None
        try:
            return question(self._client)
        except (ConnectionError, RuntimeError) as error:
            raise self._failure(f"did not answer ({error})") from error

    def _failure(self, what: str) -> LavenderError:
        output = self._log.read_text(encoding="utf-8", errors="replace")
        if any(sign in output for sign in VIEWER_HAS_NO_DRIVER):
            return MissingDriverError(NO_DRIVER)
        lines = [line for line in output.splitlines() if "panicked" in line or "ERROR" in line]
        return LavenderError("; it reported: ".join([f"rerun's viewer {what}", *lines[:1]]))


@contextmanager
def _headless_viewer(program: Path, recording: Path, log: Path) -> Iterator[_Viewer]:
    port = _free_port()
    command = [str(program), str(recording), "--headless", "--hide-welcome-screen"]
    command += ["--bind", "127.0.0.1", "--port", str(port), "--window-size", WINDOW]
    with log.open("wb") as stderr:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=stderr,
            stderr=stderr,
            # RERUN_APP_ONLY as the SDK sets it: no questions about analytics. TMPDIR because an
            # ended viewer leaves its scratch folder behind.
            env=os.environ | {"RERUN_APP_ONLY": "true", "TMPDIR": str(log.parent)},
        )
        try:
            yield _Viewer(process, port, log)
        finally:
            _end(process)


def _end(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(STOP_SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def _is_loaded(state: ViewerState) -> bool:
    timelines = [timeline for recording in state.recordings for timeline in recording.timelines]
    loaded = any(timeline.name == TIMELINE for timeline in timelines)
    return loaded and not state.loading and bool(state.views)


def _settle(client: ViewerClient, moment: np.timedelta64) -> None:
    time.sleep(NOTICE_SECONDS)  # it plays meanwhile; while paused the notices would stay
    client.set_time(TIMELINE, duration=moment, play_state="paused")
    client.take_screenshot()  # the first paint after a jump still sizes plots and fetches chunks


def _shoot_next(client: ViewerClient, moment: np.timedelta64) -> bytes:
    client.set_time(TIMELINE, duration=moment, play_state="paused")
    return client.take_screenshot()


def _shoot(client: ViewerClient, moment: np.timedelta64) -> tuple[bytes, list[str]]:
    _settle(client, moment)
    picture = client.take_screenshot()
    reports = [
        f"{report.severity} in view «{view.name}»: {report.summary}"
        for view in client.get_state().views
        for report in view.reports
    ]
    logged = [
        f"{entry.level.lower()} from {entry.target}: {entry.message}"
        for entry in client.get_logs()
        if entry.level in ("WARN", "ERROR") and not entry.message.startswith(HARMLESS)
    ]
    return picture, reports + logged
