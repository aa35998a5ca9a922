"""What a round of Newton's method ends with is in the cone of each contact."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import drawn, stacked, views
from interpreted import interpreted
from plain_facts import one_row

from lavendersim.engine.solvers.newton.method import (
    make_accept,
    make_keep,
    make_restore,
    make_set_impulse,
)
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


def test_the_best_impulses_are_restored_with_their_velocities(rng) -> None:
    spec = Spec(("friction", "newton", "rotation"))
    scene = drawn(spec, rng, [(0, 1), (1, 2), (2, 0)])
    _, velocities, contacts = views(scene)
    names = ["lambda_n", "lambda_1", "lambda_2"]
    best, motion = [scene.contacts[name].copy() for name in names], scene.motion.copy()
    interpreted(make_keep(spec))(contacts, 3)
    set_impulse = make_set_impulse(spec)
    for contact in contacts:
        interpreted(set_impulse)(contact, velocities, *rng.normal(size=3))
    assert abs(scene.motion - motion).max() > 0.1
    interpreted(make_restore(spec, "best", set_impulse))(contacts, 3, velocities)
    for name, value in zip(names, best, strict=True):
        np.testing.assert_array_equal(scene.contacts[name], value)
    np.testing.assert_allclose(stacked(scene.velocities), motion, atol=1e-13)
