"""Thumbnails: outlines by a slow twin, seen from where bodies spread, equal for equal logs."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from synthetic import log_of, scene_of

from lavendersim.cell import Ellipsoid
from lavendersim.figures.thumbnail import (
    AROUND,
    BEFORE,
    FIXED,
    _bounds,
    _hull,
    _outlines,
    cell_of,
    colour_of,
    corners_of,
    grounds_of,
    parts_of,
    thumbnail,
    view_of,
)
from lavendersim.trace.reader import RecordedPoses

BALL = {"shape": {"kind": "sphere", "radius": 0.1}, "mass": 1.0}
BOX = {"shape": {"kind": "box", "size": [2.0, 2.0, 2.0]}, "mass": 1.0}
FLOOR = {"shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.5}}


def log(bodies: dict[str, Any], *states: Any, **scene: Any) -> Any:
    one = log_of(scene_of(bodies, **scene), states)
    one.recorded_pose = RecordedPoses(np.arange(len(states)), one.pose)
    return one


def is_extreme(points: np.ndarray, corner: np.ndarray) -> bool:
    """Whether a corner is no mean of others: some direction has it alone as its farthest."""
    angles = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
    directions = np.column_stack([np.cos(angles), np.sin(angles)])
    heights = points @ directions.T
    return bool(np.any(corner @ directions.T >= heights.max(axis=0) - 1e-12))


@pytest.mark.parametrize("seed", range(5))
def test_an_outline_is_the_convex_hull_in_order(seed: int) -> None:
    points = np.random.default_rng(seed).normal(size=(30, 2))
    hull = _hull(points)
    turns = [
        np.cross(np.append(b - a, 0.0), np.append(c - b, 0.0))[2]
        for a, b, c in zip(hull, np.roll(hull, -1, 0), np.roll(hull, -2, 0), strict=True)
    ]
    assert min(turns) > 0.0  # each corner turns left
    for a, b in zip(hull, np.roll(hull, -1, 0), strict=True):
        side = (b[0] - a[0]) * (points[:, 1] - a[1]) - (b[1] - a[1]) * (points[:, 0] - a[0])
        assert side.min() >= -1e-12  # every point is within
    assert all(is_extreme(points, corner) for corner in hull)


def test_points_in_one_place_and_in_a_line_have_an_outline() -> None:
    assert {tuple(corner) for corner in _hull(np.ones((4, 2))).tolist()} == {(1.0, 1.0)}
    line = _hull(np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]))
    assert sorted(map(tuple, line.tolist())) == [(0.0, 0.0), (2.0, 2.0)]


def test_up_is_against_gravity_and_sideways_is_where_bodies_spread() -> None:
    bodies = {"a": BALL, "b": BALL}
    along_x, along_y = ([[0, 0, 0], end] for end in ([4, 0, 0], [0, 4, 0]))
    right, up = view_of(log(bodies, along_x))
    assert (right.tolist(), up.tolist()) == ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    right, _ = view_of(log(bodies, along_y))
    assert abs(right[1]) == pytest.approx(1.0)
    _, up = view_of(log(bodies, along_x, gravity=[0.0, -3.0, -4.0]))
    assert up == pytest.approx([0.0, 0.6, 0.8])
    right, up = view_of(log(bodies, along_x, gravity=[9.0, 0.0, 0.0]))
    assert up.tolist() == [-1.0, 0.0, 0.0]
    assert abs(right @ up) < 1e-15


def test_a_box_is_a_square_where_it_began_and_where_it_ended() -> None:
    one = log({"it": BOX}, [[0, 0, 1]], [[3, 0, 1]])
    outlines, colours, seen = _outlines(one, *view_of(one))
    assert colours[0] == BEFORE
    squares = [sorted(map(tuple, outline.tolist())) for outline in outlines]
    corners = list(itertools.product((-1.0, 1.0), (0.0, 2.0)))
    assert squares == [
        sorted(corners),
        sorted((x + 3.0, y) for x, y in corners),
    ]
    assert (seen.min(axis=0).tolist(), seen.max(axis=0).tolist()) == ([-1.0, 0.0], [4.0, 2.0])


def test_the_last_finite_state_is_shown_and_what_is_fixed_once() -> None:
    bodies = {"it": BALL, "post": {"shape": BOX["shape"]}}
    one = log(bodies, [[0, 0, 1], [9, 0, 0]], [[1, 0, 1], [9, 0, 0]], [[np.nan, 0, 1], [9, 0, 0]])
    _, colours, seen = _outlines(one, *view_of(one))
    assert colours.count(FIXED) == 1
    assert seen.max(axis=0)[0] == pytest.approx(1.1, abs=0.01)  # not the post's 10, nor NaN
    none = log(bodies, [[np.nan, 0, 1], [9, 0, 0]])
    assert _outlines(none, *view_of(log(bodies, [[0, 0, 1], [9, 0, 0]])))[0] == []


def test_a_plane_is_a_line_where_it_is_seen_edge_on() -> None:
    one = log({"floor": FLOOR, "it": BALL}, [[0, 0, 0], [0, 0, 1]])
    ((start, along),) = grounds_of(one, *view_of(one))
    assert start.tolist() == [0.0, 0.5]
    assert abs(along[0]) == pytest.approx(1.0)
    facing = {"shape": {"kind": "plane", "normal": [0.0, 1.0, 0.0], "offset": 0.0}}
    assert (
        grounds_of(log({"wall": facing, "it": BALL}, [[0, 0, 0], [0, 0, 1]]), *view_of(one)) == []
    )


def test_faces_of_a_periodic_cell_are_lines_in_the_picture_where_they_are_seen_edge_on() -> None:
    """Along y, into the picture, there is none."""
    periodic = {"x": [-1.0, 3.0], "y": [-2.0, 2.0], "z": None}
    one = log({"it": BALL}, [[0, 0, 1]], [[0.5, 0, 1]], periodic=periodic)
    view = view_of(one)
    lines = cell_of(one, *view)
    assert [start.tolist() for start, _ in lines] == [[-1.0, 0.0], [3.0, 0.0]]
    assert [abs(along).tolist() for _, along in lines] == [[0.0, 1.0]] * 2
    low, high = _bounds(_outlines(one, *view)[2], lines)
    assert [low[0], high[0]] == [-1.0, 3.0]
    assert [low[1], high[1]] == pytest.approx([0.9, 1.1])
    without = log({"it": BALL}, [[0, 0, 1]], [[0.5, 0, 1]])
    assert cell_of(without, *view) == []
    assert thumbnail(one) != thumbnail(without)


def test_a_cavity_is_a_line_around_what_is_inside() -> None:
    """Of 48 corners: as far out as 1 - (pi/48)^2/2 of the radius, 0.22 %."""
    bowl = {"shape": {"kind": "bowl", "radius": 2.0}, "fixed": True}
    turn = [0.5**0.5, 0.5**0.5, 0.0, 0.0]  # the drum's z to -y: away from the eye
    drum = {"shape": {"kind": "drum", "radius": 2.0}, "orientation": turn, "fixed": True}
    for wall in (bowl, drum):
        one = log({"wall": wall, "it": BALL}, [[0, 0, 1], [1, 0, 1]], [[0, 0, 1], [0, 0, 1]])
        one.recorded_pose.pose[:, 0, 3:] = wall.get("orientation", [1.0, 0.0, 0.0, 0.0])
        outlines, colours, seen = _outlines(one, *view_of(one))
        assert {BEFORE, AROUND} < {*colours}
        assert len(colours) == 3
        (around,) = (o for o, colour in zip(outlines, colours, strict=True) if colour == AROUND)
        far = np.linalg.norm(around - [0.0, 1.0], axis=1)
        np.testing.assert_allclose(far, 2.0, rtol=0.0, atol=1e-12)
        assert len(around) >= 48
        assert seen.min(axis=0) == pytest.approx([-2.0, -1.0], abs=0.01)


def test_a_drum_from_the_side_is_as_long_as_wide() -> None:
    drum = {"shape": {"kind": "drum", "radius": 2.0}, "fixed": True}
    one = log({"wall": drum, "it": BALL}, [[0, 0, 1], [1, 0, 1]])
    _, _, seen = _outlines(one, *view_of(one))
    assert seen.min(axis=0) == pytest.approx([-2.0, -1.0])
    assert seen.max(axis=0) == pytest.approx([2.0, 3.0])


def test_equal_logs_give_equal_pictures() -> None:
    made = [thumbnail(log({"floor": FLOOR, "it": BALL}, [[0, 0, 0], [0, 0, 1]], [[0, 0, 0], [1, 0, 1]])) for _ in range(2)]  # noqa: E501  # fmt: skip
    assert made[0] == made[1]
    assert made[0].startswith(b"\x89PNG")
    assert made[0][16:24] == (160).to_bytes(4, "big") + (110).to_bytes(4, "big")


def test_the_outline_of_an_ellipsoid_is_as_round_as_a_dot() -> None:
    """Of a circle of 72 corners a chord lies within 1 - cos(pi / 72) of the arc, stretched or not.

    That is a thousandth of the size, a sixth of a dot of the picture.
    """
    semi_axes = np.array([0.2, 0.05, 0.1])
    on_unit_ball = corners_of(Ellipsoid(kind="ellipsoid", semi_axes=tuple(semi_axes))) / semi_axes
    assert np.allclose(np.linalg.norm(on_unit_ball, axis=1), 1.0, rtol=1e-15)
    for seen in ((0, 1), (1, 2), (2, 0)):
        outline = _hull(on_unit_ball[:, seen])
        chords = (outline + np.roll(outline, 1, axis=0)) / 2.0
        assert np.linalg.norm(chords, axis=1).min() >= np.cos(np.pi / 72) - 1e-15


def test_a_mesh_is_drawn_by_its_triangles_and_a_very_fine_one_by_its_outline() -> None:
    corners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0.5], [-1, 1, 0.5]]
    mesh = {"kind": "mesh", "vertices": corners, "triangles": [[0, 1, 2], [0, 2, 3]]}
    ground = {"shape": mesh, "fixed": True}
    one = log({"ground": ground, "it": BALL}, [[0, 0, 0], [0, 0, 1]], [[0, 0, 0], [1, 0, 1]])
    _, colours, _ = _outlines(one, *view_of(one))
    assert colours.count(FIXED) == 2
    shape = one.config.scene.bodies["ground"].shape
    assert [len(part) for part in parts_of(shape)] == [3, 3]
    fine = shape.model_copy(update={"triangles": shape.triangles * 1000})
    assert [len(part) for part in parts_of(fine)] == [4]
    assert (colour_of(shape), colour_of(fine)) == (FIXED, AROUND)
