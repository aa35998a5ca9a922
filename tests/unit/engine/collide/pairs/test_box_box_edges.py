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
