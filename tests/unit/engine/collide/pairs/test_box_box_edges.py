"""The edge of a box that is farthest along a direction, and which of four it is."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from interpreted import interpreted
from single_bodies import body, manifold, row, scratch_of

from lavendersim.engine.collide.pairs.box_box import load_box, supporting_edge
from lavendersim.engine.vectors import Vec3


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("toward", [1.0, -1.0])
def test_it_is_the_farthest_of_four_and_named_by_the_sides_that_n_looks_to(
    axis: int, toward: float, rng
) -> None:
    """Bit 0: along the next axis, bit 1: along the one after; of A along n, of B against it."""
    names = set()
    for _ in range(20):
        half, matrix, centre = (
            rng.uniform(0.1, 0.5, 3),
            convex.random_rotation(rng),
            rng.normal(size=3),
        )
        box = scratch_of([]).box_a
        interpreted(load_box)(row(body("box", half, centre, matrix)), Vec3(0.0, 0.0, 0.0), box)
        n = rng.normal(size=3)
        p, which = interpreted(supporting_edge)(box, axis, Vec3(*n), toward)
        following = [(axis + 1) % 3, (axis + 2) % 3]
        middles = {
            bits: centre + sum(
                toward * (1.0 if bits >> k & 1 else -1.0) * half[one] * matrix[:, one]
                for k, one in enumerate(following)
            )
            for bits in range(4)
        }  # fmt: skip
        expected = max(middles, key=lambda bits: toward * (middles[bits] @ n))
        assert which == expected
        np.testing.assert_allclose(p, middles[expected], atol=1e-15)
        names.add(which)
    assert names == {0, 1, 2, 3}


@pytest.mark.parametrize("gap", [0.03, 1e-3, 1e-5])
@pytest.mark.parametrize("beside", [0.1, 0.5, 1.0])
def test_boxes_that_pass_each_other_at_an_edge_are_as_far_apart_as_their_edges(
    gap: float, beside: float
) -> None:
    """The face that separates most looks past the other box: it is that edge that is nearest."""
    half = (0.2, 0.3, 0.4)
    apart = gap * np.array([1.0, beside, 0.0])
    a, b = body("box", half), body("box", half, 2.0 * np.array(half) * (1.0, 1.0, 0.0) + apart)
    found = manifold("box_box", a, b, 0.1, effects=("rotation", "speculative"))
    assert len(found.phi) == 1
    distance = float(np.linalg.norm(apart))
    assert found.phi[0] == pytest.approx(distance, rel=1e-6, abs=1e-14)
    # Along each axis the corner is known to 1e-16 m.
    np.testing.assert_allclose(found.normal, apart / distance, atol=1e-15 / distance + 1e-6)


@pytest.mark.parametrize("gap", [6e-3, 2e-3, 6e-4])
@pytest.mark.parametrize("over", [-1e-5, 1e-9, 2e-6, 1e-4])
def test_an_edge_that_turns_to_a_face_and_hangs_over_its_end_meets_it_along_its_whole_length(
    gap: float, over: float
) -> None:
    """A domino that leans at the next one, a little yawed and a little beside it [m]."""
    half, lean, yaw = np.array((0.005, 0.025, 0.05)), 0.3, 2e-5
    leant = convex.matrix_of(np.array((np.cos(0.5 * lean), 0.0, np.sin(0.5 * lean), 0.0)))
    matrix = convex.matrix_of(np.array((np.cos(0.5 * yaw), 0.0, 0.0, np.sin(0.5 * yaw)))) @ leant
    end = matrix @ (half * (1.0, -1.0, 1.0))  # of the edge, the one that turns to the face
    corner = np.array((-half[0] - gap, -half[1] - over, 0.03))
    a, b = body("box", half, corner - end, matrix), body("box", half)
    found = manifold("box_box", a, b, 0.01, effects=("rotation", "speculative"))
    np.testing.assert_allclose(found.normal, (1.0, 0.0, 0.0), atol=1e-15)
    # Over the edge's length of 2 half[1] the yaw brings one end nearer by 1e-6 m; of boxes as wide
    # as each other one end or the other hangs over.
    turned = 2.0 * half[1] * yaw
    (edge,) = np.nonzero(found.phi < gap + 2.0 * turned)  # the face below the edge is farther
    across = found.points[edge, 1]
    far, near = found.phi[edge[across.argmax()]], found.phi[edge[across.argmin()]]
    assert (far, near) == pytest.approx((gap + turned, gap), abs=yaw * abs(over) + 2e-12)
    assert np.ptp(across) == pytest.approx(2.0 * half[1] - abs(over), abs=1e-9)
