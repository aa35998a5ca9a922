"""Points have normals of their own where a pair of the engine asks for them, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted, records
from single_bodies import body, row, spec_of

from lavendersim.engine.collide import SHAPE_PAIRS, narrow_phase
from lavendersim.engine.collide.manifold.own_normals import (
    SHARED,
    has_own_normals,
    make_has_shared,
)
from lavendersim.engine.collide.scratch import allocate_scratch

BOTH = spec_of("box_plane", "sphere_bowl")


def test_only_pairs_of_cavities_and_meshes_have_them() -> None:
    for name, pair in SHAPE_PAIRS.items():
        assert has_own_normals(spec_of(name)) == (pair.inside or "mesh" in pair.shapes)
    has_shared = interpreted(make_has_shared(BOTH))
    assert has_shared(SHAPE_PAIRS["box_plane"].kind)
    assert not has_shared(SHAPE_PAIRS["sphere_bowl"].kind)


@pytest.mark.parametrize("own", [False, True])
def test_the_array_ends_behind_the_shared_one_where_none_are_asked_for(own: bool) -> None:
    manifold = allocate_scratch(None, own).manifold
    assert len(manifold.normal) == SHARED + (SHARED * len(manifold.points) if own else 0)


def test_beside_such_a_pair_every_point_of_any_other_has_the_shared_one() -> None:
    manifold = interpreted(narrow_phase.make_manifold(BOTH, BOTH.shape_pairs))
    scratch = records(allocate_scratch(None, True))
    n = np.array([0.0, 0.6, 0.8])
    count = manifold(
        SHAPE_PAIRS["box_plane"].kind,
        row(body("plane", n)),
        row(body("box", (0.1, 0.2, 0.3))),
        1.0,
        scratch,
    )
    assert count == 4
    normals = scratch.manifold.normal[SHARED : SHARED + 3 * count].reshape(-1, 3)
    np.testing.assert_array_equal(normals, [n] * count)
