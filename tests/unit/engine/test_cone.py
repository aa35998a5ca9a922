"""`project_cone` against what makes a projection one: Moreau's decomposition, for every mu."""

from __future__ import annotations

import itertools
import math

import pytest

from lavendersim.engine.cone import project_cone, project_disc, within

SIDES = (-2.0, -1e-300, -0.0, 0.0, 0.5, 3.0)
POINTS = list(itertools.product(SIDES, (-1.0, 0.0, 0.25), (-0.5, 0.0, 2.0)))
# r = p - q is round-off of lengths up to 4, in some additions and one division and root.
ROUND_OFF = 16 * 4.0 * 2.0**-53


@pytest.mark.parametrize("mu", [0.0, 0.1, 1.0, 7.0])
@pytest.mark.parametrize("point", POINTS, ids=str)
def test_a_projection_parts_a_point_into_cone_and_polar_cone(
    mu: float, point: tuple[float, float, float]
) -> None:
    """p = q + r with q in K, r in -K*, and q . r = 0."""
    n, one, two = project_cone.py_func(*point, mu)
    assert n >= 0.0
    assert math.hypot(one, two) <= mu * n + ROUND_OFF
    rest_n, rest_1, rest_2 = point[0] - n, point[1] - one, point[2] - two
    assert mu * math.hypot(rest_1, rest_2) <= -rest_n + (1.0 + mu) * ROUND_OFF
    assert abs(n * rest_n + one * rest_1 + two * rest_2) <= (1.0 + mu) * 4.0 * ROUND_OFF


@pytest.mark.parametrize("point", [(0.3, -0.4), (3.0, -4.0), (-1e-3, 0.0), (0.0, 0.5)])
@pytest.mark.parametrize("limit", [0.0, 0.5, 2.0])
def test_a_disc_leaves_what_lies_in_it_and_shortens_what_does_not(
    point: tuple[float, float], limit: float
) -> None:
    found = project_disc.py_func(*point, limit)
    length = math.hypot(*point)
    if length <= limit:
        assert found == point
    else:  # the same direction, on the rim
        assert math.hypot(*found) == pytest.approx(limit, rel=1e-15, abs=1e-300)
        assert found[0] * point[1] == pytest.approx(found[1] * point[0], rel=1e-15, abs=1e-300)
        assert found[0] * point[0] >= 0.0
        assert found[1] * point[1] >= 0.0


@pytest.mark.parametrize("x", [-3.0, -1.0, -0.2, 0.0, 0.7, 1.0, 2.5])
def test_a_bounded_number_is_the_nearest_within_its_bounds(x: float) -> None:
    assert within.py_func(x, 1.0) == min(max(x, -1.0), 1.0)


def test_what_is_no_number_stays_none() -> None:
    assert math.isnan(within.py_func(math.nan, 1.0))
