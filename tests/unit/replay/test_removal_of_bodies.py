"""Removed bodies vanish with the first state without them, and with all that is drawn of them."""

from __future__ import annotations

from typing import Any

import pytest
import rerun as rr
from recordings import column, read, times

from lavendersim import replay
from lavendersim.replay.layer import Layer
from lavendersim.replay.removal import clear_removed, removed


@pytest.mark.parametrize("at", [1.0, 0.9999, 9.0])
def test_a_removed_body_vanishes_with_the_first_state_without_it(two_bodies, tmp_path, at):
    two_bodies.resolved["events"] = [{"at": at, "body": "box", "remove": True}]
    replay.save(two_bodies, tmp_path / "trace.rrd")
    moving, static = read(tmp_path / "trace.rrd")
    box = moving["/bodies/box"]
    cleared = [batch for batch in box if "Clear:is_recursive" in batch.schema.names]
    if at == 9.0:  # the log ends before: drawn as everything that stays
        assert "/bodies/box" in static
        assert not cleared
        return
    assert "/bodies/box" not in static
    drawn = [batch for batch in box if "Boxes3D:half_sizes" in batch.schema.names]
    assert times(drawn).tolist() == [0]
    assert times(cleared).tolist() == [two_bodies.step["time_ns"][241]]
    assert column(cleared, "Clear:is_recursive") == [[True]]
    assert "/bodies/ball" in static


class Noted:
    """A stream that notes what is logged at which time."""

    def __init__(self) -> None:
        self.time: Any = None
        self.logged: list[tuple[int, str, Any]] = []

    def set_time(self, timeline: str, duration: Any) -> None:
        self.time = int(duration.astype("int64"))

    def reset_time(self) -> None:
        self.time = None

    def log(self, entity: str, archetype: Any) -> None:
        self.logged.append((self.time, entity, archetype))


def test_every_folder_is_cleared_at_the_time_of_the_row_under_the_name_of_the_log(two_bodies):
    """Events act on the step that begins then: 0.5 s is state 120, gone is it in state 121."""
    two_bodies.resolved["events"] = [{"at": 0.5, "body": "box", "remove": True}]
    assert removed(two_bodies) == {"box": 121}
    stream: Any = Noted()
    clear_removed(stream, two_bodies, two_bodies.step["time_ns"], ["bodies", "paths"], Layer("a"))
    moment = int(two_bodies.step["time_ns"][121])
    assert [entry[:2] for entry in stream.logged] == [
        (moment, "/a/bodies/box"),
        (moment, "/a/paths/box"),
    ]
    assert all(isinstance(entry[2], rr.Clear) for entry in stream.logged)
    assert stream.time is None


def test_nothing_is_removed_where_the_log_ends_before(two_bodies):
    two_bodies.resolved["events"] = [{"at": 99.0, "body": "box", "remove": True}]
    assert removed(two_bodies) == {}
