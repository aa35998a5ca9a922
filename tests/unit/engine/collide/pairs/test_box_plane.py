"""Of a box with more than four corners near a plane the lower face is held, not its upper corners.

An upper corner lies straight above a lower one, an edge away, and further out by the tilt: kept for
the area it spans, it would leave the lower one to sink by the whole edge.
"""

from __future__ import annotations

import convex
import numpy as np
import poses
import pytest
from laboratory import Bench, box, plane, resolved

G, DT = 9.81, 1.0 / 240.0


@pytest.mark.parametrize("half", [(0.5, 0.5, 0.001), (0.5, 0.001, 0.001), (0.1, 0.1, 0.1)])
def test_each_corner_left_out_lies_an_edge_above_one_that_is_kept(rng, half):
    """All eight corners are below the plane. Along the axis that is nearest to the normal, within
    acos(1/sqrt(3)) of it, an edge rises by at least its length over sqrt(3).
    """
    count = 300
    first, second = poses.allocate(count), poses.allocate(count)
    boxes = []
    for i in range(count):
        normal = rng.normal(size=3)
        normal /= np.linalg.norm(normal)
        boxes.append(convex.Box(-2.0 * normal, convex.random_rotation(rng), np.array(half)))
        poses.put(first[i], normal)
        poses.put(second[i], half, boxes[i].centre, boxes[i].matrix)
    manifolds = poses.manifolds("box_plane", first, second)
    for row, solid, found in zip(first, boxes, manifolds, strict=True):
        normal = np.array([row["hx"], row["hy"], row["hz"]])
        signs = np.array([[1.0 if c & (1 << k) else -1.0 for k in range(3)] for c in range(8)])
        phi = (solid.centre + signs * solid.half @ solid.matrix.T) @ normal
        kept = set(found.feature.tolist())
        assert len(kept) == len(found.phi) == 4
        assert int(np.argmin(phi)) in kept
        for corner in set(range(8)) - kept:
            below = [corner ^ (1 << k) for k in range(3) if corner ^ (1 << k) in kept]
            edges = [2.0 * half[k] for k in range(3) if corner ^ (1 << k) in kept]
            assert any(
                phi[corner] - phi[low] >= edge / np.sqrt(3.0) - 1e-15
                for low, edge in zip(below, edges, strict=True)
            )


@pytest.mark.parametrize("degrees", [0.02, 0.1, 1.0, 5.0])
def test_a_plate_that_falls_almost_flat_stays_above_the_floor(degrees):
    """It falls 0.1 m. A contact foresees where a corner moves, not how it turns: it may sink in by
    r omega^2 dt^2/2, and all of the fall in the spin is omega^2 = 2 g h / (1/12 m^2) = 23.5. With
    r = 0.71 m that is 1.5e-4 m, and the plate is 2 mm thick.
    """
    angle = np.radians(degrees)
    axis = np.array([1.0, 0.4, 0.0]) / np.sqrt(1.16)
    turn = (np.cos(0.5 * angle), *(np.sin(0.5 * angle) * axis))
    height = 0.1 + 0.001 + 0.71 * np.sin(angle)
    bench = Bench(
        resolved(
            {
                "floor": plane(friction=0.5),
                "plate": box((1, 1, 0.002), (0, 0, height), orientation=turn, friction=0.5),
            },
            (0.0, 0.0, -G),
            solver="adaptive", sweeps=50, tolerance=1e-9, slop=1e-7, stabilisation_gain=0.0,
            projection=0.2, speculative=True, impacts="at_surface", integrator="midpoint",
        ),
        spec=None,
    )  # fmt: skip
    rows = bench.run(240)
    corners = np.array(
        [[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.001, 0.001)]
    )
    lowest = 0.0
    for _, _, z, w, i, j, k in rows.pose[:, 1]:
        turned = corners @ convex.matrix_of(np.array([w, i, j, k])).T
        lowest = min(lowest, float((turned[:, 2] + z).min()))
    assert lowest >= -1.5e-4
