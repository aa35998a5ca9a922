"""Of the points of a manifold a contact goes on as the nearest, as long as the normal agrees."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import random_frame
from interpreted import interpreted, records
from plain_facts import one_row, vector_fields

from lavendersim.engine.collide.scratch import allocate_scratch
from lavendersim.engine.midpoint_geometry import AGREES, make_nearest
from lavendersim.engine.spec import Spec


@pytest.mark.parametrize("share", [0.9, 1.1], ids=["turned away", "agrees"])
def test_the_nearest_point_is_the_least_distance_along_all_axes(share: float, rng) -> None:
    kernel = interpreted(make_nearest(Spec()))
    for _ in range(20):
        manifold = allocate_scratch().manifold
        points = rng.normal(size=(4, 3)) * rng.permutation([1.0, 0.1, 3.0])
        for axis, column in zip("xyz", points.T, strict=True):
            manifold.points[axis][:4] = column
        normal, aside, _ = random_frame(rng)
        manifold.normal[:] = normal
        cosine = share * AGREES
        seen = cosine * normal + np.sqrt(1.0 - cosine**2) * aside
        contact = one_row(**vector_fields("at_n", seen), **vector_fields("at_", points.mean(0)))
        found = kernel(contact, records(manifold), 4)
        nearest = int(np.argmin(np.linalg.norm(points - points.mean(0), axis=1)))
        assert found == (nearest if share > 1.0 else -1)
