"""An edge of a mesh is a segment: its farther end along a direction, a line across it."""

from __future__ import annotations

import numpy as np
from interpreted import interpreted, records
from single_bodies import scratch_of, spec_of

from lavendersim.engine.collide.records import LINE, POINT
from lavendersim.engine.collide.shapes.mesh import make_feature, make_support
from lavendersim.engine.record_layout import allocate_bodies
from lavendersim.engine.vectors import Vec3

SPEC = spec_of("sphere_mesh")
HALF = (0.3, -0.4, 1.2)


def edge():
    rows = allocate_bodies(SPEC, 1)
    rows["hx"], rows["hy"], rows["hz"] = HALF
    rows["first_node"] = 7
    return records(rows)[0]


def test_the_support_is_the_end_that_lies_farther() -> None:
    support = interpreted(make_support(SPEC))
    rng = np.random.default_rng(1)
    for way in rng.normal(size=(20, 3)):
        sign = 1.0 if way @ HALF >= 0.0 else -1.0
        np.testing.assert_array_equal(support(edge(), Vec3(*way), None), sign * np.array(HALF))


def test_it_is_a_line_across_a_normal_and_a_point_along_it() -> None:
    feature, scratch = interpreted(make_feature(SPEC)), scratch_of([])
    across = feature(edge(), Vec3(1.0, 2.0, 3.0), Vec3(0.8, 0.6, 0.0), None, scratch.outline_a)
    assert across == (LINE, 2, 7)
    ends = [[scratch.outline_a.corners[k][axis] for axis in "xyz"] for k in range(2)]
    np.testing.assert_allclose(ends, np.add((1, 2, 3), np.outer((-1, 1), HALF)), atol=1e-15)
    along = feature(edge(), Vec3(0, 0, 0), Vec3(0.0, 0.0, 1.0), None, scratch.outline_a)
    assert along.kind == POINT
