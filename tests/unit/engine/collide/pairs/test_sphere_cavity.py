"""A sphere touches the wall around it with its centre."""

from __future__ import annotations

import numpy as np
import pytest
from cavity_contacts import CAVITIES, RADIUS, check_gaps, contacts
from single_bodies import body


@pytest.mark.parametrize("cavity", CAVITIES)
def test_the_gap_is_that_of_its_farthest_point(cavity: str) -> None:
    check_gaps(cavity, "sphere")


@pytest.mark.parametrize("cavity", CAVITIES)
def test_beyond_the_margin_there_is_none(cavity: str) -> None:
    a = body(cavity, (RADIUS, 0.0, 0.0))
    for gap, count in ((0.099, 1), (0.101, 0), (2.0, 0)):
        b = body("sphere", (0.5, 0.0, 0.0), (RADIUS - 0.5 - gap, 0.0, 0.0))
        assert len(contacts(cavity, a, b, 0.1)[2]) == count


@pytest.mark.parametrize("cavity", CAVITIES)
def test_in_the_middle_a_normal_is_across_the_axis(cavity: str) -> None:
    places, normals, phi, _ = contacts(
        cavity, body(cavity, (RADIUS, 0.0, 0.0)), body("sphere", (0.5, 0.0, 0.0))
    )
    assert phi == pytest.approx([RADIUS - 0.5], abs=1e-15)
    assert abs(normals[0]).max() == 1.0
    assert cavity == "bowl" or normals[0][2] == 0.0
    assert np.linalg.norm(places[0]) == pytest.approx(0.5 + 0.5 * (RADIUS - 0.5), abs=1e-15)
