"""Which points of a mesh touch: of a floor of triangles those of its plane, of sharp edges all.

A normal of a contact is that of a face, or lies between the normals of the faces around its edge.
"""

from __future__ import annotations

import math
from types import SimpleNamespace

import convex
import numpy as np
import pytest
from interpreted import interpreted, records
from mesh_contacts import BOX, KINDS, contacts, drawn, terrain, world
from single_bodies import body, manifold

from lavendersim.cell import CellMesh
from lavendersim.engine.collide.manifold.mesh_points import put, put_left_out
from lavendersim.engine.records import POINT, dtype
from lavendersim.engine.vectors import Vec3

ORIGIN = np.zeros(3)
# Nine triangles around two inner corners, thin ones among them, 4 m wide.
FLOOR = CellMesh(
    kind="mesh",
    vertices=(
        *((-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0), (0.1, 0.05, 0)),
        *((0.13, 0.06, 0), (-0.4, 0.3, 0)),
    ),
    triangles=(
        *((0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 3, 5), (3, 6, 5), (6, 4, 5)),
        *((3, 0, 6), (0, 4, 6)),
    ),
)
RIDGE = 0.2  # height of the roof over its eaves, 1 m off [m]
ROOF = CellMesh(
    kind="mesh",
    vertices=((-1, -1, 0), (0, -1, RIDGE), (1, -1, 0), (-1, 1, 0), (0, 1, RIDGE), (1, 1, 0)),
    triangles=((0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4)),
)
VALLEY = ROOF.model_copy(update={"vertices": tuple((x, y, RIDGE - z) for x, y, z in ROOF.vertices)})


def lying(kind: str, rng: np.random.Generator, mesh: CellMesh = FLOOR):
    """Return a body near the middle, its hulls, and what touches within 0.1 m."""
    b, hulls = drawn(kind, rng, np.array([*rng.uniform(-0.3, 0.3, 2), 0.15]))
    return b, hulls, contacts(mesh, b, 0.1, hulls, at=ORIGIN)


@pytest.mark.parametrize("kind", KINDS)
def test_a_floor_of_triangles_touches_as_its_plane(kind: str) -> None:
    rng = np.random.default_rng([3, *kind.encode()])
    plane, touched = body("plane", (0.0, 0.0, 1.0), offset=0.0), 0
    for _ in range(8):
        b, hulls, (places, normals, phi, feature) = lying(kind, rng)
        its = manifold(f"{kind}_plane", plane, b, 0.1, hulls)
        np.testing.assert_array_equal(places, its.points)
        np.testing.assert_array_equal(phi, its.phi)
        np.testing.assert_array_equal(normals, np.tile((0.0, 0.0, 1.0), (len(phi), 1)))
        assert len({*feature}) == len(feature)
        touched += len(phi)
    assert touched > 4


def ball(place, radius: float = 0.1):
    return body("sphere", (radius, 0.0, 0.0), place)


def test_over_a_ridge_the_normal_lies_between_the_two_slopes() -> None:
    steepest = math.sin(math.atan(RIDGE))
    for aside in np.linspace(-0.05, 0.05, 21):
        _, (n,), (phi,), _ = contacts(ROOF, ball((aside, 0.1, RIDGE + 0.12)), 0.2, at=ORIGIN)
        edge = math.hypot(aside, 0.12)
        if abs(aside) / edge < steepest - 1e-9:  # nearest to the ridge itself
            np.testing.assert_allclose(n, (aside / edge, 0.0, 0.12 / edge), atol=1e-14)
            assert phi == pytest.approx(edge - 0.1, abs=1e-15)
        else:
            assert abs(n[0]) == pytest.approx(steepest, abs=1e-14)


def test_in_a_valley_both_slopes_touch_and_its_edge_never() -> None:
    for aside in np.linspace(-0.02, 0.02, 9):
        _, normals, phi, _ = contacts(VALLEY, ball((aside, 0.3, 0.11)), 0.05, at=ORIGIN)
        steepest = math.sin(math.atan(RIDGE))
        assert sorted(normals[:, 0]) == pytest.approx([-steepest, steepest], abs=1e-14)
        level = (0.11 - RIDGE * abs(aside)) * math.cos(math.atan(RIDGE)) - 0.1
        assert phi.min() == pytest.approx(level, abs=1e-15)


def test_a_floor_ends_at_the_wall_on_it() -> None:
    """Behind the wall, 5.7 m of it, there is no floor; 2 mm behind it a ball is pushed out."""
    mesh = CellMesh(
        kind="mesh",
        vertices=((0, 0, 0), (10, 0, 0), (0, 10, 0), (10, 0, 3), (0, 10, 3)),
        triangles=((0, 1, 2), (2, 1, 3), (2, 3, 4)),
    )
    assert len(contacts(mesh, ball((9, 9, 0.05)), 0.01, at=ORIGIN)[2]) == 0
    inward = 5.0 + 0.002 / math.sqrt(2)
    _, (n,), (phi,), _ = contacts(mesh, ball((inward, inward, 0.05)), 0.01, at=ORIGIN)
    np.testing.assert_array_equal(n, (0.0, 0.0, 1.0))
    assert phi == pytest.approx(-0.05, abs=1e-15)


