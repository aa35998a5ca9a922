"""What holds between two surfaces: the rule of each property, whatever their order."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.cell import Surface
from lavendersim.cell.mixing import mixed


def test_every_property_has_its_rule() -> None:
    one = Surface(restitution=0.2, compliance=1e-6, friction=0.9, torsional_friction=0.01)
    other = Surface(restitution=0.7, compliance=2e-6, friction=0.4, rolling_friction=0.02)
    pair = mixed(one, other)
    assert pair == mixed(other, one)
    assert pair.restitution == 0.7
    assert pair.compliance == 1e-6 + 2e-6
    assert pair.friction == pytest.approx(0.6, rel=2e-16)
    assert (pair.torsional_friction, pair.rolling_friction) == (0.01, 0.02)


def test_equal_surfaces_keep_their_friction_to_the_last_bit() -> None:
    for mu in np.random.default_rng(1).uniform(0.0, 2.0, 1000):
        surface = Surface(friction=float(mu))
        assert mixed(surface, surface).friction == mu


def test_a_frictionless_surface_stays_frictionless() -> None:
    assert mixed(Surface(friction=0.0), Surface(friction=1.0)).friction == 0.0
