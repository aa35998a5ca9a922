"""Where things are drawn: planes by their upper face, and the room that bodies take."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from recordings import column, read

from lavendersim import replay
from lavendersim.replay import scene
from tests.oracle.cells import cell

ROOM = scene.Extent(np.array([-1.0, -1.0, 0.0]), np.array([1.0, 1.0, 1.0]))
SLOPE = [-0.5, 0.0, np.sqrt(0.75)]


def plane(normal, offset=0.0):
    body = {"shape": {"kind": "plane", "normal": normal, "offset": offset}}
    return scene.shapes(cell({"scene": {"bodies": {"plane": body}}}))[0]


def test_normal_is_normalised():
    assert np.linalg.norm(plane([0, 3, 4]).normal) == pytest.approx(1.0, rel=1e-15)


def test_extent_holds_every_sphere_over_the_whole_trace(one_ball):
    room = scene.extent(one_ball, scene.shapes(one_ball.config))
    height = one_ball.pose[:, 1, 2]
    assert room.low.tolist() == [-0.1, -0.1, height.min() - 0.1]
    assert room.high.tolist() == [0.1, 0.1, height.max() + 0.1]


def test_what_goes_round_a_periodic_cell_is_shown_within_it(one_ball):
    """Heights of the ball in a cell of 1/8 m, whichever way it goes through that."""
    periodic = SimpleNamespace(x=None, y=None, z=(0.25, 0.375))
    shown = SimpleNamespace(
        bodies=one_ball.bodies,
        recorded_pose=one_ball.recorded_pose,
        config=SimpleNamespace(scene=SimpleNamespace(periodic=periodic)),
    )
    assert np.ptp(one_ball.pose[:, 1, 2]) > 0.125
    room = scene.extent(shown, scene.shapes(one_ball.config))
    assert room.low[2] <= 0.25
    assert room.high[2] >= 0.375
    assert room.low[2] >= 0.25 - 0.1
    assert room.high[2] < 0.375 + 0.1


def test_a_periodic_cell_is_drawn_by_its_edges(one_ball, tmp_path):
    """From end to end along y, along x and z as far as the room."""
    one_ball.resolved["scene"]["periodic"] = {"x": None, "y": [-0.5, 1.5], "z": None}
    replay.save(one_ball, tmp_path / "trace.rrd")
    (strips,) = column(read(tmp_path / "trace.rrd")[1]["/cell"], "LineStrips3D:strips")
    room = scene.extent(one_ball, scene.shapes(one_ball.config))
    assert [room.low[1], room.high[1]] == [-0.5, 1.5]
    assert np.shape(strips) == (12, 2, 3)
    ends = np.reshape(strips, (24, 3))
    # rerun has places in single precision
    np.testing.assert_allclose([ends.min(axis=0), ends.max(axis=0)], room[:2], rtol=1e-6)


def test_a_scene_that_is_not_periodic_has_no_cell(one_ball, tmp_path):
    replay.save(one_ball, tmp_path / "trace.rrd")
    assert "/cell" not in read(tmp_path / "trace.rrd")[1]


def test_scene_of_planes_alone_has_an_extent(one_ball):
    assert scene.extent(one_ball, [plane([0, 0, 1])]).diagonal > 0
