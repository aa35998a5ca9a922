"""A cavity has its radius, no other side and no extent; it is never moved by contacts."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lavendersim.cell import Bowl, Drum
from lavendersim.cell.shapes import PRIMITIVES, Cavity
from lavendersim.geometry.shapes import bounding_radius, extent, pieces, thickness
from lavendersim.quantities.kinds import kind_of

CAVITIES = (Bowl(kind="bowl", radius=0.5), Drum(kind="drum", radius=0.5))


@pytest.mark.parametrize("cavity", CAVITIES, ids=lambda one: one.kind)
def test_a_cavity_is_as_large_as_what_is_in_it_and_has_no_end(cavity: Cavity) -> None:
    assert bounding_radius(cavity) == 0.5
    assert thickness(cavity) == math.inf
    assert pieces(cavity) == ()
    with pytest.raises(ValueError, match=f"a {cavity.kind} has no extent"):
        extent(cavity, np.eye(3), np.array([0.0, 0.0, 1.0]))


def test_every_solid_that_ships_has_a_place_in_it() -> None:
    assert {*map(kind_of, PRIMITIVES), "hull"} == Cavity.HOLDS