def test_a_sheet_with_two_faces_is_touched_from_both_and_at_its_rim() -> None:
    sheet = CellMesh(
        kind="mesh", vertices=((0, 0, 0), (2, 0, 0), (0, 2, 0)), triangles=((0, 1, 2), (0, 2, 1))
    )
    for side in (1.0, -1.0):
        for height in (0.12, 0.05):
            _, (n,), (phi,), _ = contacts(sheet, ball((0.5, 0.5, side * height)), 0.1, at=ORIGIN)
            np.testing.assert_array_equal(n, (0.0, 0.0, side))
            assert phi == pytest.approx(height - 0.1, abs=1e-15)
    _, (n,), (phi,), _ = contacts(sheet, ball((1.0, -0.12, 0.0)), 0.1, at=ORIGIN)
    np.testing.assert_allclose(n, (0.0, -1.0, 0.0), atol=1e-15)
    assert phi == pytest.approx(0.02, abs=1e-15)
    _, (n,), (phi,), _ = contacts(sheet, ball((-0.12, -0.16, 0.0)), 0.15, at=ORIGIN)
    np.testing.assert_allclose(n, (-0.6, -0.8, 0.0), atol=1e-14)
    assert phi == pytest.approx(0.1, abs=1e-15)


def test_a_body_behind_a_surface_does_not_touch_it() -> None:
    assert len(contacts(FLOOR, ball((0.3, 0.2, -0.05)), 0.2, at=ORIGIN)[2]) == 0
    (phi,) = contacts(FLOOR, ball((0.3, 0.2, 0.05)), 0.2, at=ORIGIN)[2]
    assert phi == pytest.approx(-0.05, abs=1e-15)


def test_a_box_half_over_a_table_touches_at_the_tables_edge() -> None:
    half, top = 0.1, 0.5
    b = body("box", (half, half, half), (0.47, 0.1, top + half - 1e-6))
    places, normals, phi, _ = contacts(BOX, b, 1e-3, at=ORIGIN)
    np.testing.assert_array_equal(normals, np.tile((0.0, 0.0, 1.0), (4, 1)))
    np.testing.assert_allclose(phi, -1e-6, atol=1e-15)
    corners = [(x, y) for x in (0.37, 0.5) for y in (0.0, 0.2)]
    found = places[np.lexsort(places[:, 1::-1].round(9).T)][:, :2]
    np.testing.assert_allclose(found, corners, atol=2e-9)  # cuts reach as far as surfaces touch


def test_a_plate_over_a_rim_keeps_its_lower_corners() -> None:
    half, rest = 0.005, 0.001
    table = CellMesh(
        kind="mesh", vertices=((-1, -1, 0), (1, -1, 0), (-1, 1, 0)), triangles=((0, 1, 2),)
    )
    plate = body("box", (0.1, 0.1, half), (-0.05, -0.05, half + rest))
    places, _, phi, _ = contacts(table, plate, 0.02, at=ORIGIN)
    np.testing.assert_allclose(phi, rest, atol=1e-15)
    for corner in ((-0.15, -0.15), (-0.15, 0.05), (0.05, -0.15)):  # the fourth is beside the table
        assert np.linalg.norm(places[:, :2] - corner, axis=1).min() < 2e-9


def test_a_column_deep_in_a_block_is_pushed_out_of_the_face_that_it_is_in_front_of() -> None:
    """Its foot is 0.35 m under the top and 0.15 m from a side, which its centre is behind."""
    column = body("box", (0.05, 0.05, 0.4), (0.3, 0.0, 0.55))
    _, normals, phi, _ = contacts(BOX, column, 0.01, at=ORIGIN)
    np.testing.assert_array_equal(normals, np.tile((0.0, 0.0, 1.0), (4, 1)))
    np.testing.assert_allclose(phi, -0.35, atol=1e-15)


def test_what_is_left_out_takes_no_room_of_what_is_kept() -> None:
    point, row = np.zeros(1, dtype(POINT)), np.zeros(3, dtype(POINT))
    counts, normals = np.zeros(2, np.int64), np.zeros(9)
    room = SimpleNamespace(points=records(row), counts=counts, normals=normals)
    keep, leave = interpreted(put), interpreted(put_left_out)
    for name in (1, 2, 3, 4):
        leave(room, records(point)[0], Vec3(0.0, 0.0, 1.0), name)
    assert (row["feature"].tolist(), counts.tolist()) == ([3, 2, 1], [0, 3])
    for name in (11, 12, 13, 14):
        keep(room, records(point)[0], Vec3(0.0, 0.0, 1.0), name)
    assert (row["feature"].tolist(), counts.tolist()) == ([11, 12, 13], [3, 0])


@pytest.mark.parametrize("kind", ["sphere", "box", "cylinder"])
def test_no_normal_leads_into_a_face_beside_its_point(kind: str) -> None:
    """For what is apart: no triangle with the point on it rises along the normal."""
    rng = np.random.default_rng([9, *kind.encode()])
    checked = 0
    for _ in range(12):
        mesh, turn = terrain(rng), convex.random_rotation(rng)
        b, hulls = drawn(kind, rng, turn @ rng.uniform((-0.4, -0.4, 0.5), (0.4, 0.4, 0.8)))
        places, normals, phi, _ = contacts(mesh, b, 0.3, hulls, at=ORIGIN, turn=turn)
        for place, n, gap in zip(places, normals, phi, strict=True):
            foot = place - 0.5 * gap * n
            for triangle in world(mesh, ORIGIN, turn):
                a, b_, c = triangle
                weights, left, *_ = np.linalg.lstsq(
                    np.column_stack([b_ - a, c - a]), foot - a, rcond=None
                )
                on = len(left) and left[0] < 1e-18 and min(*weights, 1.0 - sum(weights)) > -1e-9
                if gap > 0.0 and on:
                    assert ((triangle - foot) @ n).max() < 1e-7
                    checked += 1
    assert checked > 6
