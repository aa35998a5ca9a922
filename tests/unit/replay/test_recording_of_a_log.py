"""A log as the trace room writes and reads it can be replayed: the two rooms agree."""

from __future__ import annotations

import numpy as np
import pytest
from rerun.chunk import RrdReader

from lavendersim import replay
from lavendersim.trace import Block, TraceWriter, open_trace
from tests.made_cells import made_cell


@pytest.mark.parametrize("contacts", [True, False])
def test_log_of_the_trace_room_is_replayed(one_ball, tmp_path, contacts):
    contact = one_ball.contact if contacts else one_ball.contact[:0]
    names = [name for name in one_ball.step.dtype.names if name != "time"]
    log = tmp_path / "log.mcap"
    writer = TraceWriter(log, made_cell(one_ball.resolved["scene"]["bodies"]), "question: ?\n", {})
    sweeps = np.zeros(0, [("step", "i8"), ("sweep", "i8"), ("residual", "f8")])
    writer.append(
        Block(step=one_ball.step[names], contact=contact, pose=one_ball.pose, residual=sweeps)
    )
    writer.close("complete")
    replay.save(open_trace(log), tmp_path / "log.rrd")
    rows = {}
    for chunk in RrdReader(tmp_path / "log.rrd").stream():
        if not chunk.is_static:
            rows[chunk.entity_path] = rows.get(chunk.entity_path, 0) + chunk.num_rows
    assert rows["/bodies/ball"] == rows["/contacts/forces"] == len(one_ball.step)
