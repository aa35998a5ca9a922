"""Columns leave in blocks of 100 to 200 steps, counted at a recording that only counts."""

from __future__ import annotations

from collections import defaultdict

import pytest
from synthetic_trace import single_ball

from lavendersim.replay import columns, scene
from lavendersim.replay.force_scale import force_scale


class CountingStream:
    def __init__(self):
        self.rows = defaultdict(list)

    def log(self, *_args, **_options):
        pass

    def send_columns(self, path, indexes, columns, **_options):
        lengths = {len(index.as_arrow_array()) for index in indexes}
        lengths |= {len(column.as_arrow_array()) for column in columns}
        assert len(lengths) == 1
        self.rows[path.lstrip("/")] += lengths


@pytest.mark.parametrize("steps", [0, 99, 199, 200, 480, 1000])
def test_blocks_have_100_to_200_steps_except_the_last(steps):
    trace, stream = single_ball(steps), CountingStream()
    room = scene.extent(trace, scene.shapes(trace.config))
    columns.send(stream, trace, room, force_scale(trace.contact, room.diagonal))
    assert set(stream.rows) == {
        "bodies/ball",
        "contacts/forces",
        "contacts/points",
        "plot/force",
        "plot/depth",
        "plot/residual",
    }
    for sizes in stream.rows.values():
        assert sum(sizes) == len(trace.step)
        assert all(100 <= size <= 200 for size in sizes[:-1])
        assert sizes[-1] <= 200
