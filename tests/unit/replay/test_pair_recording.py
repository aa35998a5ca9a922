"""What a saved recording of two logs holds: both, on one timeline, and their distances."""

from __future__ import annotations

import os
import sys
from dataclasses import replace

import numpy as np
import pytest
from rerun.chunk import RrdReader
from synthetic_trace import ball_and_box

from lavendersim import replay
from lavendersim.replay import drivers

HAS_DRIVER = sys.platform != "linux" or any(drivers.driver_files(os.environ))


@pytest.fixture
def other():
    trace = ball_and_box()
    pose = trace.pose.copy()
    pose[:, trace.bodies.index("ball"), 1] += 0.25
    return replace(trace, pose=pose)


def saved(pair, path):
    """The entities of a recording, and their rows by column."""
    replay.save(pair, path)
    rows = {}
    for chunk in RrdReader(path).stream():
        batch = chunk.to_record_batch()
        entity = rows.setdefault(chunk.entity_path, {})
        for name in set(batch.schema.names) - {"sim_time"}:
            entity.setdefault(name, []).extend(batch.column(name).to_pylist())
    return rows


def test_both_logs_have_their_bodies_poses_and_forces(two_bodies, other, tmp_path):
    pair = replay.pair_of(two_bodies, other, ("one", "two"))
    rows = saved(pair, tmp_path / "pair.rrd")
    for layer, trace in (("A", two_bodies), ("B", other)):
        ball = rows[f"/{layer}/bodies/ball"]
        placed = np.array([row[0] for row in ball["Transform3D:translation"] if row])
        expected = trace.pose[:, trace.bodies.index("ball"), :3]
        np.testing.assert_allclose(placed, expected, rtol=1e-6, atol=1e-6)  # rerun has float32
        assert {row[0] for row in ball["Transform3D:child_frame"] if row} == {f"{layer}:ball"}
        assert f"/{layer}/contacts/forces" in rows
        assert f"/{layer}/grid/floor" in rows


def test_distances_are_a_curve_of_each_body(two_bodies, other, tmp_path):
    rows = saved(replay.pair_of(two_bodies, other, ("one", "two")), tmp_path / "pair.rrd")
    ball = [row[0] for row in rows["/plot/distance/ball"]["Scalars:scalars"] if row]
    assert ball == [250.0] * len(two_bodies.step)  # mm
    box = [row[0] for row in rows["/plot/log10_distance/box"]["Scalars:scalars"] if row]
    assert box == []  # it is nowhere apart, of which there is no logarithm


def test_of_a_ghost_movable_bodies_alone_are_drawn(two_bodies, other, tmp_path):
    pair = replay.pair_of(two_bodies, other, ("one", "two"), overlay=True)
    rows = saved(pair, tmp_path / "pair.rrd")
    ghost = {path.split("/")[2] for path in rows if path.startswith("/B/")}
    assert ghost == {"bodies", "paths"}
    assert "Boxes3D:labels" in rows["/B/bodies/box"]
    assert "/B/grid/floor" not in rows
    assert "/A/contacts/forces" in rows


@pytest.mark.skipif(not HAS_DRIVER, reason="no Vulkan driver here (mesa-vulkan-drivers)")
@pytest.mark.parametrize("overlay", [False, True])
def test_the_viewer_shows_both_without_a_complaint(overlay, two_bodies, other, tmp_path):
    pair = replay.pair_of(two_bodies, other, ("one", "two"), overlay)
    assert replay.screenshot(pair, tmp_path / "pair.png") == []
