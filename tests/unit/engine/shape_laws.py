"""What kernels of shapes must give, whatever the shape: supports, extents, features."""

from __future__ import annotations

import convex
import numpy as np
import solids
from interpreted import interpreted
from single_bodies import body, row, scratch_of, solid, vector

from lavendersim.engine.collide.shape import Shape
from lavendersim.engine.spec import Spec
from lavendersim.engine.vectors import Vec3

CENTRE = np.array([0.3, -0.2, 0.5])


def drawn(shape: Shape, rng, **properties) -> np.ndarray:
    """Return a turned body of the shape, of random sizes."""
    half = rng.uniform(0.2, 0.6, 3)
    return body(shape.name, half, matrix=convex.random_rotation(rng), **properties)


def unit(rng) -> np.ndarray:
    n = rng.normal(size=3)
    return n / np.linalg.norm(n)


def core_of(solid_body: solids.Solid) -> solids.Solid:
    """Return the core: a capsule's is its axis."""
    if solid_body.kind != "capsule":
        return solid_body
    return solid_body._replace(half=np.array([0.0, 0.0, solid_body.half[2]]))


def check_support(shape: Shape, rng, hulls=(), **properties) -> None:
    """The support is a point of the core, as far along the direction as the core reaches."""
    support, tables = (
        interpreted(shape.maker("make_support")(Spec())),
        scratch_of(list(hulls)).hulls,
    )
    for _ in range(40):
        a, direction = drawn(shape, rng, **properties), rng.normal(size=3)
        core = core_of(solid(a, hulls))
        found = np.array(support(row(a), Vec3(*direction), tables))
        assert abs(found @ direction - solids.reach(core, direction)) < 1e-14
        assert solids.off_surface(core, found) < 1e-14


def check_half_extents(shape: Shape, rng) -> None:
    """They are how far the body reaches along the world's axes, up or down."""
    extents = interpreted(shape.maker("make_half_extents")(Spec()))
    for _ in range(40):
        a = drawn(shape, rng)
        expected = [
            max(solids.reach(solid(a), axis), solids.reach(solid(a), -axis)) for axis in np.eye(3)
        ]
        np.testing.assert_allclose(extents(row(a)), expected, atol=1e-15)


class Seen:
    """The feature of a drawn body that looks along n, its corners in the body's frame."""

    def __init__(self, make, a: np.ndarray, n: np.ndarray, hulls=(), pull=(0.0, 0.0, 0.0)) -> None:
        self.scratch = scratch_of(list(hulls))
        outline = self.scratch.outline_a
        outline.pull[:] = pull
        self.feature = interpreted(make(Spec()))(
            row(a), Vec3(*CENTRE), Vec3(*n), self.scratch.hulls, outline
        )
        self.matrix, self.n = solid(a, hulls).matrix, n
        count = self.feature.corners
        corners = [vector(outline.corners[k]) for k in range(count)]
        self.world = np.array(corners).reshape(-1, 3) - CENTRE
        self.corners = self.world @ self.matrix
        self.normal = vector(outline.plane[0], "n")
        self.on_plane = vector(outline.plane[0]) - CENTRE
        self.radius = outline.plane[0].radius

    def turns_left(self) -> bool:
        """Whether the loop turns left about its outward normal at every corner."""
        edges = np.roll(self.world, -1, axis=0) - self.world
        turns = np.cross(edges, np.roll(edges, -1, axis=0)) @ self.normal
        return bool((turns > 0.0).all())
