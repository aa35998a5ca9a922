"""Supports of an ellipsoid's core, grown by its radius, are those of the ellipsoid; curvature."""

from __future__ import annotations

import numpy as np
import solids
from interpreted import interpreted
from shape_laws import check_half_extents, drawn, unit
from single_bodies import row, scratch_of, solid

from lavendersim.engine.collide.shapes import SHAPES
from lavendersim.engine.collide.shapes.ellipsoid import (
    curvature_radius,
    make_radius,
    make_support,
    point_of_normal,
    turned_by,
)
from lavendersim.engine.spec import Spec
from lavendersim.engine.vectors import Vec3

ELLIPSOID = SHAPES["ellipsoid"]


def test_the_core_grown_by_its_radius_is_the_ellipsoid(rng) -> None:
    support, radius = (interpreted(make(Spec())) for make in (make_support, make_radius))
    hulls = scratch_of([]).hulls
    for _ in range(40):
        a, n = drawn(ELLIPSOID, rng), unit(rng)
        core = np.array(support(row(a), Vec3(*(3.0 * n)), hulls))
        at = solid(a)._replace(centre=np.zeros(3))
        surface = core + radius(row(a)) * n
        assert abs(surface @ n - solids.reach(at, n)) < 1e-15
        assert abs(solids.off_surface(at, surface)) < 1e-15


def test_extents_hold_the_ellipsoid(rng) -> None:
    check_half_extents(ELLIPSOID, rng)


def test_points_turn_with_their_normals_by_the_radii_of_curvature(rng) -> None:
    """dp/dn by central differences of 1e-5: 1e-10 of the third derivative, some 10 m here."""
    point, turned = interpreted(point_of_normal), interpreted(turned_by)
    least = interpreted(curvature_radius)
    for _ in range(40):
        a, n = row(drawn(ELLIPSOID, rng)), unit(rng)
        u = np.cross(n, unit(rng))
        u /= np.linalg.norm(u)
        w = np.cross(n, u)
        p, h = point(a, Vec3(*n))
        radii = np.empty((2, 2))
        for i, j in np.ndindex(2, 2):
            along, across = (u, w)[i], (u, w)[j]
            ahead, _ = point(a, Vec3(*(n + 1e-5 * across)))
            behind, _ = point(a, Vec3(*(n - 1e-5 * across)))
            radii[i, j] = turned(a, p, h, Vec3(*along), Vec3(*across))
            rate = along @ (np.array(ahead) - np.array(behind)) / 2e-5
            assert abs(radii[i, j] - rate) < 1e-8
        assert np.linalg.eigvalsh(radii).min() >= least(a) * (1.0 - 1e-12)
