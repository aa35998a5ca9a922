"""Bodies inside a bowl or a drum: their contacts, and their point farthest from centre or axis.

That point point is looked for by other means: all corners, fine rims, scipy on the surface.
"""

from __future__ import annotations

import convex
import numpy as np
import pytest
import solids
from interpreted import interpreted, records
from scipy.optimize import minimize
from single_bodies import body, hull, row, solid, spec_of, vertices_of

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.collide.convex.hull_geometry import hull_geometry
from lavendersim.engine.collide.scratch import allocate_scratch

CAVITIES = ("bowl", "drum")
INSIDE = ("sphere", "capsule", "box", "hull", "cylinder", "ellipsoid", "cone")
RADIUS, EVERYWHERE = 2.0, 1e3
CENTRE = np.array([0.3, -0.2, 0.5])
POSES = 12
# The most points of each shape.
MOST = {"sphere": 1, "capsule": 2, "box": 8, "hull": 24, "cylinder": 8, "ellipsoid": 1, "cone": 5}


def contacts(cavity: str, a, b, margin: float = EVERYWHERE, hulls=()):
    """Return points, normals, separations and names."""
    (pair,) = [n for n, one in SHAPE_PAIRS.items() if one.shapes == (cavity, kind_of(b))]
    scratch = records(allocate_scratch(hull_geometry(list(hulls)), own_normals=True))
    kernel = interpreted(SHAPE_PAIRS[pair].make(spec_of(pair)))
    count = kernel(row(a), row(b), margin, scratch)
    found = scratch.manifold.points.array[:count]
    places = np.column_stack([found[axis] for axis in "xyz"])
    normals = scratch.manifold.normal[3 : 3 + 3 * count].reshape(-1, 3).copy()
    return places, normals, found["phi"].copy(), found["feature"].copy()


def kind_of(b) -> str:
    return solids.KINDS[b[0]["shape"]]


def drawn(kind: str, rng):
    """Return a body of the kind that fits, and its hulls; radii of curvature below RADIUS."""
    half, matrix = rng.uniform(0.25, 0.6, 3), convex.random_rotation(rng)
    centre = CENTRE + rng.uniform(-0.7, 0.7, 3)
    if kind == "hull":
        return hull(rng.normal(size=(12, 3)) * 0.3, centre, matrix)
    return body(kind, half, centre, matrix), []


def off(points: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Return points from the centre; from the axis of a drum."""
    d = points - CENTRE
    return d - np.outer(d @ axis, axis)


def farthest(kind: str, b, hulls, axis: np.ndarray) -> float:
    """Return how far the body reaches from the centre or the axis [m]."""
    it = solid(b, hulls)
    half, matrix = it.half, it.matrix
    if kind == "sphere":
        return float(np.linalg.norm(off(it.centre[None], axis)) + half[0])
    if kind == "capsule":
        ends = it.centre + np.outer([-1, 1], half[2] * matrix[:, 2])
        return float(np.linalg.norm(off(ends, axis), axis=1).max() + half[0])
    if kind in ("box", "hull"):
        return float(np.linalg.norm(off(vertices_of(it), axis), axis=1).max())

    def surface(t: np.ndarray) -> np.ndarray:
        if kind in ("cylinder", "cone"):
            ring = np.array([half[0] * np.cos(t[0]), half[0] * np.sin(t[0]), t[1] * half[2]])
            return it.centre + matrix @ ring
        u = np.array([np.cos(t[0]) * np.sin(t[1]), np.sin(t[0]) * np.sin(t[1]), np.cos(t[1])])
        return it.centre + matrix @ (half * u)

    best = 0.0
    if kind == "cone":  # or its apex
        apex = it.centre + 3.0 * half[2] * matrix[:, 2]
        best = float(np.linalg.norm(off(apex[None], axis)))
    for start in np.linspace(0.0, 2.0 * np.pi, 9)[:-1]:
        for other in {"cylinder": (-1.0, 1.0), "cone": (-1.0,)}.get(kind, (0.4, 1.5, 2.7)):
            free = 1 if kind in ("cylinder", "cone") else 2

            def reach(t, other=other, free=free):
                full = t if free == 2 else (t[0], other)
                return -float(np.linalg.norm(off(surface(full)[None], axis)))

            first = [start] if free == 1 else [start, other]
            found = minimize(reach, first, method="Nelder-Mead", options={"xatol": 1e-9})
            best = max(best, -found.fun)
    return best


def check_gaps(cavity: str, kind: str) -> None:
    """Assert that the least gap is that of the farthest point, and all lie between surfaces."""
    rng = np.random.default_rng([7, *f"{cavity}{kind}".encode()])
    for _ in range(POSES):
        turn = convex.random_rotation(rng)
        axis = turn[:, 2] if cavity == "drum" else np.zeros(3)
        a = body(cavity, (RADIUS, 0.0, 0.0), CENTRE, turn)
        b, hulls = drawn(kind, rng)
        places, normals, phi, feature = contacts(cavity, a, b, EVERYWHERE, hulls)
        assert 1 <= len(phi) <= MOST[kind]
        assert len(set(feature)) == len(feature)
        # Nelder and Mead's search ends within 1e-9 of the angle, whose square counts.
        assert phi.min() == pytest.approx(RADIUS - farthest(kind, b, hulls, axis), abs=1e-8)
        for place, n, gap in zip(places, normals, phi, strict=True):
            wall = off((place - 0.5 * gap * n)[None], axis)[0]
            # On the wall, whose normal leads to the axis, and the body's surface half a gap on;
            # of a capsule's end that is nearer to the middle the ball's, inside of it.
            np.testing.assert_allclose(wall, -RADIUS * n, atol=1e-13)
            near = 2e-9 if kind in ("cylinder", "ellipsoid", "cone") else 1e-13
            if kind != "capsule" or gap == phi.min():
                assert abs(solids.off_surface(solid(b, hulls), place + 0.5 * gap * n)) < near
