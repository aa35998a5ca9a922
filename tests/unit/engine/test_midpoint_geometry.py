"""Bodies stand half way between both ends of a step, and contacts where their features then are."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import convex
import numpy as np
import pytest
import solid_poses
from drawn_contacts import put_vector, random_frame
from interpreted import interpreted, records

from lavendersim.engine import midpoint_geometry
from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.collide.scratch import allocate_scratch
from lavendersim.engine.midpoint_geometry import AGREES, APART, NEAR, TILTED
from lavendersim.engine.record_layout import (
    allocate_bodies,
    allocate_pairs,
    allocate_velocities,
    contact_dtype,
)
from lavendersim.engine.records import MOTION, dtype
from lavendersim.engine.rotation import orient, turn
from lavendersim.engine.spec import Spec

EFFECTS = ("contact_midpoint", "friction", "impact_order", "impact_time", "rotation")
PAIRS = ("box_box", "box_plane", "sphere_box", "sphere_plane")
SPEC = Spec(EFFECTS, PAIRS)
UNEVEN = SPEC.including("gyroscopic")
TORQUES = SPEC.including("fast_bodies", "rolling_friction", "torsional_friction")
DT = 0.02
QUATERNION = ("qw", "qx", "qy", "qz")


def vector(row: Any, prefix: str = "") -> np.ndarray:
    return np.array([row[f"{prefix}{axis}"] for axis in "xyz"])


def frame_of(row: Any) -> np.ndarray:
    return convex.matrix_of(np.array([row[name] for name in QUATERNION]))


class Midway:
    """A body that goes from one velocity to another in a step."""

    def __init__(
        self, rng: np.random.Generator, spec: Spec = SPEC, moments: Any = (1, 1, 1)
    ) -> None:
        self.spec = spec
        self.poses, self.velocities = allocate_bodies(spec, 1), allocate_velocities(spec, 1)
        self.motion, self.lead = np.zeros(1, dtype(MOTION)), allocate_velocities(spec, 1)
        self.poses["inv_m"] = 1.0
        put_vector(self.poses[0], "", rng.normal(size=3))
        q = rng.normal(size=4)
        for name, value in zip(QUATERNION, q / np.linalg.norm(q), strict=True):
            self.poses[name] = value
        put_vector(self.poses[0], "inv_i", 1.0 / np.array(moments))
        interpreted(orient)(records(self.poses)[0])
        for prefix in ("v", "w"):
            put_vector(self.motion[0], prefix, rng.normal(size=3))
            put_vector(self.velocities[0], prefix, rng.normal(size=3))
        self.bodies = self.poses.copy()

    def stand(self) -> int:
        arrays = self.bodies, self.velocities, self.motion, self.lead, self.poses
        kernel = interpreted(midpoint_geometry.make_stand_midway(self.spec))
        return int(kernel(*(records(array) for array in arrays), DT))


def test_the_middle_is_half_way_in_place_and_turn(rng) -> None:
    """Half a step at the mean velocity; twice its turn is the whole one at the mean spin."""
    body = Midway(rng)
    m, v = body.motion[0], body.velocities[0]
    assert body.stand() == 0
    place = vector(body.poses[0]) + 0.25 * DT * (vector(m, "v") + vector(v, "v"))
    np.testing.assert_allclose(vector(body.bodies[0]), place, atol=1e-15)
    whole = records(body.poses.copy())[0]
    interpreted(turn)(whole, *(0.5 * DT * (vector(m, "w") + vector(v, "w"))))
    half = frame_of(body.bodies[0]) @ frame_of(body.poses[0]).T
    expected = frame_of(whole._row) @ frame_of(body.poses[0]).T
    np.testing.assert_allclose(half @ half, expected, atol=1e-14)
    np.testing.assert_array_equal(vector(body.lead[0], "v"), vector(m, "v"))
    # Asked again it stands there again, not farther.
    before = body.bodies.copy()
    body.stand()
    assert body.bodies.tobytes() == before.tobytes()


def test_an_uneven_body_that_nothing_pushes_keeps_its_momentum_at_the_middle(rng) -> None:
    """The mean of both ends' momenta in its axes: what is across the turn is cos(theta/2) short.

    With H the half turn, (1 + H^-2)/2 = H^-1 (H + H^-1)/2, whose second factor is that cosine
    across the axis of H and one along it; the mean spin is along it.
    """
    moments = (0.5, 1.0, 1.4)
    body = Midway(rng, UNEVEN, moments)
    start = frame_of(body.poses[0])
    momentum = start @ np.diag(moments) @ start.T @ vector(body.motion[0], "w")
    for rows in (body.lead, body.velocities):
        put_vector(rows[0], "w", vector(body.motion[0], "w"))
    assert body.stand() == 0
    middle, spin = frame_of(body.bodies[0]), vector(body.lead[0], "w")
    axis = spin / np.linalg.norm(spin)
    along = axis * (axis @ momentum)
    cosine = np.cos(np.arctan(0.5 * DT * np.linalg.norm(spin)))
    kept = middle @ np.diag(moments) @ middle.T @ spin
    np.testing.assert_allclose(kept, along + cosine * (momentum - along), atol=1e-14)


def test_a_middle_that_is_not_found_is_counted(rng) -> None:
    missed = set()
    for _ in range(30):
        body = Midway(rng, UNEVEN, (0.01, 1.0, 1.005))
        put_vector(body.motion[0], "w", 3e3 * random_frame(rng)[0])
        for rows in (body.lead, body.velocities):
            put_vector(rows[0], "w", vector(body.motion[0], "w"))
        missed.add(body.stand())
    assert missed == {0, 1}


def test_what_is_fixed_stays_and_what_is_kinematic_goes(rng) -> None:
    for kinematic in (0, 1):
        body = Midway(rng, SPEC.including("kinematic"))
        body.poses["inv_m"], body.poses["kinematic"] = 0.0, kinematic
        body.bodies[:] = body.poses
        body.stand()
        assert (body.bodies.tobytes() != body.poses.tobytes()) == bool(kinematic)


class Touching:
    """Two bodies, the manifold of where they stand as contacts, and the rows of the start."""

    def __init__(self, pair: str, a: dict[str, Any], b: dict[str, Any], spec: Spec = SPEC) -> None:
        self.spec, self.bodies = spec, allocate_bodies(spec, 2)
        for row, shape in zip(self.bodies, (a, b), strict=True):
            known = dict(shape)
            row["inv_m"] = known.pop("inv_m", 1.0)
            solid_poses.put(row, **known)
        self.pairs = allocate_pairs(spec, 1)
        self.pairs["b"], self.pairs["kind"] = 1, SHAPE_PAIRS[pair].kind
        self.scratch = allocate_scratch(None)
        self.manifold = interpreted(SHAPE_PAIRS[pair].make(spec))
        points, normal = self.points(1e-9)
        self.contacts = np.zeros(len(points), contact_dtype(spec))
        self.contacts["b"] = 1
        for row, point in zip(self.contacts, points, strict=True):
            row["feature"], row["phi"] = point["feature"], point["phi"]
            put_vector(row, "", vector(point))
            put_vector(row, "n", normal)
        arrays = records(self.contacts)
        interpreted(midpoint_geometry.make_keep_start(spec))(arrays, len(arrays))
        self.poses = self.bodies.copy()

    def points(self, margin: float) -> tuple[np.ndarray, np.ndarray]:
        rows, scratch = records(self.bodies), records(self.scratch)
        count = self.manifold(rows[0], rows[1], margin, scratch)
        return self.scratch.manifold.points[:count].copy(), self.scratch.manifold.normal.copy()

    def moves(self, body: int, shift: Any, matrix: Any = None) -> None:
        put_vector(self.bodies[body], "", vector(self.poses[body]) + np.array(shift))
        if matrix is not None:
            for i in range(3):
                for j in range(3):
                    self.bodies[f"r{i}{j}"][body] = matrix[i][j]

    def look(self) -> np.ndarray:
        names = ("bodies", "contacts", "pairs")
        state = SimpleNamespace(**{name: records(getattr(self, name)) for name in names})
        workspace = SimpleNamespace(collision=records(self.scratch))
        look = interpreted(midpoint_geometry.make_look(self.spec))
        look(state, len(self.contacts), records(self.poses), workspace)
        return self.contacts


FLOOR = {"kind": "plane", "half": (0.0, 0.0, 1.0), "inv_m": 0.0}
CUBE = {"kind": "box", "half": (0.1, 0.1, 0.1), "centre": (0.0, 0.0, 0.1)}


BALL = {"kind": "sphere", "half": (0.2, 0.0, 0.0), "centre": (0.0, 0.0, 0.4)}


def tilted(degrees: float, axis: int = 1) -> np.ndarray:
    angle = np.radians(degrees)
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[[1, 0, 0], [0, c, -s], [0, s, c]], [[c, 0, s], [0, 1, 0], [-s, 0, c]]][axis])


def test_contacts_follow_their_features() -> None:
    """Corners of a cube that tilts on a floor: each row is at its own corner, half way to it."""
    scene = Touching("box_plane", FLOOR, CUBE)
    features, turned = scene.contacts["feature"].copy(), tilted(2.0)
    assert len(features) == 4
    scene.moves(1, (0.03, 0.01, 0.002), turned)
    for row, feature in zip(scene.look(), features, strict=True):
        corner = [0.1 if int(feature) >> bit & 1 else -0.1 for bit in range(3)]
        at = vector(scene.bodies[1]) + turned @ corner
        np.testing.assert_allclose(vector(row), at * (1.0, 1.0, 0.5), atol=1e-15)
        np.testing.assert_array_equal(vector(row, "n"), (0.0, 0.0, 1.0))


@pytest.mark.parametrize("fixed", [0, 1])
def test_what_is_beyond_sight_stays_on_the_body_that_moves(fixed: int) -> None:
    """APART of a body's size beyond its gap: there it is carried along with B, or A."""
    size = np.sqrt(3.0) * 0.1
    for share, seen in ((0.99, True), (1.01, False)):
        ends = ({**end, "inv_m": float(k != fixed)} for k, end in enumerate((CUBE, BALL)))
        scene = Touching("sphere_box", *ends)
        mover, sign = (1, 1.0) if fixed == 0 else (0, -1.0)
        scene.moves(mover, (0.0, 0.0, sign * share * APART * size))
        row = scene.look()[0]
        start = vector(row, "at_")
        shift = (0.0, 0.0, sign * share * APART * size)
        expected = start + np.array(shift) * (0.5 if seen else 1.0)
        np.testing.assert_allclose(vector(row), expected, atol=1e-9)


