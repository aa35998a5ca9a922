"""Bodies beside a mesh: their contacts, and how far apart all triangles are by brute force.

The distance of two polyhedra that are apart is that of a corner of one and a triangle of the other,
or of two edges. Of a ball and a capsule the core is a point or a segment. A cylinder, an
ellipsoid and a cone are no farther than points of their surface; that they are no nearer says what
separates them.
"""

from __future__ import annotations

from itertools import combinations, product

import convex
import numpy as np
import pytest
import solids
from interpreted import interpreted, records
from scipy.spatial import ConvexHull
from single_bodies import body, hull, row, solid, spec_of, vertices_of

from lavendersim.cell import CellMesh
from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.collide.convex.hull_geometry import hull_geometry
from lavendersim.engine.collide.scratch import allocate_scratch
from lavendersim.engine.record_layout import allocate_bodies
from lavendersim.engine.records import MESH
from lavendersim.geometry.point_sets import hulls_meet
from lavendersim.scene.body_rows import MATRIX
from lavendersim.scene.triangle_tables import mesh_tables

KINDS = ("sphere", "capsule", "box", "hull", "cylinder", "ellipsoid", "cone")
CENTRE = np.array([0.3, -0.2, 0.5])
POSES = 12
FINE = 200  # points of a rim
ROUND = ("cylinder", "ellipsoid", "cone")
EXACT, PLACED = 1e-9, 1e-8  # [m] distances of GJK; points, whose error is that of the direction
BOX = CellMesh(
    kind="mesh",
    vertices=tuple(product((-0.5, 0.5), repeat=3)),
    triangles=tuple(
        (loop[0], loop[k], loop[k + 1])
        for loop in (
            (0, 1, 3, 2),
            (4, 6, 7, 5),
            (0, 4, 5, 1),
            (2, 3, 7, 6),
            (0, 2, 6, 4),
            (1, 5, 7, 3),
        )
        for k in (1, 2)
    ),
)


def terrain(rng: np.random.Generator, count: int = 4, most: float = 0.3) -> CellMesh:
    """Return an uneven ground of 2 (count - 1)^2 triangles, 1.5 m wide."""
    ticks = np.linspace(-0.75, 0.75, count)
    places = [(x, y, float(most * rng.uniform())) for x in ticks for y in ticks]
    cells = product(range(count - 1), repeat=2)
    corners = [(i * count + j, (i + 1) * count + j) for i, j in cells]
    triangles = [t for a, c in corners for t in ((a, c, c + 1), (a, c + 1, a + 1))]
    return CellMesh(kind="mesh", vertices=tuple(places), triangles=tuple(triangles))


def contacts(mesh: CellMesh, b, margin: float = 0.5, hulls=(), at=CENTRE, turn=None):
    """Return points, normals, separations and names."""
    kind = solids.KINDS[b[0]["shape"]]
    tables, (span,) = mesh_tables([mesh])
    spec = spec_of(f"{kind}_mesh")
    a = allocate_bodies(spec, 1)
    a[0]["shape"], a[0]["bound"] = MESH, mesh.bounding_radius()
    a[0]["x"], a[0]["y"], a[0]["z"] = at
    for name, value in zip(MATRIX, (np.eye(3) if turn is None else turn).ravel(), strict=True):
        a[0][name] = value
    a[0]["first_node"], a[0]["last_node"] = span
    room = allocate_scratch(hull_geometry(list(hulls)), True, tables, a.dtype)
    scratch = records(room)
    kernel = interpreted(SHAPE_PAIRS[f"{kind}_mesh"].make(spec))
    count = kernel(row(a), row(b), margin, scratch)
    found = scratch.manifold.points.array[:count]
    places = np.column_stack([found[axis] for axis in "xyz"])
    normals = scratch.manifold.normal[3 : 3 + 3 * count].reshape(-1, 3).copy()
    return places, normals, found["phi"].copy(), found["feature"].copy()


def drawn(kind: str, rng: np.random.Generator, centre: np.ndarray):
    """Return a body of the kind some 0.4 m wide, and its hulls."""
    half, matrix = rng.uniform(0.1, 0.25, 3), convex.random_rotation(rng)
    if kind == "hull":
        return hull(rng.normal(size=(12, 3)) * 0.1, centre, matrix)
    return body(kind, half, centre, matrix), []


