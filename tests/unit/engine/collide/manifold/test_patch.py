"""A contact patch is the overlap of two features, with the gap of their planes at its corners."""

from __future__ import annotations

import convex
import numpy as np
import polygons
import pytest
from interpreted import interpreted, records
from single_bodies import scratch_of

from lavendersim.engine.collide.manifold import patch
from lavendersim.engine.collide.manifold.patch import FEATURE_BITS, LINE_BITS, PARALLEL
from lavendersim.engine.collide.manifold.polygon_clip import OTHER
from lavendersim.engine.collide.records import DISC, FACE_LOOP, LINE, NO_FEATURE, Feature, Frame
from lavendersim.engine.records import POINT, TOUCHING, dtype
from lavendersim.engine.vectors import Vec3

frame_along, cross_lines, contact_patch = (
    interpreted(one) for one in (patch.frame_along, patch.cross_lines, patch.contact_patch)
)
LEVEL = Frame(Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0), Vec3(0.0, 0.0, 1.0))
SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
OCTAGON = np.array([[np.cos(k * np.pi / 4), np.sin(k * np.pi / 4)] for k in range(8)])


def test_a_frame_is_orthonormal_and_right_handed(rng) -> None:
    for n in (*np.eye(3), *-np.eye(3), *rng.normal(size=(20, 3))):
        n = n / np.linalg.norm(n)
        found = np.array(frame_along(Vec3(*n)))
        np.testing.assert_allclose(found @ found.T, np.eye(3), atol=1e-15)
        assert np.linalg.det(found) == pytest.approx(1.0, abs=1e-14)
        np.testing.assert_array_equal(found[2], n)
        smallest = np.argmin(np.abs(n))
        assert found[0][smallest] == 0.0


class Features:
    """Two features, A's below and B's above, each on a plane w = w0 + slope . (u, v)."""

    def __init__(self, frame: Frame = LEVEL) -> None:
        self.scratch, self.frame = scratch_of([]), frame
        self.matrix = np.array(frame)
        self.planes = {}

    def put(self, which: str, kind: int, corners, w0: float, slope=(0.0, 0.0), name=0) -> Feature:
        outline = self.scratch.outline_a if which == "a" else self.scratch.outline_b
        corners = np.asarray(corners, float)
        if which == "b" and kind != LINE:
            corners = corners[::-1]  # loops turn left about the outward normal, which is -n here
        heights = w0 + corners @ slope
        self.planes[which] = (w0, np.asarray(slope))
        for k, place in enumerate(np.column_stack([corners, heights]) @ self.matrix):
            outline.corners[k].x, outline.corners[k].y, outline.corners[k].z = place
        up = 1.0 if which == "a" else -1.0
        normal = up * np.array([-slope[0], -slope[1], 1.0]) / np.sqrt(1.0 + np.dot(slope, slope))
        centre = np.array([*corners.mean(axis=0), w0 + corners.mean(axis=0) @ slope])
        plane = outline.plane[0]
        plane.nx, plane.ny, plane.nz = normal @ self.matrix
        plane.x, plane.y, plane.z = centre @ self.matrix
        plane.radius = float(np.linalg.norm(corners[0] - corners.mean(axis=0)))
        return Feature(kind, len(corners), name)

    def run(self, a: Feature, b: Feature, radius_a: float = 0.0, radius_b: float = 0.0):
        start, count = contact_patch(a, b, radius_a, radius_b, self.frame, self.scratch)
        return self.scratch.polygon.array[start : start + count]

    def check(self, rows, corners, tolerance=1e-8, radius_a=0.0, radius_b=0.0) -> None:
        """Corners at the middle of the gap of the two planes, less the radii."""
        flat = np.column_stack([rows["x"], rows["y"]])
        assert polygons.are_same(flat, np.asarray(corners, float), tolerance)
        low, high = (w0 + flat @ slope for w0, slope in (self.planes["a"], self.planes["b"]))
        np.testing.assert_allclose(rows["phi"], high - radius_b - low - radius_a, atol=1e-9)
        np.testing.assert_allclose(rows["z"], 0.5 * (high - radius_b + low + radius_a), atol=1e-9)


def turned(corners, angle: float, by=(0.0, 0.0)):
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(corners) @ [[c, s], [-s, c]] + by


def test_two_faces_touch_at_the_corners_of_their_overlap(rng) -> None:
    for _ in range(15):
        frame = Frame(*(Vec3(*axis) for axis in convex.random_rotation(rng)))
        one, other = turned(SQUARE, rng.uniform(0, 6), rng.uniform(-1, 1, 2)), turned(SQUARE, 0.4)
        features = Features(frame)
        a = features.put("a", FACE_LOOP, one, 0.3, (0.05, -0.02), name=5)
        b = features.put("b", FACE_LOOP, other, 0.31, (-0.03, 0.04), name=9)
        rows = features.run(a, b)
        features.check(rows, polygons.overlap(one, other))
        assert len(set(rows["feature"])) == len(rows)
        assert set(rows["feature"] >> (2 * LINE_BITS)) == {(5 << FEATURE_BITS) | 9}


def test_radii_come_off_the_gap_and_move_the_middle() -> None:
    features = Features()
    a = features.put("a", LINE, [[-0.5, 0.0], [0.5, 0.0]], 0.0)
    b = features.put("b", FACE_LOOP, SQUARE, 0.4, (0.1, 0.0))
    rows = features.run(a, b, 0.25, 0.05)
    features.check(rows, [[-0.5, 0.0], [0.5, 0.0]], radius_a=0.25, radius_b=0.05)


