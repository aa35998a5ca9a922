"""Scratch of meshes has room for the points of every face and edge at once."""

from __future__ import annotations

import numpy as np

from lavendersim.engine.collide.mesh_tables import CORNER, EDGE, GROUP, MeshTables, with_room
from lavendersim.engine.collide.scratch import allocate_scratch
from lavendersim.engine.records import BODY, dtype

NONE = np.zeros(0)


def tables(faces: int, edges: int) -> MeshTables:
    return MeshTables(
        nodes=NONE,
        triangles=NONE,
        groups=np.zeros(faces, dtype(GROUP)),
        sides=NONE,
        edges=np.zeros(edges, dtype(EDGE)),
        corners=np.zeros(0, dtype(CORNER)),
        spokes=NONE,
        **dict.fromkeys(("stamp", "row", "points", "normals", "counts"), NONE),
    )


def test_room_grows_with_faces_edges_and_what_one_face_may_have() -> None:
    bodies = dtype(BODY)
    small, large = (with_room(tables(*size), bodies, 20) for size in ((1, 4), (6, 12)))
    assert len(small.points) >= 20 + 4 * 4
    assert len(large.points) >= 6 * 20 + 4 * 12
    assert len(large.normals) == 3 * len(large.points)
    assert large.row.dtype == bodies
    assert len(with_room(tables(6, 12), bodies, 200).points) >= 6 * 200


def test_what_is_seen_is_marked_in_rows_of_its_own() -> None:
    shared, bodies = tables(2, 3), dtype(BODY)
    for rooms in (with_room(shared, bodies, 20), with_room(shared, bodies, 20)):
        assert not rooms.groups["seen"].any()
        assert not rooms.edges["seen"].any()
        rooms.groups["seen"] = rooms.edges["seen"] = 1


def test_a_manifold_has_as_much_room_as_a_mesh_may_have_points() -> None:
    scratch = allocate_scratch(None, True, tables(50, 300), dtype(BODY))
    assert len(scratch.manifold.points) >= len(scratch.meshes.points)
    assert len(scratch.manifold.normal) == 3 + 3 * len(scratch.manifold.points)


def test_without_meshes_there_are_no_tables() -> None:
    assert allocate_scratch().meshes == ()