def test_flat_faces_that_pass_to_an_edge_take_their_contacts_along() -> None:
    """A cube across another's edge: none of the face's features is left, and each contact goes to
    the nearest of the new ones, as long as the normal agrees.
    """
    scene = Touching("box_box", {**CUBE, "centre": (0.0, 0.0, -0.1), "inv_m": 0.0}, CUBE)
    scene.moves(1, (0.15, 0.0, 0.0), tilted(20.0, 0) @ tilted(20.0))
    scene.contacts["feature"] = -1 - np.arange(len(scene.contacts))  # as of another pair of faces
    scene.moves(1, (0.0, 0.0, 0.05), tilted(20.0, 0) @ tilted(20.0))
    found, normal = scene.points(1e-9 + APART * scene.bodies["bound"].min())
    assert len(found) > 0
    for row in scene.look():
        start, places = vector(row, "at_"), np.array([vector(point) for point in found])
        nearest = places[np.linalg.norm(places - start, axis=1).argmin()]
        np.testing.assert_array_equal(vector(row), nearest)
        np.testing.assert_array_equal(vector(row, "n"), normal)


@pytest.mark.parametrize(("shift", "own"), [(0.001, True), (0.01, False)])
def test_a_point_of_another_name_is_the_contact_where_it_is_near(shift: float, own: bool) -> None:
    """A cube on its like, pushed along x: of the corners ahead the lower cube has the edge.

    Their points stay behind by the shift: less than NEAR of its size, 3.5 mm, or more.
    """
    scene = Touching("box_box", {**CUBE, "centre": (0.0, 0.0, -0.1), "inv_m": 0.0}, CUBE)
    assert 0.001 < NEAR * scene.bodies["bound"].min() < 0.01
    ahead = int(np.flatnonzero(scene.contacts["x"] > 0.0)[0])
    scene.contacts["feature"][ahead] = -1
    scene.moves(1, (shift, 0.0, 0.0))
    row = scene.look()[ahead]
    assert row["x"] == pytest.approx(0.1 if own else 0.1 + shift, abs=1e-12)
    assert row["y"] == pytest.approx(row["at_y"], abs=1e-12)


