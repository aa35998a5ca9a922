"""Eight vectors are projected onto their discs as one is, and that one to the nearest point."""

from __future__ import annotations

import numpy as np
import pytest
from packed_lanes import one_and_eight

from lavendersim.engine.solvers.packed.disc import make_project_disc

ONE = np.array([0.0, 3.0, -0.3, 0.0, 1e-3, 2.0, -5.0, 0.0])
TWO = np.array([0.0, -4.0, 0.4, 2.0, 0.0, 0.0, 1.0, -7.0])
LIMIT = np.array([0.0, 1.0, 1.0, 2.0, 0.0, 3.0, 0.5, 7.0])


@pytest.mark.parametrize("eight", [False, True])
def test_projections_are_the_nearest_points_of_the_discs(eight: bool) -> None:
    """Correctly rounded roots, quotients and products: three roundings of numbers up to 7."""
    one, two = one_and_eight(make_project_disc, (ONE, TWO, LIMIT), 2, eight)
    size = np.hypot(ONE, TWO)
    scale = np.where(size > LIMIT, LIMIT / np.where(size > 0.0, size, 1.0), 1.0)
    np.testing.assert_allclose(one, scale * ONE, rtol=0, atol=3 * 2.0**-53 * 7)
    np.testing.assert_allclose(two, scale * TWO, rtol=0, atol=3 * 2.0**-53 * 7)
    inside = size <= LIMIT
    np.testing.assert_array_equal(one[inside], ONE[inside])  # to the bit, the rim included


def test_what_is_not_a_number_stays() -> None:
    nan = np.where(np.arange(8) == 3, np.nan, ONE)
    one, two = one_and_eight(make_project_disc, (nan, TWO, LIMIT), 2, True)
    assert np.isnan(one[3])
    assert np.isfinite(np.delete(one, 3)).all()
    assert np.isfinite(np.delete(two, 3)).all()
