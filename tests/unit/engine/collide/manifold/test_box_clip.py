"""Of two boxes face to face the overlap's corners touch, each by the lines that meet in it."""

from __future__ import annotations

import convex
import numpy as np
import polygons
import pytest
import solids
from interpreted import interpreted
from single_bodies import body, row, scratch_of, solid, vector

from lavendersim.engine.collide.manifold import box_clip
from lavendersim.engine.collide.manifold.box_clip import (
    FACE_NAMES,
    LINES,
    VERTEX_NAMES,
    ReferenceFace,
)
from lavendersim.engine.collide.pairs.box_box import load_box
from lavendersim.engine.records import TOUCHING
from lavendersim.engine.vectors import Vec3

# Faces are cut one TOUCHING outside of their edges, and points moved back to the face: where two
# lines meet at an angle, the point is off by TOUCHING over its sine.
CUT = 100.0 * TOUCHING


class Faces:
    """A face of a turned box and one of another, turned by some angles and lying `gap` above."""

    def __init__(self, rng, axis: int, sign: float, tilt: float, gap: float, beside: float) -> None:
        self.face = ReferenceFace(axis, sign, 7000)
        self.half, half = rng.uniform(0.3, 0.6, (2, 3))
        self.matrix = convex.random_rotation(rng)
        self.n = sign * self.matrix[:, axis]
        spin, lean = rng.uniform(0.0, 6.0), tilt * rng.uniform(-1.0, 1.0, 2)
        turn = convex.matrix_of([1.0, *(np.tan(spin / 2) * self.n)])
        lean_axis = (
            lean[0] * self.matrix[:, (axis + 1) % 3] + lean[1] * self.matrix[:, (axis + 2) % 3]
        )
        other = convex.matrix_of([1.0, *(0.5 * lean_axis)]) @ turn @ self.matrix
        other = other @ np.eye(3)[rng.permutation(3)] * rng.choice([-1, 1], 3)
        centre = rng.normal(size=3)
        b = solids.Solid("box", np.zeros(3), other, half, 0.0, None, None)
        way = (self.half[axis] + solids.reach(b, -self.n) + gap) * self.n
        for k in (1, 2):
            way = way + beside * rng.uniform(-0.5, 0.5) * self.matrix[:, (axis + k) % 3]
        self.a, self.b = (
            body("box", self.half, centre, self.matrix),
            body("box", half, centre + way, other),
        )
        self.scratch = scratch_of([])
        load_kernel = interpreted(load_box)
        for rows, frame in ((self.a, self.scratch.box_a), (self.b, self.scratch.box_b)):
            load_kernel(row(rows), Vec3(*way), frame)

    def clip(self, margin: float):
        scratch = self.scratch
        kernel = interpreted(box_clip.clip_incident_face)
        count = kernel(scratch.box_a, scratch.box_b, self.face, margin, scratch.manifold)
        return scratch.manifold.points.array[:count].copy()

    def incident_face(self):
        """Corners of B's face that looks most against n, in u, v, w of the reference face."""
        shape = solid(self.b)
        looks = [(s * shape.matrix[:, k] @ self.n, k, s) for k in range(3) for s in (-1.0, 1.0)]
        _, axis, sign = min(looks)
        u, v = (self.matrix[:, (self.face.axis + k) % 3] for k in (1, 2))
        origin = vector(self.a[0]) + self.half[self.face.axis] * self.n
        corners = []
        for su, sv in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            local = np.zeros(3)
            local[axis], local[(axis + 1) % 3], local[(axis + 2) % 3] = sign, su, sv
            place = shape.centre + shape.matrix @ (local * shape.half) - origin
            corners.append([place @ u, place @ v, place @ self.n])
        return np.array(corners), axis, sign


