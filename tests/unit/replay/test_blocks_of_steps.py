"""Steps are sent in blocks, all of them once and in order."""

from __future__ import annotations

import numpy as np
import pytest
import rerun as rr
from recordings import column, read, times

from lavendersim.replay.blocks import STEPS_PER_BLOCK, blocks, send_columns


@pytest.mark.parametrize("rows", [0, 1, STEPS_PER_BLOCK, 2 * STEPS_PER_BLOCK + 1])
def test_blocks_have_every_row_once_and_in_order(rows):
    found = [row for block in blocks(rows) for row in range(rows)[block]]
    assert found == [*range(rows)]
    assert len([*blocks(rows)]) == -(-rows // STEPS_PER_BLOCK)


def test_columns_stand_at_their_times(tmp_path):
    stream = rr.RecordingStream("blocks")
    stream.save(tmp_path / "blocks.rrd")
    moments = np.array([0, 5, 7], "timedelta64[ns]")
    send_columns(stream, "curve", moments, rr.Scalars.columns(scalars=[1.0, 2.0, 4.0]))
    stream.flush()
    stream.disconnect()
    moving, _ = read(tmp_path / "blocks.rrd")
    assert times(moving["/curve"]).tolist() == [0, 5, 7]
    assert column(moving["/curve"], "Scalars:scalars") == [[1.0], [2.0], [4.0]]
