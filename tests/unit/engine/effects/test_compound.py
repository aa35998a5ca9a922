"""Parts of compounds follow their owners, and moving surfaces are seen along the tangents."""

from __future__ import annotations

import numpy as np
from laboratory import body, config, plane, resolved

from lavendersim.engine.effects import compound, surface_velocity
from lavendersim.engine.spec import Spec
from lavendersim.geometry.rotations import rotation_matrix
from lavendersim.scene.body_rows import part_pose
from lavendersim.scene.build import build
from lavendersim.scene.colliders import parts_of

SPHERE = {"kind": "sphere", "radius": 0.1}
BOX = {"kind": "box", "size": [0.2, 0.3, 0.4]}
SPEC = Spec(effects=("compound", "friction", "rotation", "surface_velocity"))


def quaternion(seed: int) -> np.ndarray:
    q = np.random.default_rng(seed).normal(size=4)
    return q / np.linalg.norm(q)


def test_parts_stand_where_the_scene_puts_them_in_every_pose() -> None:
    parts = [
        {"shape": SPHERE, "position": [0.5, 0.1, 0.0]},
        {"shape": BOX, "position": [-0.5, 0, 0.2], "orientation": [1.0, 2.0, 0.5, -1.0]},
    ]
    thing = body({"kind": "compound", "parts": parts}, (1, 2, 3))
    cell = config(resolved({"floor": plane(), "thing": thing}))
    scene = build(cell, SPEC)
    bodies = scene.bodies
    place_parts = compound.make(SPEC)
    for seed in range(3):
        pose = np.concatenate([[0.1 * seed, 5.0, -2.0], quaternion(seed)])
        row = bodies[1]
        for name, value in zip(("x", "y", "z", "qw", "qx", "qy", "qz"), pose, strict=True):
            row[name] = value
        turn = rotation_matrix(pose[3:])
        for i in range(3):
            for j in range(3):
                row[f"r{i}{j}"] = turn[i, j]
        place_parts(bodies)
        for part, described in zip(
            bodies[2:], parts_of(cell.scene.bodies["thing"].shape), strict=True
        ):
            expected = part_pose(pose, described)
            found = [part[k] for k in ("x", "y", "z", "qw", "qx", "qy", "qz")]
            np.testing.assert_allclose(found, expected, atol=2e-15)
            matrix = [part[f"r{i}{j}"] for i in range(3) for j in range(3)]
            np.testing.assert_allclose(matrix, rotation_matrix(expected[3:]).ravel(), atol=4e-15)
    assert bodies[0]["x"] == 0.0  # what is no part stays


def test_surface_moves_along_the_tangents_in_the_bodies_frames() -> None:
    belt = body(BOX, surface_velocity=(0.3, -0.2, 0.5), orientation=quaternion(1))
    floor = plane(surface_velocity=(1.0, 2.0, 3.0))
    scene = build(config(resolved({"floor": floor, "belt": belt})), SPEC)
    frame, _ = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))
    fields = [f"t{k}{axis}" for k in "12" for axis in "xyz"] + ["surface_1", "surface_2"]
    contact = np.zeros(1, [(name, "f8") for name in fields]).view(np.recarray)
    for k in (1, 2):
        for axis, value in zip("xyz", frame[:, k], strict=True):
            contact[f"t{k}{axis}"] = value
    bodies = scene.bodies.view(np.recarray)
    surface_velocity.make(SPEC)(contact[0], bodies[0], bodies[1])
    moving = rotation_matrix(quaternion(1)) @ [0.3, -0.2, 0.5] - [1.0, 2.0, 3.0]
    found = [contact["surface_1"][0], contact["surface_2"][0]]
    np.testing.assert_allclose(found, moving @ frame[:, 1:], atol=2e-15)
