"""What a saved .rrd holds, read back with rerun's own reader: the trace, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest
import rerun.blueprint as rrb
from recordings import column, read, times
from rerun.chunk import RrdReader

from lavendersim import replay
from lavendersim.replay import scene
from lavendersim.replay.blueprint import blueprint
from lavendersim.replay.camera import camera_of
from lavendersim.replay.columns import contacts_of
from lavendersim.replay.force_scale import force_scale
from lavendersim.replay.viewpoint import Viewpoint
from lavendersim.trace.absent import absent_table

# Rerun stores positions, vectors and quaternions as float32.
FLOAT32 = 2 * np.finfo(np.float32).eps


@pytest.fixture
def saved(two_bodies, tmp_path):
    replay.save(two_bodies, tmp_path / "out" / "trace.rrd")
    return read(tmp_path / "out" / "trace.rrd")


def test_every_body_is_an_entity_of_its_name(saved):
    moving, static = saved
    assert {"/bodies/ball", "/bodies/box", "/bodies/floor"} <= set(static)
    assert "/bodies/ball" in moving
    assert column(static["/bodies/ball"], "CoordinateFrame:frame") == [["ball"]]


def test_only_timeline_is_sim_time_in_the_logs_own_nanoseconds(saved, two_bodies):
    moving, _ = saved
    for batches in moving.values():
        indexes = [f.name for f in batches[0].schema if f.metadata[b"rerun:kind"] == b"index"]
        assert indexes == ["sim_time"]
    assert np.array_equal(times(moving["/bodies/ball"]), two_bodies.step["time_ns"])


def test_poses_equal_the_traces_at_every_step(saved, two_bodies):
    moving, _ = saved
    for body, name in ((1, "ball"), (2, "box")):
        batches = moving[f"/bodies/{name}"]
        rows = np.searchsorted(two_bodies.step["time_ns"], times(batches))
        pose = two_bodies.pose[rows, body]
        translation = np.array(column(batches, "Transform3D:translation"))[:, 0]
        np.testing.assert_allclose(translation, pose[:, :3], rtol=FLOAT32, atol=0)
        xyzw = np.array(column(batches, "Transform3D:quaternion"))[:, 0]
        np.testing.assert_allclose(xyzw, pose[:, [4, 5, 6, 3]], rtol=FLOAT32, atol=0)


def test_body_that_never_moves_is_sent_once(saved):
    moving, _ = saved
    assert len(times(moving["/bodies/box"])) == 1


def test_body_that_never_moves_keeps_its_pose_from_the_first_step(saved):
    moving, _ = saved
    assert times(moving["/bodies/box"])[0] == 0


def test_arrows_start_at_the_contacts_and_are_proportional_to_the_force(saved, two_bodies):
    moving, _ = saved
    batches = moving["/contacts/forces"]
    vectors, origins = column(batches, "Arrows3D:vectors"), column(batches, "Arrows3D:origins")
    colours = column(batches, "Arrows3D:colors")
    row = 3
    own = two_bodies.contact[two_bodies.contact["step"] == row]
    points = np.stack([own["x"], own["y"], own["z"]], axis=1)
    np.testing.assert_allclose(np.array(origins[row]), points, rtol=FLOAT32, atol=0)
    # four equal shares of the box's weight, straight up, none cut
    lengths = np.array(vectors[row])
    assert (lengths[:, :2] == 0).all()
    assert (lengths[:, 2] > 0.05).all()
    assert np.ptp(lengths[:, 2]) == 0
    assert len(set(colours[row])) == 1
    impact = int(np.argmax(two_bodies.step["total_normal_force"]))
    assert len(set(colours[impact])) == 2  # the impact's arrow is cut and says so


def test_step_without_contacts_clears_the_arrows_and_points(one_ball, tmp_path):
    replay.save(one_ball, tmp_path / "trace.rrd")
    moving, _ = read(tmp_path / "trace.rrd")
    counts = one_ball.step["contact_count"]
    assert (counts == 0).any()
    assert (counts > 0).any()
    arrows = column(moving["/contacts/forces"], "Arrows3D:vectors")
    points = column(moving["/contacts/points"], "Points3D:positions")
    # an empty list, not a missing row: rerun keeps the last value where nothing is sent
    assert [len(row) for row in arrows] == counts.tolist()
    assert [len(row) for row in points] == counts.tolist()


def test_plots_carry_the_recorded_numbers_in_their_units(saved, two_bodies):
    moving, _ = saved
    force = np.array(column(moving["/plot/force"], "Scalars:scalars"))[:, 0]
    assert np.array_equal(force, two_bodies.step["total_normal_force"])
    depth = np.array(column(moving["/plot/depth"], "Scalars:scalars"))[:, 0]
    assert np.array_equal(depth, two_bodies.step["max_penetration"] * 1e3)


def test_exactly_zero_residual_is_a_gap_and_not_minus_infinity(saved, two_bodies):
    moving, _ = saved
    shown = column(moving["/plot/residual"], "Scalars:scalars")
    for row, residual in zip(shown, two_bodies.step["residual"], strict=True):
        assert row == ([] if residual == 0 else [np.log10(residual)])


def test_absent_field_of_the_log_is_an_absent_plot(two_bodies, tmp_path):
    names = [name for name in two_bodies.step.dtype.names if name != "residual"]
    two_bodies.step = two_bodies.step[names]
    replay.save(two_bodies, tmp_path / "trace.rrd")
    moving, _ = read(tmp_path / "trace.rrd")
    assert {path for path in moving if path.startswith("/plot")} == {"/plot/force", "/plot/depth"}


def test_rows_that_are_not_finite_end_the_motion(one_ball, tmp_path):
    one_ball.pose[-1, 1, :3] = np.nan
    replay.save(one_ball, tmp_path / "trace.rrd")
    moving, _ = read(tmp_path / "trace.rrd")
    assert len(times(moving["/bodies/ball"])) == len(one_ball.step) - 1


def test_trace_without_any_contact_is_saved(one_ball, tmp_path):
    one_ball.contact = np.zeros(0, [("step", "i8"), ("time", "f8")])  # as its log is read
    replay.save(one_ball, tmp_path / "trace.rrd")
    moving, _ = read(tmp_path / "trace.rrd")
    assert all(row == [] for row in column(moving["/contacts/forces"], "Arrows3D:vectors"))


def test_the_file_brings_its_blueprint(two_bodies, tmp_path):
    replay.save(two_bodies, tmp_path / "trace.rrd")
    assert len(RrdReader(tmp_path / "trace.rrd").blueprints()) == 1


def test_failed_save_leaves_the_old_file_and_nothing_beside_it(two_bodies, tmp_path, monkeypatch):
    path = tmp_path / "trace.rrd"
    path.write_bytes(b"yesterday's")

    def fail(*_):
        raise OSError("disk full")

    monkeypatch.setattr("lavendersim.replay.columns.send", fail)
    with pytest.raises(OSError, match="disk full"):
        replay.save(two_bodies, path)
    assert path.read_bytes() == b"yesterday's"
    assert list(tmp_path.iterdir()) == [path]


def where_nothing_can_touch(trace):
    """Make the trace that of a log without /contacts, as the trace room reads it."""
    topics = ("/contacts", "/plot/force", "/plot/penetration", "/plot/log10_residual")
    trace.absent = dict.fromkeys(topics, "nothing can touch (plan: contact_log off)")
    trace.contact = absent_table("this log has no /contacts")
    for name in ("contact_count", "total_normal_force", "max_penetration", "residual"):
        trace.step[name] = 0
    return trace


def test_where_nothing_can_touch_bodies_and_their_paths_are_all_there_is(one_ball, tmp_path):
    replay.save(where_nothing_can_touch(one_ball), tmp_path / "trace.rrd")
    moving, static = read(tmp_path / "trace.rrd")
    assert set(moving) == {"/bodies/ball"}
    rooms = {path.split("/")[1] for path in static} - {"", "__properties"}
    assert rooms == {"bodies", "paths", "grid"}


def views_in(part):
    """The views of a part of the layout, in order; no part of it is empty."""
    if not isinstance(part, rrb.Container):
        return [part]
    assert part.contents
    return [view for inner in part.contents for view in views_in(inner)]


def views_of(trace):
    """The kinds of views in the blueprint of a trace, and the title of the view of the scene."""
    bodies = scene.shapes(trace.config)
    room = scene.extent(trace, bodies)
    scale = None if trace.absent else force_scale(contacts_of(trace), room.diagonal)
    camera = camera_of(trace, bodies, room, Viewpoint())
    views = views_in(blueprint(trace, bodies, room, scale, camera).root_container)
    return [type(view).__name__ for view in views], str(views[0].name)


def test_where_nothing_can_touch_the_scene_is_the_only_view(one_ball):
    kinds, title = views_of(one_ball)
    assert kinds == ["Spatial3DView", *["TimeSeriesView"] * 3]
    assert title.startswith("contact forces: ")
    kinds, title = views_of(where_nothing_can_touch(one_ball))
    assert kinds == ["Spatial3DView"]
    assert "force" not in title


def test_a_removed_floor_takes_its_grid_along(two_bodies, tmp_path):
    two_bodies.resolved["events"] = [{"at": 1.0, "body": "floor", "remove": True}]
    replay.save(two_bodies, tmp_path / "trace.rrd")
    moving, static = read(tmp_path / "trace.rrd")
    for place in ("/bodies/floor", "/grid/floor"):
        assert place not in static
        assert times(moving[place]).tolist() == [0, two_bodies.step["time_ns"][241]]
