"""Tables of meshes: faces of coplanar triangles, straight sharp edges, a tree of triangles."""

from __future__ import annotations

import numpy as np
import pytest
from mesh_tables_of import BOX, GRID

from lavendersim.cell import CellMesh
from lavendersim.engine.collide.mesh_tables import CONCAVE, CONVEX, FLAT, FOLDED, FREE
from lavendersim.geometry import triangle_mesh
from lavendersim.scene.triangle_tables import mesh_tables


def test_a_box_has_six_faces_and_twelve_edges_with_all_its_corners() -> None:
    tables, spans = mesh_tables([BOX])
    assert spans == [(0, 23)]
    assert (len(tables.triangles), len(tables.groups), len(tables.edges)) == (12, 6, 12)
    np.testing.assert_array_equal(np.sort(tables.groups["offset"]), 0.5)
    np.testing.assert_array_equal(tables.edges["length"], 0.5)
    kinds = tables.sides["kind"]
    assert [int(np.sum(kinds == kind)) for kind in (FREE, FLAT, CONVEX, CONCAVE)] == [0, 12, 24, 0]
    assert (tables.sides["edge"] >= 0).sum() == 24


def test_a_flat_grid_is_one_face_within_four_edges() -> None:
    tables, _ = mesh_tables([GRID])
    assert (len(tables.groups), len(tables.edges)) == (1, 4)
    np.testing.assert_array_equal(tables.edges["length"], 1.5)
    assert set(tables.edges["free"]) == {1}


@pytest.mark.parametrize(("height", "kind"), [(0.2, CONVEX), (-0.2, CONCAVE)])
def test_a_fold_is_convex_where_it_turns_away(height: float, kind: int) -> None:
    fold = CellMesh(
        kind="mesh",
        vertices=((0, 0, height), (0, 1, height), (-1, 0, 0), (1, 0, 0)),
        triangles=((0, 1, 2), (1, 0, 3)),
    )
    tables, _ = mesh_tables([fold])
    assert sorted(tables.sides["kind"]) == sorted([FREE] * 4 + [kind] * 2)
    assert len(tables.edges) == (5 if kind == CONVEX else 4)


def test_a_sheet_with_two_faces_has_a_rim() -> None:
    sheet = CellMesh(
        kind="mesh",
        vertices=((0.1, 0.2, 0.3), (1, 0.3, 0.7), (0.4, 1, 0.9)),
        triangles=((0, 1, 2), (0, 2, 1)),
    )
    tables, _ = mesh_tables([sheet])
    assert (len(tables.groups), len(tables.edges)) == (2, 3)
    assert set(tables.sides["kind"]) == {FOLDED}
    assert sorted(tables.sides["edge"]) == [0, 0, 1, 1, 2, 2]


def test_a_straight_edge_does_not_turn_back(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sides that overlap, as where a large mesh is not looked through, make no edge of length 0."""
    monkeypatch.setattr(triangle_mesh, "MOST_RIM", 0)
    places = ((0, 0, 0), (2, 0, 0), (1, 0, 0), (1, -1, 0), (1, 1, 0), (3, 0, 0))
    triangles = ((0, 3, 1), (0, 2, 4), (2, 1, 4), (3, 5, 1), (1, 5, 4))
    tables, _ = mesh_tables([CellMesh(kind="mesh", vertices=places, triangles=triangles)])
    assert (tables.edges["length"] >= 0.5).all()


def test_a_walk_that_meets_every_box_comes_by_every_triangle_once() -> None:
    tables, spans = mesh_tables([BOX, GRID])
    for (first, last), count, start in zip(spans, (12, 18), (0, 12), strict=True):
        nodes = tables.nodes[first:last]
        met = [t for t in nodes["triangle"] if t >= 0]
        assert sorted(met) == list(range(start, start + count))
        assert nodes["skip"][0] == last
        for k, node in enumerate(nodes):
            inside = nodes[k : node["skip"] - first]
            for axis in "xyz":
                assert (inside[f"low_{axis}"] >= node[f"low_{axis}"]).all()
                assert (inside[f"high_{axis}"] <= node[f"high_{axis}"]).all()


def test_rows_of_a_second_mesh_are_its_own() -> None:
    tables, _ = mesh_tables([BOX, GRID])
    assert set(tables.triangles["group"][:12]) == set(range(6))
    assert set(tables.triangles["group"][12:]) == {6}
    assert set(tables.sides["edge"][36:]) == {-1, 12, 13, 14, 15}


def test_no_mesh_is_tables_without_rows() -> None:
    tables, spans = mesh_tables([])
    assert spans == []
    assert len(tables.nodes) == len(tables.edges) == 0
    assert tables.nodes.dtype.names is not None
