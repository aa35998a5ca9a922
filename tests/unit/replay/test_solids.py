"""What rerun is given of a body's pieces is their geometry, in the body's own frame."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import rerun as rr

from lavendersim.geometry.shapes import Piece
from lavendersim.replay.shapes import DrawnBody, shapes
from lavendersim.replay.solids import BodyLook, archetypes
from tests.made_cells import MadeShape
from tests.oracle.cells import cell

LOOK = BodyLook((1, 2, 3), False, "thing", True)
TURN = [0.5, 0.5, 0.5, 0.5]  # w x y z: x to y, y to z, z to x
TETRA = {
    "kind": "hull",
    "points": [
        [-0.25, -0.25, -0.25],
        [0.75, -0.25, -0.25],
        [-0.25, 0.75, -0.25],
        [-0.25, -0.25, 0.75],
    ],
    "faces": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
}


def shape_of(shape: dict[str, Any]) -> DrawnBody:
    bodies = {"thing": {"shape": shape, "mass": 1.0}}
    return shapes(cell({"scene": {"bodies": bodies}}))[0]


def placed(*of: dict[str, Any]) -> DrawnBody:
    parts = [{"shape": one, "position": [0, 0, 1], "orientation": TURN} for one in of]
    return shape_of({"kind": "compound", "parts": parts})


def values(component: Any) -> np.ndarray:
    return np.array(component.as_arrow_array().to_pylist())


def test_capsule_is_centred_although_rerun_begins_it_at_one_end() -> None:
    rod = {"kind": "capsule", "radius": 0.1, "length": 0.6}
    for shape, begin in ((shape_of(rod), [0, 0, -0.3]), (placed(rod), [-0.3, 0, 1])):
        ((form,),) = archetypes(shape.pieces, LOOK).values()
        assert isinstance(form, rr.Capsules3D)
        assert values(form.lengths) == pytest.approx([0.6])
        assert values(form.radii) == pytest.approx([0.1])
        np.testing.assert_allclose(values(form.translations), [begin], atol=1e-7)  # float32
    np.testing.assert_allclose(values(form.quaternions), [[0.5] * 4])


def test_each_kind_of_piece_is_drawn_once() -> None:
    ball, box = {"kind": "sphere", "radius": 0.1}, {"kind": "box", "size": [1, 2, 3]}
    drawn = archetypes(placed(ball, box, ball).pieces, LOOK)
    assert list(drawn) == ["sphere", "box"]
    assert len(values(drawn["sphere"][0].half_sizes)) == 2
    np.testing.assert_allclose(values(drawn["box"][0].half_sizes), [[0.5, 1.0, 1.5]])
    np.testing.assert_allclose(values(drawn["box"][0].centers), [[0, 0, 1]])


def test_cylinder_stands_along_z() -> None:
    (form,) = archetypes(shape_of({"kind": "cylinder", "radius": 0.1, "length": 0.6}).pieces, LOOK)[
        "cylinder"
    ]
    assert (values(form.lengths), values(form.radii)) == (
        pytest.approx([0.6]),
        pytest.approx([0.1]),
    )


def test_faces_of_a_hull_are_the_triangles_of_its_mesh() -> None:
    mesh, lines = archetypes(placed(TETRA).pieces, LOOK)["hull"]
    corners = values(mesh.vertex_positions).reshape(4, 3, 3)
    moved = np.array(TETRA["points"])[:, [2, 0, 1]] + [0, 0, 1]
    expected = moved[np.array(TETRA["faces"])]
    np.testing.assert_allclose(corners, expected, atol=1e-7)
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert ((corners.mean(axis=1) - [0, 0, 1]) * outward).sum(axis=1).min() > 0
    assert len(values(lines.strips)) == 4


def test_a_shape_without_a_form_of_its_own_is_the_hull_of_its_corners() -> None:
    turned = Piece(MadeShape(), np.array([0.0, 0.0, 1.0]), np.array(TURN))
    (mesh, lines) = archetypes([turned], LOOK)["made"]
    expected, _ = archetypes(placed(TETRA).pieces, LOOK)["hull"]
    corners, others = (np.unique(values(one.vertex_positions), axis=0) for one in (mesh, expected))
    np.testing.assert_allclose(corners, others, atol=1e-7)
    assert len(values(lines.strips)) == 4


def test_reach_holds_every_piece() -> None:
    rod = {"kind": "capsule", "radius": 0.1, "length": 0.6}
    assert shape_of(rod).bounding_radius == pytest.approx(0.4)
    assert placed(rod).bounding_radius == pytest.approx(1.4)
    can = shape_of({"kind": "cylinder", "radius": 0.3, "length": 0.8})
    assert can.bounding_radius == pytest.approx(0.5)
    assert shape_of(TETRA).bounding_radius == pytest.approx(np.linalg.norm([0.75, 0.25, 0.25]))
