"""Columns leave in blocks of 100 to 200 steps, counted at a recording that only counts."""

from __future__ import annotations

from collections import defaultdict

import numpy as np
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


def test_arrows_are_thin_beside_small_bodies_and_in_the_whole_scene():
    """A ball of 0.1 m: its own share in a large room, the scene's in one of its own size."""
    trace = single_ball(2)
    large = scene.Extent(np.zeros(3), np.array([100.0, 0.0, 0.0]))
    small = scene.Extent(np.zeros(3), np.array([0.2, 0.0, 0.0]))
    thickness = [columns.arrow_thickness(trace, room) for room in (large, small)]
    assert thickness == pytest.approx(
        [columns.ARROW_OF_BODY * 0.1, columns.ARROW_OF_SCENE * 0.2], rel=1e-12
    )
