"""The image of B that is nearest to A: none where one of them has no period; rows are put back."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted, records

from lavendersim.engine.collide.nearest_image import (
    make_beside,
    make_swept_beside,
    moved_near,
    nearest_image,
    own_place,
    place_beside,
)
from lavendersim.engine.record_layout import body_dtype
from lavendersim.engine.spec import Spec

PERIODIC, OPEN = Spec(("periodic_boundary",)), Spec()


@pytest.mark.parametrize(
    ("x", "other", "period", "image"),
    [
        (0.1, 0.9, 1.0, -0.1),
        (0.1, 0.5, 1.0, 0.5),
        (7.1, 0.9, 1.0, 6.9),
        (-3.0, 3.25, 2.0, -2.75),
        (0.1, 0.9, 0.0, 0.9),
    ],
)
def test_a_coordinate_is_moved_by_whole_periods(x, other, period, image) -> None:
    assert interpreted(moved_near)(x, other, period) == pytest.approx(image, abs=1e-14)


def two() -> np.ndarray:
    bodies = np.zeros(2, body_dtype(PERIODIC))
    bodies["period_x"], bodies["period_y"] = 2.0, (0.0, 2.0)
    bodies["x"], bodies["y"], bodies["z"] = (0.125, 3.875), (0.0, 5.0), (0.0, 1.0)
    return bodies


def test_only_axes_on_which_both_have_a_period_count() -> None:
    a, b = records(two())
    assert tuple(interpreted(nearest_image)(a, b)) == (-0.125, 5.0, 1.0)
    assert tuple(interpreted(own_place)(a, b)) == (3.875, 5.0, 1.0)


def test_an_engine_without_a_cell_asks_for_no_image() -> None:
    assert (place_beside(OPEN), place_beside(PERIODIC)) == (own_place, nearest_image)
    manifold = object()
    assert make_beside(OPEN, manifold) is manifold
    assert make_swept_beside(OPEN, manifold) is manifold


def test_a_manifold_sees_the_image_and_the_row_is_put_back() -> None:
    bodies, seen = two(), []
    a, b = records(bodies)

    def manifold(kind, a, b, margin, scratch):
        seen.append(b.x)
        return 1

    def swept(kind, a, b, d, margin, scratch):
        seen.append(b.x)
        return 1, 0.5

    assert interpreted(make_beside(PERIODIC, manifold))(0, a, b, 0.0, None) == 1
    found = interpreted(make_swept_beside(PERIODIC, swept))(0, a, b, None, 0.0, None)
    assert tuple(found) == (1, 0.5)
    assert (seen, b.x) == ([-0.125, -0.125], 3.875)
