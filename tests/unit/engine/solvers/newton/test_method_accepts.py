"""What a round of Newton's method ends with is in the cone of each contact."""

from __future__ import annotations

import pytest
from interpreted import interpreted
from plain_facts import one_row

from lavendersim.engine.solvers.newton.method import make_accept
from lavendersim.engine.spec import Spec


@pytest.mark.parametrize(("found", "left"), [((3.0, 4.0), (0.6, 0.8)), ((-0.3, 0.4), (-0.3, 0.4))])
def test_what_is_outside_of_the_cone_is_brought_onto_it_along_its_direction(found, left) -> None:
    """Of a radius mu n = 1 N s."""
    set_to = []

    def set_impulse(contact, velocities, n, one, two):
        set_to.append((n, one, two))

    def response(contact, length):
        return (2.0, *found)

    accept = interpreted(make_accept(Spec(("friction", "newton")), set_impulse, response))
    accept([one_row(mu=0.5)], 1, None)
    assert set_to == [pytest.approx((2.0, *left), rel=1e-15)]