def turned_left(corners: np.ndarray) -> np.ndarray:
    following = np.roll(corners, -1, axis=0)
    twice = np.sum(corners[:, 0] * following[:, 1] - corners[:, 1] * following[:, 0])
    return corners if twice > 0.0 else corners[::-1]


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("tilt", [0.0, 0.1])
def test_the_points_are_the_corners_of_the_overlap_at_their_heights(axis, sign, tilt, rng) -> None:
    for _ in range(6):
        pose = Faces(rng, axis, sign, tilt, -0.01, 1.0)
        found = pose.clip(1e9)
        face, _, _ = pose.incident_face()
        hu, hv = pose.half[(axis + 1) % 3], pose.half[(axis + 2) % 3]
        rectangle = np.array([[-hu, -hv], [hu, -hv], [hu, hv], [-hu, hv]])
        flat = polygons.overlap(turned_left(face[:, :2]), rectangle)
        # heights on the incident face's plane
        plane = np.linalg.lstsq(np.column_stack([face[:, :2], np.ones(4)]), face[:, 2], rcond=None)[
            0
        ]
        phi = np.column_stack([flat, np.ones(len(flat))]) @ plane
        u, v = (pose.matrix[:, (axis + k) % 3] for k in (1, 2))
        origin = vector(pose.a[0]) + pose.half[axis] * pose.n
        expected = (
            origin + np.outer(flat[:, 0], u) + np.outer(flat[:, 1], v) + np.outer(phi / 2, pose.n)
        )
        points = np.column_stack([found[name] for name in "xyz"])
        assert polygons.are_same(points, expected, CUT)
        heights = np.column_stack([points, found["phi"]])
        assert polygons.are_same(heights, np.column_stack([expected, phi]), 2.0 * CUT)
        np.testing.assert_allclose(pose.scratch.manifold.normal, pose.n, atol=1e-15)


def test_points_above_the_margin_are_left_out_and_the_others_stay(rng) -> None:
    left_out = 0
    for _ in range(10):
        pose = Faces(rng, 2, 1.0, 0.2, -0.02, 0.5)
        every, near = pose.clip(1e9), pose.clip(0.01)
        assert near["feature"].tolist() == every["feature"][every["phi"] <= 0.01].tolist()
        left_out += len(every) - len(near)
    assert left_out > 0


def test_a_name_is_the_faces_and_the_two_lines_that_meet(rng) -> None:
    for axis in range(3):
        for sign in (-1.0, 1.0):
            pose = Faces(rng, axis, sign, 0.05, -0.01, 1.0)
            found = pose.clip(1e9)
            face, incident, _ = pose.incident_face()
            hu, hv = pose.half[(axis + 1) % 3], pose.half[(axis + 2) % 3]
            u, v = (pose.matrix[:, (axis + k) % 3] for k in (1, 2))
            names = found["feature"] - pose.face.first_name
            assert len(set(names)) == len(names)
            assert set(names // FACE_NAMES) == {2 * axis + (sign > 0.0)}
            assert set(names % FACE_NAMES // VERTEX_NAMES) == {incident}
            for point, name in zip(found, names, strict=True):
                place = vector(point) - vector(pose.a[0])
                flat = np.array([place @ u, place @ v])
                for line in divmod(int(name % VERTEX_NAMES), LINES):
                    if line < 4:
                        p, q = face[line, :2], face[(line + 1) % 4, :2]
                        d, to = (q - p) / np.linalg.norm(q - p), flat - p
                        off = abs(d[0] * to[1] - d[1] * to[0])
                    else:
                        along, limit = ((0, -hu), (0, hu), (1, -hv), (1, hv))[line - 4]
                        off = abs(flat[along] - limit)
                    assert off <= CUT


def test_the_incident_face_opposes_n_most_and_stays_where_two_do(rng) -> None:
    kernel, frame = interpreted(box_clip.incident_axis), scratch_of([]).box_b
    for _ in range(30):
        matrix = convex.random_rotation(rng)
        interpreted(load_box)(row(body("box", (1, 1, 1), matrix=matrix)), Vec3(0, 0, 0), frame)
        n = rng.normal(size=3)
        n /= np.linalg.norm(n)
        axis, sign = kernel(frame, Vec3(*n))
        assert sign * matrix[:, axis] @ n == pytest.approx(-np.abs(matrix.T @ n).max(), abs=1e-15)
    interpreted(load_box)(row(body("box", (1, 1, 1))), Vec3(0, 0, 0), frame)
    for noise in (-1e-12, 0.0, 1e-12):
        half = np.sqrt(0.5)
        assert kernel(frame, Vec3(half, half + noise, 0.0)) == (0, -1.0)