def test_a_normal_that_has_turned_away_is_another_contact(rng) -> None:
    nearest = interpreted(midpoint_geometry.make_nearest(SPEC))
    scratch = allocate_scratch(None)
    points = scratch.manifold.points[:3]
    for point in points:
        put_vector(point, "", rng.normal(size=3))
    frame = random_frame(rng)
    scratch.manifold.normal[:] = frame[0]
    manifold = records(scratch).manifold
    for cosine, turned in ((AGREES + 1e-9, False), (AGREES - 1e-9, True)):
        contact = np.zeros(1, contact_dtype(SPEC))
        put_vector(contact[0], "at_", vector(points[1]) + 0.01 * frame[1])
        put_vector(contact[0], "at_n", cosine * frame[0] + np.sqrt(1.0 - cosine**2) * frame[2])
        assert nearest(records(contact)[0], manifold, 3) == (-1 if turned else 1)
    assert nearest(records(contact)[0], manifold, 0) == -1


def tilted_disc(angle: float) -> np.ndarray:
    """Turned by a hair about an axis of the floor at an angle from x: its lowest point is aside."""
    about_z, hair = np.eye(3), tilted(0.01, 0)
    about_z[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return about_z @ hair @ about_z.T


@pytest.mark.parametrize("turned", [0.2, 1.0, np.pi])
def test_a_cap_that_tilts_to_another_side_keeps_its_contacts_where_they_were(turned: float) -> None:
    """Its points are named from where it tilts to: a name may stand for another place.

    0.2 rad along the rim are 0.2 radii, and the point of the name; 1 rad is beyond TILTED.
    """
    spec, radius = Spec(EFFECTS, ("cylinder_plane",)), 0.1
    disc = {"kind": "cylinder", "half": (radius, radius, 0.005), "centre": (0.0, 0.0, 0.00497)}
    scene = Touching("cylinder_plane", FLOOR, disc | {"matrix": tilted_disc(0.0)}, spec)
    before = np.array([vector(row) for row in scene.contacts])
    assert len(before) == 4
    scene.moves(1, (0.0, 0.0, 0.0), tilted_disc(turned))
    moved = [np.linalg.norm(vector(row) - at) for row, at in zip(scene.look(), before, strict=True)]
    # A chord of the rim; the tilt itself is 1.7e-4 rad.
    expected = 2.0 * radius * np.sin(0.5 * turned) if turned < TILTED else 0.0
    np.testing.assert_allclose(moved, expected, atol=1e-3 * radius)


def test_round_bodies_that_lose_a_feature_keep_their_contact() -> None:
    scene = Touching("sphere_box", CUBE, BALL)
    scene.contacts["feature"] = 77
    scene.moves(1, (0.01, 0.0, 0.0))
    row = scene.look()[0]
    np.testing.assert_array_equal(vector(row), np.add(vector(row, "at_"), (0.01, 0, 0)))


def test_what_is_passed_on_to_the_next_face_stays() -> None:
    scene = Touching("box_plane", FLOOR, CUBE)
    scene.contacts["passed_on"][2] = 1
    scene.moves(1, (0.03, 0.0, 0.0), tilted(2.0))
    for row in scene.look():
        np.testing.assert_allclose(
            vector(row), np.add(vector(row, "at_"), (0.03, 0, 0)), atol=1e-15
        )


def test_swept_contacts_are_no_longer_aside_where_their_features_are() -> None:
    aside = {"tangential_x": 0.1, "tangential_y": 0.2, "tangential_z": 0.3}
    spec = SPEC.including("fast_bodies")
    for feature, left in ((None, (0.0, 0.0, 0.0)), (77, (0.1, 0.2, 0.3))):
        scene = Touching("box_plane", FLOOR, CUBE, spec)
        for name, value in aside.items():
            scene.contacts[name] = value
        interpreted(midpoint_geometry.make_keep_start(spec))(records(scene.contacts), 4)
        if feature:
            scene.contacts["feature"] = feature
        row = scene.look()[0]
        assert vector(row, "tangential_").tolist() == list(left)


def test_contacts_of_two_pairs_do_not_mix() -> None:
    """Of two cubes on a floor each row finds the corner of its own."""
    scene = Touching("box_plane", FLOOR, CUBE)
    other = allocate_bodies(SPEC, 3)
    other[:2], other[2] = scene.bodies, scene.bodies[1]
    other["x"][2] = 5.0
    scene.bodies, scene.poses = other, other.copy()
    scene.pairs = np.repeat(scene.pairs, 2)
    scene.pairs["b"][1] = 2
    second = scene.contacts.copy()
    second["pair"], second["b"] = 1, 2
    for name in ("x", "at_x"):
        second[name] += 5.0
    scene.contacts = np.concatenate([scene.contacts, second])
    scene.bodies["x"][1:] += [0.01, 0.02]
    found = scene.look()
    np.testing.assert_allclose(found["x"] - found["at_x"], [0.01] * 4 + [0.02] * 4, atol=1e-15)


def test_impulses_of_the_start_are_taken_again(rng) -> None:
    contacts = np.zeros(3, contact_dtype(TORQUES))
    names = ("lambda_n", "lambda_1", "lambda_2", "psi_n", "psi_1", "psi_2")
    for name in names:
        contacts[name] = rng.normal(size=3)
    kept = contacts[list(names)].copy()
    interpreted(midpoint_geometry.make_keep_start(TORQUES))(records(contacts), 2)
    for name in names:
        contacts[name] = 7.0
    take = interpreted(midpoint_geometry.make_take_kept(TORQUES))
    for contact in records(contacts):
        take(contact)
    for name in names:
        assert contacts[name].tolist() == [*kept[name][:2], 0.0]


def test_boxes_and_hulls_have_flat_faces_alone() -> None:
    flat = interpreted(midpoint_geometry.has_flat_faces)
    kinds = ("plane", "sphere", "box", "capsule", "cylinder", "hull")
    found = [flat(SimpleNamespace(shape=kind)) for kind in range(len(kinds))]
    assert found == [kind in ("box", "hull") for kind in kinds]


def test_a_contact_that_stays_has_all_of_the_start_where_its_body_stands(rng) -> None:
    """Place, normal, way aside, lever of the patch and arms of a joint; B carries it, or A."""
    spec = TORQUES.including("compound", "contact_patch", "contact_torque", "joint")
    for mover, other in ((1, 0), (0, 1)):
        contacts, bodies = np.zeros(1, contact_dtype(spec)), allocate_bodies(spec, 2)
        contacts["b"], contacts["bilateral"], bodies["inv_m"][mover] = 1, 1, 1.0
        places = ("", "n", "tangential_", "patch_", "arm_a", "arm_b")
        drawn = {prefix: rng.normal(size=3) for prefix in places}
        for prefix, vector_of in drawn.items():
            put_vector(contacts[0], prefix, vector_of)
        interpreted(midpoint_geometry.make_keep_start(spec))(records(contacts), 1)
        for prefix in places:
            put_vector(contacts[0], prefix, rng.normal(size=3))
        for body in bodies:
            put_vector(body, "", rng.normal(size=3))
        poses, shift = bodies.copy(), rng.normal(size=3)
        put_vector(bodies[mover], "", vector(bodies[mover]) + shift)
        put_vector(bodies[other], "", rng.normal(size=3))
        stay = interpreted(midpoint_geometry.make_stay(spec))
        stay(records(contacts)[0], records(bodies), records(poses))
        for prefix, expected in drawn.items():
            moved = shift if prefix == "" else 0.0
            np.testing.assert_allclose(vector(contacts[0], prefix), expected + moved, atol=1e-14)
