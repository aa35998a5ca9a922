"""An open viewer is put to a moment once it has the recording up to there."""

from __future__ import annotations

import os
import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lavendersim import replay
from lavendersim.errors import LavenderError
from lavendersim.replay import drivers, headless, viewer
from lavendersim.replay.recording import moment_to_show, new_stream, record
from lavendersim.replay.timeline import TIMELINE

HAS_DRIVER = sys.platform != "linux" or any(drivers.driver_files(os.environ))
needs_driver = pytest.mark.skipif(
    not HAS_DRIVER, reason="no Vulkan driver here (Debian, Ubuntu: mesa-vulkan-drivers)"
)


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


class Client:
    """A viewer that has some of a recording at each question, and notes where it is put."""

    def __init__(self, *ends: int | None) -> None:
        self.ends, self.put = list(ends), []

    def get_state(self) -> Any:
        end = self.ends.pop(0)
        lines = [SimpleNamespace(name=TIMELINE, end=end), SimpleNamespace(name="log", end=10**12)]
        other = SimpleNamespace(
            store_id="another", timelines=[SimpleNamespace(name=TIMELINE, end=10**12)]
        )
        return SimpleNamespace(
            recordings=[other, SimpleNamespace(store_id="store of mine", timelines=lines)]
        )

    def set_time(self, timeline: str, **given: Any) -> None:
        self.put.append((timeline, given))


def test_the_cursor_is_put_there_once_the_recording_has_come_so_far(monkeypatch):
    client = Client(None, 100, 499, 500)
    monkeypatch.setattr(viewer, "POLL_SECONDS", 0.0)
    monkeypatch.setattr(viewer.ViewerClient, "connect", lambda url: client)
    viewer.stop_at(np.timedelta64(500, "ns"), "mine")
    assert client.ends == []
    ((timeline, given),) = client.put
    assert timeline == TIMELINE
    assert given["duration"] == np.timedelta64(500, "ns")
    assert (given["play_state"], given["recording"]) == ("paused", "store of mine")


def test_a_viewer_that_is_not_open_yet_is_asked_again(monkeypatch):
    client, refusals = Client(9), [ConnectionError(), RuntimeError()]

    def connect(url: str) -> Client:
        if refusals:
            raise refusals.pop()
        return client

    monkeypatch.setattr(viewer, "POLL_SECONDS", 0.0)
    monkeypatch.setattr(viewer.ViewerClient, "connect", connect)
    viewer.stop_at(np.timedelta64(9, "ns"), "mine")
    assert len(client.put) == 1
