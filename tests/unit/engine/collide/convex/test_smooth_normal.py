"""Newton's method finds the nearest point of an ellipsoid to a corner, an axis and a circle."""

from __future__ import annotations

import convex
import numpy as np
import pytest
import solids
from interpreted import interpreted
from single_bodies import body, row, solid, spec_of

from lavendersim.engine.collide.convex.smooth_normal import (
    AXIS,
    CIRCLE,
    CORNER,
    CorePart,
    make_normal_of_part,
)
from lavendersim.engine.vectors import Vec3

NONE = Vec3(0.0, 0.0, 0.0)


def found(part: CorePart, b: np.ndarray, start: np.ndarray) -> np.ndarray:
    a = body("sphere", (0.1, 0, 0))
    kernel = interpreted(make_normal_of_part(spec_of("ellipsoid_sphere")))
    offset = Vec3(*solid(b).centre)
    return np.array(kernel(row(a), row(b), offset, part, Vec3(*start)))


def test_the_normal_at_the_point_nearest_to_a_corner(rng) -> None:
    """From a normal up to 0.5 off; the distance by bisection of Eberly's equation."""
    for _ in range(40):
        centre = 2.0 * convex.random_rotation(rng)[0]
        b = body("ellipsoid", rng.uniform(0.2, 0.6, 3), centre, convex.random_rotation(rng))
        start = centre / 2.0 + 0.5 * rng.uniform(-1, 1, 3)
        n = found(CorePart(CORNER, NONE, NONE, 0.0, 0.0), b, start / np.linalg.norm(start))
        distance = solids.off_surface(solid(b), np.zeros(3))
        assert -solids.reach(solid(b), -n) == pytest.approx(distance, abs=1e-14)


def test_the_normal_across_an_axis_and_of_a_circle_separates_most(rng) -> None:
    """No direction of ten thousand drawn about it separates more."""
    for kind in (AXIS, CIRCLE):
        for _ in range(10):
            along = convex.random_rotation(rng)[0]
            centre = 2.5 * convex.random_rotation(rng)[0]
            b = body("ellipsoid", rng.uniform(0.2, 0.6, 3), centre, convex.random_rotation(rng))
            part = CorePart(kind, NONE, Vec3(*along), 1.0, 0.5 if kind == CIRCLE else 0.0)
            n = found(part, b, centre / 2.5)
            assert np.linalg.norm(n) == pytest.approx(1.0, abs=1e-15)

            def separation(m, b=b, kind=kind, along=along):
                held = 0.5 * np.linalg.norm(m - (m @ along) * along) if kind == CIRCLE else 0.0
                return -solids.reach(solid(b), -m) - held

            others = n + 1e-3 * rng.normal(size=(1000, 3))
            if kind == AXIS:
                assert abs(n @ along) < 1e-15
                others -= np.outer(others @ along, along)
            others /= np.linalg.norm(others, axis=1)[:, None]
            assert max(map(separation, others)) <= separation(n) + 1e-15
