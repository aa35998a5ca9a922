"""Rows of the body table: shapes, masses, parts behind their owners, and what effects bring."""

from __future__ import annotations

import json

import numpy as np
import pytest
from laboratory import body, config, plane, resolved

from lavendersim.cell import CellBody, CellPart, Sphere
from lavendersim.engine.records import CAPSULE, COMPOUND, CYLINDER, HULL, SPHERE
from lavendersim.engine.spec import Spec
from lavendersim.geometry.rotations import rotation_matrix
from lavendersim.geometry.shapes import bounding_radius
from lavendersim.scene.body_rows import part_pose
from lavendersim.scene.build import Scene, build
from lavendersim.scene.colliders import parts_of

TETRA = {"kind": "hull", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}
EFFECTS = ("compound", "drag", "kinematic", "rotation", "surface_velocity")
SPEC = Spec(effects=EFFECTS, shape_pairs=("hull_hull", "hull_plane", "sphere_plane"))
TURN = np.array([0.5, -0.5, 0.5, 0.5])


def built(**bodies: dict) -> Scene:
    return build(config(resolved({"floor": plane(), **bodies})), SPEC)


def test_sizes_of_round_shapes() -> None:
    scene = built(
        pill=body({"kind": "capsule", "radius": 0.1, "length": 0.6}),
        can=body({"kind": "cylinder", "radius": 0.4, "length": 0.6}),
    )
    pill, can = scene.bodies[1], scene.bodies[2]
    assert (pill["shape"], pill["hx"], pill["hz"], pill["bound"]) == (CAPSULE, 0.1, 0.3, 0.4)
    assert (can["shape"], can["hx"], can["hz"], can["bound"]) == (CYLINDER, 0.4, 0.3, 0.5)


@pytest.mark.parametrize(
    "shape",
    [
        TETRA,
        {"kind": "compound", "parts": [{"shape": TETRA}, {"shape": TETRA, "position": [2, 0, 0]}]},
    ],
)
def test_bounding_radius_holds_every_corner(shape: dict) -> None:
    made = CellBody.model_validate_json(json.dumps(body(shape))).shape
    parts = parts_of(made) or (CellPart(shape=made, position=(0, 0, 0), orientation=(1, 0, 0, 0)),)
    far = 0.0
    for part in parts:
        turn = rotation_matrix(np.array(part.orientation, float))
        points = np.array(part.shape.points) @ turn.T + part.position
        far = max(far, np.linalg.norm(points, axis=1).max())
    bound = bounding_radius(made)
    assert far <= bound * (1 + 1e-15)
    assert shape["kind"] == "compound" or bound == pytest.approx(far, rel=1e-15)


def test_equal_hulls_share_one_row_of_the_tables() -> None:
    other = {"kind": "hull", "points": [[0, 0, 0], [2, 0, 0], [0, 1, 0], [0, 0, 1]]}
    scene = built(one=body(TETRA), two=body(other), three=body(TETRA))
    assert (scene.bodies["shape"][1:] == HULL).all()
    assert scene.bodies["hull"][1:].tolist() == [0, 1, 0]
    # two hulls of 4 corners, and the unit box behind them
    assert scene.hulls.vertex_start.tolist() == [0, 4, 8, 16]


def test_faces_of_a_hull_turn_left_seen_from_outside() -> None:
    tables = built(one=body(TETRA)).hulls
    for face in range(4):
        assert tables.offsets[face] > 0.0  # the centre of mass is inside
        corners = tables.vertices[tables.vertex_start[0] : tables.vertex_start[1]]
        assert (corners @ tables.normals[face] <= tables.offsets[face] + 1e-15).all()


def test_parts_stand_behind_all_bodies_in_the_pose_of_their_owner() -> None:
    parts = [
        {"shape": {"kind": "sphere", "radius": 0.1}, "position": [0.5, 0.2, 0]},
        {"shape": TETRA, "position": [-0.5, 0, 0.1], "orientation": [1, 2, 3, 4]},
    ]
    thing = body({"kind": "compound", "parts": parts}, (1, 2, 3), orientation=TURN, mass=4.0)
    scene = built(thing=thing, ball=body({"kind": "sphere", "radius": 0.3}, (9, 0, 0)))
    rows = scene.bodies
    assert rows["shape"][1:].tolist() == [COMPOUND, SPHERE, SPHERE, HULL]
    assert rows["owner"].tolist() == [0, 1, 2, 1, 1]
    assert (scene.names, len(scene.poses)) == (["floor", "thing", "ball"], 3)
    assert len(scene.velocities) == len(rows) == 5
    assert rows["inv_m"].tolist() == [0.0, 0.25, 1.0, 0.0, 0.0]
    turn = rotation_matrix(TURN)
    for row, part in zip(rows[3:], thing["shape"]["parts"], strict=True):
        expected = np.array([1, 2, 3]) + turn @ part["position"]
        np.testing.assert_allclose([row["x"], row["y"], row["z"]], expected, atol=1e-15)
        matrix = np.array([[row[f"r{i}{j}"] for j in range(3)] for i in range(3)])
        own = rotation_matrix(np.array(part["orientation"]))
        np.testing.assert_allclose(matrix, turn @ own, atol=1e-15)
        assert [row["px"], row["py"], row["pz"]] == part["position"]


def test_a_part_turns_with_its_owner() -> None:
    rng = np.random.default_rng(2)
    one, other = (q / np.linalg.norm(q) for q in rng.normal(size=(2, 4)))
    ball = Sphere(kind="sphere", radius=1.0)
    part = CellPart(shape=ball, position=(0, 0, 2), orientation=tuple(other.tolist()))
    pose = part_pose(np.array([1, 0, 0, *one]), part)
    np.testing.assert_allclose(pose[:3], [1, 0, 0] + 2 * rotation_matrix(one)[:, 2], atol=1e-15)
    together = rotation_matrix(one) @ rotation_matrix(other)
    np.testing.assert_allclose(rotation_matrix(pose[3:]), together, atol=1e-15)


def test_columns_of_effects_are_filled() -> None:
    belt = body(
        {"kind": "sphere", "radius": 0.1}, kinematic=True, surface_velocity=(1.0, 2.0, 3.0),
        velocity=(0.5, 0.0, 0.0),
    )  # fmt: skip
    ball = body({"kind": "sphere", "radius": 0.1}, drag={"linear": 0.1, "angular": 0.3})
    scene = built(belt=belt, ball=ball)
    row = scene.bodies[1]
    assert (row["kinematic"], row["inv_m"]) == (1, 0.0)
    assert [row["sx"], row["sy"], row["sz"]] == [1.0, 2.0, 3.0]
    assert scene.velocities[1]["vx"] == 0.5
    row = scene.bodies[2]
    assert (row["kinematic"], row["inv_m"]) == (0, 1.0)
    drag = [row[f"drag_{name}"] for name in ("linear", "quadratic", "angular")]
    assert drag == [0.1, 0.0, 0.3]
