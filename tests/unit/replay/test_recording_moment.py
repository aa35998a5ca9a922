"""`--at`: the time a replay stands still at."""

from __future__ import annotations

import os
import sys

import numpy as np
import pytest

from lavendersim import replay
from lavendersim.errors import LavenderError, UsageError
from lavendersim.replay import drivers, headless, viewer
from lavendersim.replay.recording import moment_to_show, new_stream, record
from lavendersim.replay.timeline import TIMELINE

HAS_DRIVER = sys.platform != "linux" or any(drivers.driver_files(os.environ))
needs_driver = pytest.mark.skipif(
    not HAS_DRIVER, reason="no Vulkan driver here (Debian, Ubuntu: mesa-vulkan-drivers)"
)


@pytest.mark.parametrize("at", [0.0, 0.5, 1.234, 1.9999, 2.0, 2.002])
def test_the_step_nearest_to_a_time_is_shown(two_bodies, at):
    # 240 Hz for 2 s; half a step more is still the last one's
    shown = int(moment_to_show(two_bodies, at).astype("int64")) * 1e-9
    assert abs(shown - min(at, 2.0)) <= 0.5 / 240 + 1e-9
    assert shown * 240 == pytest.approx(round(shown * 240), abs=1e-6)


@pytest.mark.parametrize("at", [-0.01, 2.01])
def test_a_time_outside_the_log_is_refused_with_its_ends(two_bodies, tmp_path, at):
    with pytest.raises(UsageError, match=r"this log goes from 0 to 2 s"):
        replay.screenshot(two_bodies, tmp_path / "never.png", at=at)
    assert list(tmp_path.iterdir()) == []


@needs_driver
def test_an_open_viewer_stops_at_the_moment(two_bodies, tmp_path):
    """The window's own way, with a viewer that needs no display."""
    other = tmp_path / "other.rrd"
    replay.save(two_bodies, other)
    moment = moment_to_show(two_bodies, 0.75)
    program, log = drivers.viewer_program(), tmp_path / "stderr.txt"
    with headless._headless_viewer(program, other, log) as opened:
        opened.wait_for(lambda state: bool(state.recordings), "start")
        stream = new_stream("a second recording")
        stream.connect_grpc(opened._url)
        record(two_bodies, stream, "a second recording")
        stream.flush(timeout_sec=60.0)
        recording = str(stream.get_recording_id())
        viewer.stop_at(moment, recording, opened._url)
        state = opened.ask(lambda client: client.get_state())
        stream.disconnect()
    (found,) = [one for one in state.recordings if recording in one.store_id]
    assert found.current_timeline == TIMELINE
    assert np.timedelta64(found.current_time, "ns") == moment


def test_a_viewer_that_never_listens_is_one_sentence(monkeypatch):
    monkeypatch.setattr(viewer, "LOADED_SECONDS", 0.3)
    port = headless._free_port()
    with pytest.raises(LavenderError, match="did not take the recording within"):
        viewer.stop_at(np.timedelta64(0, "ns"), "none", f"rerun+http://127.0.0.1:{port}/proxy")