def world(mesh: CellMesh, at: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Return the corners of its triangles in the world, (T, 3, 3) [m]."""
    return at + np.array(mesh.vertices)[np.array(mesh.triangles)] @ turn.T


def core(kind: str, it: solids.Solid) -> tuple[np.ndarray, float]:
    """Return points whose hull is the core, or nearly, and the radius that it is grown by."""
    half, turn = it.half, it.matrix
    if kind == "sphere":
        return it.centre[None], half[0]
    if kind == "capsule":
        return it.centre + np.outer([-1, 1], half[2] * turn[:, 2]), half[0]
    if kind in ("box", "hull"):
        return vertices_of(it), 0.0
    angle = np.linspace(0.0, 2.0 * np.pi, FINE, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(FINE)])
    if kind == "cylinder":
        local = np.concatenate([np.add(circle, (0, 0, end)) for end in (-1, 1)])
        return it.centre + (local * (half[0], half[0], half[2])) @ turn.T, 0.0
    if kind == "cone":
        rim = circle * half[0] - (0.0, 0.0, half[2])
        return it.centre + np.vstack([rim, (0.0, 0.0, 3.0 * half[2])]) @ turn.T, 0.0
    tilts = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 41)
    local = np.concatenate([np.add(np.cos(t) * circle[::4], (0, 0, np.sin(t))) for t in tilts])
    return it.centre + (local * half) @ turn.T, 0.0


def point_triangle(points: np.ndarray, triangle: np.ndarray) -> float:
    """Return the least distance of points (n, 3) to a triangle [m]: its inside, then its sides."""
    a, b, c = triangle
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal)
    heights = (points - a) @ normal
    feet = points - np.outer(heights, normal)
    sides = ((a, b), (b, c), (c, a))
    within = np.all([np.cross(q - p, feet - p) @ normal >= 0.0 for p, q in sides], axis=0)
    inside = np.abs(heights[within]).min() if within.any() else np.inf
    return min(float(inside), *(point_segment(points, p, q) for p, q in sides))


def point_segment(points: np.ndarray, p: np.ndarray, q: np.ndarray) -> float:
    along = q - p
    t = np.clip((points - p) @ along / (along @ along), 0.0, 1.0)
    return float(np.linalg.norm(points - p - np.outer(t, along), axis=1).min())


def edge_edge(p: np.ndarray, q: np.ndarray, r: np.ndarray, s: np.ndarray) -> float:
    """Return the distance of two segments whose insides are nearest; else infinity."""
    d, e, w = q - p, s - r, p - r
    matrix = np.array([[d @ d, -d @ e], [-d @ e, e @ e]])
    if abs(np.linalg.det(matrix)) < 1e-14:
        return np.inf  # parallel: their ends say it
    t, u = np.linalg.solve(matrix, [-d @ w, e @ w])
    if not (0.0 <= t <= 1.0 and 0.0 <= u <= 1.0):
        return np.inf
    return float(np.linalg.norm(w + t * d - u * e))


def distance(points: np.ndarray, triangle: np.ndarray) -> float:
    """Return how far the hull of points, which are apart from it, is from a triangle [m]."""
    if len(points) >= FINE:
        return point_triangle(points, triangle)
    faces: list = []
    edges: list = list(combinations(range(len(points)), 2)) if len(points) < 3 else []
    if len(points) > 3:
        faces = ConvexHull(points).simplices.tolist()
        edges = sorted({tuple(sorted(pair)) for face in faces for pair in combinations(face, 2)})
    found = [point_triangle(points, triangle)]
    found += [point_triangle(triangle, points[face]) for face in faces]
    for k in range(3):
        r, s = triangle[k], triangle[(k + 1) % 3]
        found += [edge_edge(points[i], points[j], r, s) for i, j in edges]
        if not faces and edges:
            found.append(point_segment(triangle, *points))
    return min(found)


def check_distances(kind: str) -> None:
    """Assert that the least gap is the distance, and that all gaps lie between the surfaces."""
    rng = np.random.default_rng([11, *kind.encode()])
    apart = 0
    for number in range(POSES):
        turn = convex.random_rotation(rng)
        mesh = BOX if number % 3 == 0 else terrain(rng)
        over = rng.uniform((-0.5, -0.5, 1), (0.5, 0.5, 1))
        way = turn @ (rng.normal(size=3) if mesh is BOX else over)
        far = 0.9 if mesh is BOX else 0.65
        b, hulls = drawn(kind, rng, CENTRE + far * way / np.linalg.norm(way))
        it = solid(b, hulls)
        points, grown = core(kind, it)
        triangles = world(mesh, CENTRE, turn)
        judged = min(distance(points, triangle) for triangle in triangles) - grown
        # What pierces a triangle is as far from its sides as it happens to be.
        if judged < 0.02 or any(hulls_meet(points, one) for one in triangles):
            continue
        apart += 1
        places, normals, phi, feature = contacts(mesh, b, judged + 0.2, hulls, turn=turn)
        assert len(set(feature)) == len(feature)
        if kind in ROUND:
            assert phi.min() <= judged + EXACT
        else:
            assert phi.min() == pytest.approx(judged, abs=EXACT)
        for place, n, gap in zip(places, normals, phi, strict=True):
            foot = place - 0.5 * gap * n
            assert min(point_triangle(foot[None], one) for one in triangles) < PLACED
            if gap == phi.min():
                assert abs(solids.off_surface(it, place + 0.5 * gap * n)) < PLACED
                assert -solids.reach(it, -n) - n @ foot == pytest.approx(gap, abs=EXACT)
    assert apart > POSES // 2
