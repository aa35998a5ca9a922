"""Records of collision detection are copied whole; vectors go in and out by component."""

from __future__ import annotations

import numpy as np
from interpreted import interpreted, records

from lavendersim.engine.collide import records as own
from lavendersim.engine.collide.records import FACE, PLANE_OF_FEATURE, SEPARATION, VERTEX
from lavendersim.engine.records import dtype
from lavendersim.engine.vectors import Vec3


def filled(fields, rows: int = 2) -> np.ndarray:
    """Return records whose first row has numbers that are all different, and the others none."""
    made = np.zeros(rows, dtype(fields))
    for k, name in enumerate(made.dtype.names):
        made[name][0] = k + 1.0
    return made


def test_vertices_and_separations_are_copied_field_by_field() -> None:
    for copy, fields in ((own.copy_vertex, VERTEX), (own.copy_separation, SEPARATION)):
        rows, source = filled(fields), filled(fields)[0]
        interpreted(copy)(*records(rows))
        assert rows[0] == rows[1] == source
        rows[0]["ax"] = 99.0  # a copy, not a reference
        assert rows[1] != rows[0]


def test_witness_points_are_copied_without_the_rest() -> None:
    rows = filled(SEPARATION)
    interpreted(own.copy_witness)(*records(rows))
    for name in rows.dtype.names:
        assert rows[name][1] == (rows[name][0] if name[0] in "ab" else 0.0)


def test_normals_and_positions_go_in_and_out_by_component() -> None:
    rows = np.zeros(1, dtype(PLANE_OF_FEATURE))
    record = records(rows)[0]
    interpreted(own.put_normal)(record, Vec3(1.0, 2.0, 3.0))
    interpreted(own.put_position)(record, Vec3(4.0, 5.0, 6.0))
    assert rows[0].tolist() == (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.0)
    assert interpreted(own.normal_of)(record) == Vec3(1.0, 2.0, 3.0)


def test_kinds_of_features_differ_and_a_face_has_what_a_mesh_asks() -> None:
    assert len({own.POINT, own.LINE, own.FACE_LOOP, own.DISC}) == 4
    assert own.NO_FEATURE.kind == own.POINT
    assert {name for name, _ in FACE} == {"nx", "ny", "nz", "offset", "alive", "seen_by"}
