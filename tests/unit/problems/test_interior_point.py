"""An interior point: from inside the cones to a solution, by Nesterov and Todd's scaling."""

from __future__ import annotations

import numpy as np
import pytest
from contact_problems import heap, stack

from lavendersim.problems.budget import Budget
from lavendersim.problems.interior_point import STRATEGIES, _scaling, _to_boundary, interior_point
from lavendersim.problems.scaled_problem import scale


@pytest.mark.parametrize(
    "strategy", STRATEGIES, ids=["long steps", "short steps", "long from afar", "short from afar"]
)
def test_an_interior_point_comes_down_from_inside_the_cones(strategy) -> None:
    problem = stack(9, 10, ratio=1e3)
    p = scale(problem)
    x, reached = interior_point(p, Budget(1e-9, 200), strategy)
    assert reached <= 1e-9
    # What gets there by the path pushes within its cones.
    assert (np.hypot(x[:, 1], x[:, 2]) <= p.mu * x[:, 0] + 1e-9 * np.abs(x).max()).all()


def test_an_interior_point_stops_when_everything_is_spent() -> None:
    p = scale(heap(0, 10, mu=2.0))
    budget = Budget(1e-14, 4)
    interior_point(p, budget)
    assert budget.steps == len(budget.history) == 4


def inside(seed: int, count: int = 50) -> np.ndarray:
    """Return points inside of |x_t| < x_n."""
    random = np.random.default_rng(seed)
    x = random.normal(size=(count, 3))
    x[:, 0] = np.hypot(x[:, 1], x[:, 2]) + random.uniform(0.01, 2.0, count)
    return x


def test_the_scaling_takes_one_point_to_the_other_and_is_symmetric_and_positive() -> None:
    """Its definition, z = H x; and it keeps the cone: eigenvalues and determinant are positive."""
    x, z = inside(1), inside(2)
    H = _scaling(x, z)
    np.testing.assert_allclose(np.einsum("nij,nj->ni", H, x), z, rtol=0, atol=1e-11)
    np.testing.assert_allclose(H, H.transpose(0, 2, 1), rtol=0, atol=1e-12)
    assert np.linalg.eigvalsh(H).min() > 0.0


def test_the_way_to_the_boundary_is_that_of_a_fine_scan() -> None:
    x, d = inside(3, 60), np.random.default_rng(4).normal(size=(60, 3))
    for one, way in zip(x, d, strict=True):
        found = _to_boundary(one[None], way[None])
        lengths = np.linspace(0.0, 50.0, 20_001)
        reached = one + lengths[:, None] * way
        outside = np.flatnonzero(np.hypot(reached[:, 1], reached[:, 2]) > reached[:, 0])
        if len(outside):
            assert abs(found - lengths[outside[0]]) <= 2.6e-3  # the scan steps by 2.5e-3
        else:
            assert found > 49.99
