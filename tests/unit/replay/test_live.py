"""A log that grows is shown as its finished log is, row by row, whatever was whole when."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from recordings import column, read, times

from lavendersim import replay
from lavendersim.errors import TraceError
from lavendersim.replay import columns, live
from lavendersim.replay.recording import new_stream
from lavendersim.runner import call_length, run
from lavendersim.runner.progress import Progress
from lavendersim.trace import TraceWriter, open_trace

# A ball that falls 5 m and bounces: room and forces grow while it is shown.
THROWN = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 5], velocity: [3, 0, 0],
           surface: {restitution: 0.8}}
numerics: {preset: chapter, timestep: 1/2000}
duration: 4.0
"""


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("grown")
    config = folder / "thrown.yaml"
    config.write_text(THROWN)
    return run(config, folder / "runs").run.cells[0].path


def looks(whole, folder, shares):
    """Return what is whole of a log when so much of it was written, one after the other."""
    data = whole.read_bytes()
    for number, share in enumerate(shares):
        path = folder / f"{number}.mcap"
        path.write_bytes(data[: int(share * len(data))])
        try:
            yield open_trace(path, allow_incomplete=True)
        except TraceError:
            yield None


def followed(whole, folder, shares, monkeypatch):
    """Follow a log that has grown to these shares; returns columns by entity, and rows sent."""
    each, rests, sent = looks(whole, folder, shares), [], []
    send = columns.send

    def noted(stream, trace, room, scale, since=0):
        sent.append((since, len(trace.step)))
        send(stream, trace, room, scale, since)

    monkeypatch.setattr(columns, "send", noted)
    stream = new_stream("grown")
    stream.save(folder / "live.rrd")
    log = live.GrowingLog(lambda: next(each), lambda: len(rests) + 1 < len(shares))
    last = live.follow(log, stream, "grown", rest=rests.append)
    stream.flush()
    stream.disconnect()
    assert len(rests) == len(shares) - 1
    assert all(rest >= live.PAUSE for rest in rests)
    return last, read(folder / "live.rrd")[0], sent


def places(moving):
    """Return where the ball is by time: what was sent last counts."""
    batches = moving["/bodies/ball"]
    found = zip(times(batches), column(batches, "Transform3D:translation"), strict=True)
    return {int(time): place[0] for time, place in found}


def test_every_row_is_shown_as_of_the_finished_log(whole, tmp_path, monkeypatch):
    shares = (0.001, 0.3, 0.5, 0.55, 0.8, 1.0)
    last, moving, sent = followed(whole, tmp_path, shares, monkeypatch)
    assert not last.damage
    replay.save(open_trace(whole), tmp_path / "whole.rrd")
    assert places(moving) == places(read(tmp_path / "whole.rrd")[0])
    assert len(places(moving)) == len(open_trace(whole).step)
    # Some looks found new rows alone, and no row was left out between two of them.
    assert any(since > 0 for since, _ in sent)
    for (_, before), (since, _) in pairwise(sent):
        assert since in (0, before)


def test_what_is_cut_is_shown_up_to_its_end(whole, tmp_path, monkeypatch):
    last, moving, _ = followed(whole, tmp_path, (0.2, 0.6), monkeypatch)
    assert last.damage
    known = open_trace(whole).step["time_ns"][: len(last.step)]
    assert np.array_equal(sorted(places(moving)), known)


def test_a_log_that_never_began_is_a_sentence(tmp_path):
    with pytest.raises(TraceError, match=r"none\.mcap: nothing was written that could be shown"):
        live.follow_file(
            tmp_path / "none.mcap", lambda: False, "none", live.DEFAULT_VIEW, tmp_path / "a.rrd"
        )
    assert not (tmp_path / "a.rrd").exists()


def test_a_whole_log_is_shown_once(whole, tmp_path):
    live.follow_file(whole, lambda: True, "whole", live.DEFAULT_VIEW, tmp_path / "a.rrd")
    rows = sum(batch.num_rows for batch in read(tmp_path / "a.rrd")[0]["/bodies/ball"])
    assert rows == len(open_trace(whole).step)


def test_the_copy_of_a_log_is_readable_as_it_is_written(whole, tmp_path, monkeypatch):
    """The log of this run has all its steps in chunks that close as it ends."""
    copy, read_along = tmp_path / "copy.mcap", []
    write_out = TraceWriter.write_out

    def noted(writer):
        write_out(writer)
        (log,) = tmp_path.glob("runs/*/cells/*.mcap")
        of_log = live._whole_of(log)
        read_along.append((len(live._whole_of(copy).step), len(of_log.step) if of_log else 0))

    monkeypatch.setattr(TraceWriter, "write_out", noted)
    monkeypatch.setattr(call_length, "MOST", 2048)  # the run is looked at more than once
    config = tmp_path / "thrown.yaml"
    config.write_text(THROWN)
    (cell,) = run(config, tmp_path / "runs", 1, Progress(copy=copy)).run.cells
    assert cell.path.read_bytes() == whole.read_bytes()
    copied, rows = open_trace(copy, allow_incomplete=True), open_trace(whole)
    for name in ("step", "contact", "pose"):
        assert np.array_equal(getattr(copied, name), getattr(rows, name))
    steps = [copied for copied, _ in read_along]
    assert steps == sorted(set(steps))
    assert steps[-1] == len(rows.step)
    assert len(steps) > 2
    assert all(of_log < copied for copied, of_log in read_along)
