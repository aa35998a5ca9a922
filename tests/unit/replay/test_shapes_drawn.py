"""The geometry of bodies as it is drawn: planes by their half space, all else in pieces."""

from __future__ import annotations

import numpy as np

from lavendersim.replay.shapes import shapes
from tests.made_cells import ORIGIN, UPRIGHT, made_cell

BALL = {"kind": "sphere", "radius": 0.25}
PARTS = [
    {"shape": BALL, "position": [0.0, 0.0, z], "orientation": UPRIGHT} for z in (-1.0, 0.0, 1.0)
]
CELL = made_cell(
    {
        "wall": {"shape": {"kind": "plane", "normal": [0.0, 1.0, 0.0], "offset": -2.0}},
        "ball": {"shape": BALL},
        "slab": {"shape": {"kind": "box", "size": [2.0, 2.0, 1.0]}, "fixed": True},
        "beads": {"shape": {"kind": "compound", "parts": PARTS, "centre": ORIGIN, "axes": UPRIGHT}},
    }
)


def test_bodies_in_their_order_with_what_is_drawn_of_them() -> None:
    wall, ball, slab, beads = shapes(CELL)
    assert [one.name for one in (wall, ball, slab, beads)] == list(CELL.scene.bodies)
    assert (wall.kind, wall.pieces, wall.bounding_radius) == ("plane", (), 0.0)
    assert np.asarray(wall.normal).tolist() == [0.0, 1.0, 0.0]
    assert wall.offset == -2.0
    assert (ball.kind, len(ball.pieces), ball.bounding_radius) == ("sphere", 1, 0.25)
    assert [one.fixed for one in (wall, ball, slab, beads)] == [True, False, True, False]
    assert len(beads.pieces) == 3
    assert beads.bounding_radius == 1.25


def test_a_cavity_is_drawn_as_what_it_is_around() -> None:
    cell = made_cell(
        {
            "bowl": {"shape": {"kind": "bowl", "radius": 2.0}, "fixed": True},
            "drum": {"shape": {"kind": "drum", "radius": 2.0}, "fixed": True},
            "ball": {"shape": BALL},
        }
    )
    bowl, drum, _ = shapes(cell)
    assert (bowl.kind, bowl.bounding_radius, drum.bounding_radius) == ("bowl", 2.0, 2.0)
    assert [one.shape.kind for one in (*bowl.pieces, *drum.pieces)] == ["sphere", "cylinder"]
    assert [one.shape.radius for one in (*bowl.pieces, *drum.pieces)] == [2.0, 2.0]


def test_a_mesh_is_drawn_by_its_triangles() -> None:
    mesh = {"kind": "mesh", "vertices": [[0, 0, 0], [3, 0, 0], [3, 4, 0]], "triangles": [[0, 1, 2]]}
    ground, _ = shapes(made_cell({"it": {"shape": mesh, "fixed": True}, "ball": {"shape": BALL}}))
    assert (ground.kind, ground.fixed, ground.pieces, ground.bounding_radius) == (
        "mesh",
        True,
        (),
        5,
    )
    assert ground.mesh is not None
    assert ground.mesh.triangles == ((0, 1, 2),)