@pytest.mark.parametrize("line", ["a", "b"])
def test_a_line_over_a_face_or_a_cap_touches_where_it_ends_or_leaves(line: str) -> None:
    other = "b" if line == "a" else "a"
    for kind, corners, end in ((FACE_LOOP, SQUARE, 1.0), (DISC, OCTAGON, np.sqrt(0.91))):
        features = Features()
        features.put(
            line, LINE, [[-0.2, 0.3], [3.0, 0.3]], 0.5 if line == "b" else 0.0, (0.02, 0.0)
        )
        of_line = Feature(LINE, 2, 1)
        of_other = features.put(other, kind, corners, 0.0 if line == "b" else 0.5, (0.0, 0.03))
        pair = (of_line, of_other) if line == "a" else (of_other, of_line)
        rows = features.run(*pair)
        # seen along n a tilted cap's rim is the ellipse of radius 1/sqrt(1 + 0.03^2) along v
        if kind == DISC:
            end = np.sqrt(1.0 - 0.3**2 * (1.0 + 0.03**2))
        features.check(rows, [[-0.2, 0.3], [end, 0.3]])


@pytest.mark.parametrize(("scale_a", "scale_b"), [(0.5, 1.0), (1.0, 0.5)])
def test_of_two_caps_the_smaller_is_cut_by_the_larger(scale_a: float, scale_b: float) -> None:
    """The smaller's octagon lies within: its own eight corners touch, whichever body has it."""
    features = Features()
    a = features.put("a", DISC, scale_a * OCTAGON, 0.0)
    b = features.put("b", DISC, scale_b * OCTAGON, 0.1)
    features.check(features.run(a, b), 0.5 * OCTAGON)


@pytest.mark.parametrize("cap", ["a", "b"])
def test_a_cap_is_cut_by_a_face(cap: str) -> None:
    face = "b" if cap == "a" else "a"
    features = Features()
    shifted = SQUARE + np.array([1.0, 0.0])  # u >= 0
    found = {
        cap: features.put(cap, DISC, OCTAGON, 0.1 if cap == "b" else 0.0),
        face: features.put(face, FACE_LOOP, shifted, 0.1 if face == "b" else 0.0),
    }
    rows = features.run(found["a"], found["b"])
    half = [p for p in OCTAGON if p[0] > -1e-9]  # two of them on the side itself
    features.check(rows, half)


def lines(p, q, r, s) -> np.ndarray:
    rows = np.zeros(16, dtype(POINT))
    for k, place in enumerate((p, q, r, s)):
        rows["x"][k], rows["y"][k], rows["z"][k] = place
    return rows


def test_crossing_lines_touch_in_one_point_with_both_heights(rng) -> None:
    crossed = 0
    for _ in range(60):
        ends = rng.normal(size=(4, 3))
        rows = lines(*ends)
        count = cross_lines(records(rows))
        expected = polygons.crossing(*ends[:, :2])
        assert count == (expected is not None)
        if count:
            crossed += 1
            p, q, r, s = ends
            np.testing.assert_allclose([rows["x"][8], rows["y"][8]], expected, atol=1e-12)
            t = np.linalg.norm(expected - p[:2]) / np.linalg.norm(q[:2] - p[:2])
            k = np.linalg.norm(expected - r[:2]) / np.linalg.norm(s[:2] - r[:2])
            assert rows["z"][8] == pytest.approx(p[2] + t * (q[2] - p[2]), abs=1e-12)
            assert rows["phi"][8] == pytest.approx(r[2] + k * (s[2] - r[2]), abs=1e-12)
    assert 5 < crossed < 55


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.5])
@pytest.mark.parametrize("backwards", [False, True])
def test_parallel_lines_touch_at_the_ends_of_their_overlap(backwards, angle) -> None:
    """A from 0 to 2 m at a height of a tenth of that; B from 0.5 to 3, 1 mm beside, at 1 + x/5."""
    b = [(0.5, 1e-3, 1.1), (3.0, 1e-3, 1.6)]
    ends = np.array([(0, 0, 0), (2, 0, 0.2), *(b[::-1] if backwards else b)])
    ends[:, :2] = turned(ends[:, :2], angle)
    rows = lines(*ends)
    assert cross_lines(records(rows)) == 2
    found = rows[8:10]
    x, y = turned(np.column_stack([found["x"], found["y"]]), -angle).T
    np.testing.assert_allclose(x, (0.5, 2.0), atol=1e-12)
    np.testing.assert_allclose(y, 0.5e-3, atol=1e-12)  # half way between the lines
    np.testing.assert_allclose(found["z"], (0.05, 0.2), atol=1e-12)
    np.testing.assert_allclose(found["phi"], (1.1, 1.4), atol=1e-12)
    assert found["in_line"].tolist() == [OTHER + backwards, 1]


def test_parallel_lines_that_end_together_or_pass_keep_their_names_or_touch_nowhere() -> None:
    for noise in (-0.1 * TOUCHING, 0.1 * TOUCHING):
        rows = lines((0, 0, 0), (1, 0, 0), (noise, 0, 1), (1 - noise, 0, 1))
        assert cross_lines(records(rows)) == 2
        assert rows["in_line"][8:10].tolist() == [0, 1]
    for far in (1.5, -1.5):  # one behind the other
        assert cross_lines(records(lines((0, 0, 0), (1, 0, 0), (far, 0, 1), (far + 1, 0, 1)))) == 0
    beside = 1.01 * PARALLEL
    assert cross_lines(records(lines((0, 0, 0), (1, 0, 0), (0, beside, 1), (1, beside, 1)))) == 0


def test_a_point_has_no_patch() -> None:
    features = Features()
    face = features.put("a", FACE_LOOP, SQUARE, 0.0)
    assert len(features.run(face, NO_FEATURE)) == len(features.run(NO_FEATURE, face)) == 0
