"""A cylinder touches the wall around it with points of its rims."""

from __future__ import annotations

import numpy as np
import pytest
from cavity_contacts import CAVITIES, RADIUS, check_gaps, contacts
from single_bodies import body


@pytest.mark.parametrize("cavity", CAVITIES)
def test_the_gap_is_that_of_its_farthest_point(cavity: str) -> None:
    check_gaps(cavity, "cylinder")


def test_a_rim_across_a_drum_touches_on_both_sides() -> None:
    """Across the axis a disc is as wide as it is: its edge is seen as a line of two ends."""
    turn = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])  # its axis along x
    b = body("cylinder", (1.0, 0.0, 0.1), (0.0, 0.0, 0.0), turn)
    _, normals, phi, _ = contacts("drum", body("drum", (RADIUS, 0.0, 0.0)), b)
    assert phi == pytest.approx([RADIUS - np.hypot(1.0, 0.1)] * 4, abs=1e-14)
    sides = {(bool(n[0] > 0.0), bool(n[1] > 0.0)) for n in normals}
    assert sides == {(x, y) for x in (False, True) for y in (False, True)}


def test_a_disc_lies_in_a_bowl_on_four_points() -> None:
    b = body("cylinder", (0.5, 0.0, 0.1), (0.0, 0.0, -1.0))
    places, _, phi, _ = contacts("bowl", body("bowl", (RADIUS, 0.0, 0.0)), b)
    low = phi < phi.min() + 1e-12
    assert phi.min() == pytest.approx(RADIUS - np.hypot(0.5, 1.1), abs=1e-14)
    assert low.sum() == 4
    np.testing.assert_allclose(places[low].mean(axis=0)[:2], 0.0, atol=1e-15)
