"""A cone touches the wall around it with its apex, or with points of its rim."""

from __future__ import annotations

import pytest
from cavity_contacts import CAVITIES, check_gaps


@pytest.mark.parametrize("cavity", CAVITIES)
def test_the_gap_is_that_of_its_farthest_point(cavity: str) -> None:
    check_gaps(cavity, "cone")
