"""A rope's one point: phi = L - |d|, n = -d/|d|, at the end of A; none while it is slack."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted, records
from single_bodies import row, scratch_of

from lavendersim.engine.collide.narrow_phase import make_manifold
from lavendersim.engine.collide.rope import FIRST_ROPE, make_count_connections, make_rope
from lavendersim.engine.record_layout import allocate_bodies, allocate_pairs
from lavendersim.engine.records import ROPE
from lavendersim.engine.spec import Spec

SPEC = Spec(("compound", "frictionless_contact", "rope"), ("sphere_sphere",))
LENGTH, NUMBER = 0.7, 5


def end(place) -> np.ndarray:
    rows = allocate_bodies(SPEC, 1)
    rows["x"], rows["y"], rows["z"] = place
    rows["hx"], rows["hy"] = LENGTH, NUMBER
    return rows


def found(place, margin: float):
    scratch, start = scratch_of([]), np.array([0.1, -0.2, 0.3])
    a, b = row(end(start)), row(end(start + place))
    count = interpreted(make_rope(SPEC))(a, b, margin, scratch)
    return count, scratch.manifold.points.array[0], scratch.manifold.normal.copy()


@pytest.mark.parametrize("distance", [0.2, 0.7, 0.9])
def test_its_point_draws_the_ends_together_by_what_it_is_too_long(distance: float) -> None:
    u = np.array([2.0, -3.0, 6.0]) / 7.0
    count, point, normal = found(distance * u, 1.0)
    assert count == 1
    assert point["phi"] == pytest.approx(LENGTH - distance, abs=1e-15)
    np.testing.assert_allclose(normal, -u, atol=1e-15)
    assert [point[axis] for axis in "xyz"] == [0.1, -0.2, 0.3]
    assert point["feature"] == FIRST_ROPE + NUMBER


def test_slack_beyond_the_margin_has_no_point_and_ends_in_one_place_a_direction() -> None:
    assert found((0.0, 0.601, 0.0), 0.1)[0] == 1
    assert found((0.0, 0.599, 0.0), 0.1)[0] == 0
    count, point, normal = found((0.0, 0.0, 0.0), 1.0)
    assert (count, point["phi"], normal.tolist()) == (1, LENGTH, [0.0, 0.0, 1.0])


def test_pairs_of_ropes_are_not_those_of_shapes() -> None:
    manifold, scratch = interpreted(make_manifold(SPEC, SPEC.shape_pairs)), scratch_of([])
    a, b = row(end((0.0, 0.0, 0.0))), row(end((0.8, 0.0, 0.0)))
    assert manifold(ROPE, a, b, 1e-9, scratch) == 1
    assert scratch.manifold.points.array[0]["feature"] == FIRST_ROPE + NUMBER
    pairs = allocate_pairs(SPEC, 4)
    pairs["kind"] = [ROPE, ROPE, 0, ROPE]
    assert interpreted(make_count_connections(SPEC))(records(pairs)) == 2
    pairs["kind"] = ROPE
    assert interpreted(make_count_connections(SPEC))(records(pairs)) == 4
