"""Ropes, springs and joints are lines between points of bodies, and vanish with what they join."""

from __future__ import annotations

import numpy as np
import pytest
from recordings import column, read, times

from lavendersim import replay
from lavendersim.replay.connections import (
    LINE_COLOUR,
    SLACK_COLOUR,
    DrawnLine,
    corners_of,
    lines_of,
)

COLOURS, STRIPS = "LineStrips3D:colors", "LineStrips3D:strips"


@pytest.fixture
def tied(two_bodies):
    """Tie the ball and the box, and the box to the floor, in three ways."""
    bodies = two_bodies.resolved["scene"]["bodies"]
    bodies["ball"]["position"] = [0.0, 0.0, 1.1]
    bodies["box"]["position"] = [0.5, 0.1, 0.15]
    bodies["box"]["orientation"] = [np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)]
    scene = two_bodies.resolved["scene"]
    scene["connections"] = {
        "rope": {
            "kind": "rope",
            "between": ["ball", "box"],
            "points": [[0.0, 0.0, 0.0], [0.15, 0.0, 0.0]],
        },
        "hinge": {"kind": "hinge", "between": ["box", "ball"], "at": [0.5, 0.25, 0.15],
                  "axis": [0.0, 0.0, 1.0]},
    }  # fmt: skip
    scene["springs"] = [
        {"a": "floor", "b": "ball", "point_a": [0.2, 0.3, 0.0], "stiffness": 1.0},
    ]
    return two_bodies


def drawn(trace, path):
    moving, _ = read(path)
    return {name.removeprefix("/connections/"): batches for name, batches in moving.items()
            if name.startswith("/connections/")}  # fmt: skip


def corners(trace, name):
    (line,) = [one for one in lines_of(trace.config.scene) if one.path[0] == name]
    return corners_of(line, trace, np.arange(len(trace.step)))


def test_a_line_goes_from_end_to_end_in_the_frames_of_the_bodies(tied):
    """The box has turned by a quarter about z: its x is the world's y."""
    rope = corners(tied, "ropes")
    np.testing.assert_array_equal(rope[:, 0], tied.pose[:, 1, :3])
    np.testing.assert_allclose(rope[:, 1], [[0.5, 0.25, 0.15]] * len(rope), rtol=0, atol=1e-15)


def test_a_point_of_a_plane_is_one_of_the_world(tied):
    spring = corners(tied, "springs")
    np.testing.assert_array_equal(spring[:, 0], [[0.2, 0.3, 0.0]] * len(spring))
    np.testing.assert_array_equal(spring[:, 1], tied.pose[:, 1, :3])


def test_a_joint_has_arms_to_the_centres_of_what_moves(tied):
    """Where A has it: `at` is a point of the world as the run begins."""
    hinge = corners(tied, "joints")
    assert hinge.shape[1] == 3
    np.testing.assert_array_equal(hinge[:, 0], tied.pose[:, 2, :3])
    np.testing.assert_allclose(hinge[:, 1], [[0.5, 0.25, 0.15]] * len(hinge), rtol=0, atol=1e-15)
    np.testing.assert_array_equal(hinge[:, 2], tied.pose[:, 1, :3])
    tied.resolved["scene"]["bodies"]["box"]["fixed"] = True
    assert corners(tied, "joints").shape[1] == 2


def test_a_rope_is_dark_while_it_is_slack(tied, tmp_path):
    """It is as long as its ends are apart in the beginning: they come closer, and part again."""
    replay.save(tied, tmp_path / "trace.rrd")
    rope = drawn(tied, tmp_path / "trace.rrd")["ropes/rope"]
    ends = corners(tied, "ropes")
    apart = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    taut = apart > 0.999 * apart[0]
    assert 0 < taut.sum() < len(taut)
    colours = [colour for (colour,) in column(rope, COLOURS)]
    assert colours == np.where(taut, LINE_COLOUR, SLACK_COLOUR).tolist()
    strips = column(rope, STRIPS)
    np.testing.assert_allclose([strip for (strip,) in strips], ends, rtol=1e-6, atol=1e-7)


def test_it_vanishes_with_a_body_that_is_removed(tied, tmp_path):
    """Events act on the step that begins then: at 1 s is state 240, gone is it in state 241."""
    tied.resolved["events"] = [{"at": 1.0, "body": "box", "remove": True}]
    replay.save(tied, tmp_path / "trace.rrd")
    found = drawn(tied, tmp_path / "trace.rrd")
    moment = tied.step["time_ns"][241]
    for name in ("ropes/rope", "joints/hinge"):
        strips = column(found[name], STRIPS)
        assert times(found[name])[-1] == moment
        assert strips[-1] == []
        assert len(strips) == 242
    spring = found["springs/0"]
    assert times(spring)[-1] == tied.step["time_ns"][-1]


def test_what_connects_nothing_that_moves_is_not_drawn(tied, tmp_path):
    for body in ("box", "ball"):
        tied.resolved["scene"]["bodies"][body] |= {"fixed": True}
    replay.save(tied, tmp_path / "trace.rrd")
    assert drawn(tied, tmp_path / "trace.rrd") == {}
    assert all(isinstance(one, DrawnLine) for one in lines_of(tied.config.scene))
