"""A hull touches with what is in its own tables: faces, edges and corners, none stretched."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import solid_poses

from lavendersim.engine.record_layout import allocate_bodies

HALF = np.array([0.5, 0.3, 0.2])  # [m], no two alike: an axis taken for another is seen
CUBOID = (
    HALF * np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]),
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]],
)
RADIUS, DEPTH = 0.1, 1e-6
# Radii of the capsule are normal to the edge to some 1e-9: `line_normal` ends at its round-off.
CLOSE = 1e-8


def along_an_edge(axis: int, signs: tuple[int, int], tilt: float, length: float):
    """Return the manifold of the cuboid with a capsule along one of its edges, and what it is.

    tilt [degree]: from the face's normal to that of the contact.
    """
    one, other = (axis + 1) % 3, (axis + 2) % 3
    normal, edge = np.zeros(3), np.zeros(3)
    normal[one] = signs[0] * np.cos(np.radians(tilt))
    normal[other] = signs[1] * np.sin(np.radians(tilt))
    edge[one], edge[other] = signs[0] * HALF[one], signs[1] * HALF[other]
    matrix = np.roll(np.eye(3), axis + 1, axis=0)  # the capsule's z along the edge
    hull, capsule = (allocate_bodies(solid_poses.EVERY_SHAPE, 1) for _ in range(2))
    solid_poses.put(hull[0], "hull", (1.0, 1.0, 1.0), hull=0, corners=CUBOID[0])
    centre = edge + (RADIUS - DEPTH) * normal
    solid_poses.put(capsule[0], "capsule", (RADIUS, 0.0, 0.5 * length), centre, matrix)
    sample = solid_poses.Sample("capsule_hull", hull, capsule, [CUBOID])
    reach = min(HALF[axis], 0.5 * length)
    # Points stand half way between the surfaces.
    ends = [edge - 0.5 * DEPTH * normal + side * reach * np.eye(3)[axis] for side in (-1.0, 1.0)]
    return solid_poses.manifolds(sample, 1e-6)[0], normal, np.array(ends)


@pytest.mark.parametrize("length", [0.2, 3.0], ids=["shorter", "longer"])
@pytest.mark.parametrize("tilt", [4.0, 16.0, 45.0, 74.0, 86.0])
def test_a_capsule_along_an_edge_touches_where_it_and_the_edge_end(tilt, length) -> None:
    """Up to 18 degrees from a face's normal the edge is taken in that face's place."""
    for axis, *signs in itertools.product(range(3), (-1, 1), (-1, 1)):
        found, normal, ends = along_an_edge(axis, (signs[0], signs[1]), tilt, length)
        assert len(found.phi) == 2
        np.testing.assert_allclose(found.phi, -DEPTH, atol=1e-3 * DEPTH)
        np.testing.assert_allclose(found.normal, normal, atol=CLOSE)
        order = np.argsort(found.points[:, axis])
        np.testing.assert_allclose(found.points[order], ends, atol=CLOSE)
