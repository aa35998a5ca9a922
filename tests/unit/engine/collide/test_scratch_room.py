"""Scratch has room for the worst that its kernels may be given, and no array of it is another's."""

from __future__ import annotations

import numpy as np
import pytest
from single_bodies import hull

from lavendersim.engine.collide import scratch
from lavendersim.engine.collide.convex.hull_geometry import hull_geometry
from lavendersim.engine.collide.scratch import (
    CAP_CORNERS,
    EPA_FACES,
    EPA_VERTICES,
    allocate_scratch,
)


def arrays(value, name=""):
    if isinstance(value, np.ndarray):
        yield name, value
    elif isinstance(value, tuple):
        for part in getattr(value, "_fields", ()):  # () where there are no meshes
            yield from arrays(getattr(value, part), f"{name}.{part}")


def prism(corners: int):
    turn = 2.0 * np.pi * np.arange(corners) / corners
    ring = np.column_stack([np.cos(turn), np.sin(turn)])
    vertices = np.vstack([np.column_stack([ring, np.full(corners, z)]) for z in (-1.0, 1.0)])
    top = list(range(corners, 2 * corners))
    sides = [
        [k, (k + 1) % corners, corners + (k + 1) % corners, corners + k] for k in range(corners)
    ]
    return vertices, [list(range(corners))[::-1], top, *sides]


@pytest.mark.parametrize("corners", [3, 8, 60])
def test_outlines_and_polygons_hold_the_longest_face_and_its_cuts(corners: int) -> None:
    """A polygon of n corners has at most n + 2 m after m cuts, and a cut looks two rows further."""
    made = allocate_scratch(hull_geometry([prism(corners)]))
    longest = max(corners, CAP_CORNERS)
    for outline in (made.outline_a, made.outline_b):
        assert len(outline.corners) >= longest
    half = len(made.polygon) // 2
    assert half >= longest + 2 * longest + 2
    assert len(made.polygon) >= 2 * corners  # `hull_plane` lists every corner of the hull


def test_a_hull_of_more_vertices_than_any_face_has_room_for_all(rng) -> None:
    points = rng.normal(size=(400, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    _, hulls = hull(points)
    made = allocate_scratch(hull_geometry(hulls))
    assert len(made.polygon) >= 400


def test_an_expanding_polytope_has_the_faces_that_its_vertices_can_make() -> None:
    """v points have 2 v - 4 triangles; those cut off keep their rows: some six for each vertex."""
    assert EPA_FACES >= 2 * EPA_VERTICES - 4 + 6 * (EPA_VERTICES - 4)
    polytope = allocate_scratch().polytope
    assert len(polytope.vertices) == len(polytope.horizon) == EPA_VERTICES
    for each in (polytope.faces, polytope.corners, polytope.neighbours, polytope.queue):
        assert len(each) == EPA_FACES
    assert scratch.SIMPLEX_VERTICES == scratch.NEW_VERTEX  # the one that waits is behind the others


def test_no_array_shares_its_memory_but_gravity_and_the_tables() -> None:
    """Both outlines look at one gravity; tables of hulls are one for all threads."""
    made, other = allocate_scratch(), allocate_scratch()
    assert made.outline_a.pull is made.outline_b.pull
    own = [(n, a) for n, a in arrays(made) if "hulls" not in n and not n.endswith("b.pull")]
    for k, (name, one) in enumerate(own):
        for another, two in own[k + 1 :]:
            assert not np.shares_memory(one, two), (name, another)
    for (name, one), (_, two) in zip(arrays(made), arrays(other), strict=True):
        assert np.shares_memory(one, two) == ("hulls" in name), name
