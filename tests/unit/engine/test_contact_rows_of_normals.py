"""Rows without friction: levers and effective mass of joints' motors and of what meets aside."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import cross_matrix, drawn, put_vector, views
from interpreted import interpreted
from plain_facts import one_row, vector_fields

from lavendersim.engine.contact import add_couple, make_complete_row
from lavendersim.engine.spec import Spec

TURNS = Spec(("contact_torque", "friction", "rotation"))
SWEPT = Spec(("contact_torque", "fast_bodies", "frictionless_contact", "rotation"))


def test_a_motor_turns_both_bodies_about_its_arm(rng) -> None:
    """k = x . (1/I_a + 1/I_b) x, of inertias along any axes."""
    scene = drawn(TURNS, rng, [(0, 1)], fixed=())
    bodies, _, _ = views(scene)
    x = rng.normal(size=3)
    filled = [f"{name}_{body}" for name in ("lever", "turn") for body in "ab"]
    rows = {name: value for one in filled for name, value in vector_fields(one, x).items()}
    contact = one_row(**vector_fields("arm_a", x), **dict.fromkeys(rows, 0.0))
    k = interpreted(add_couple)(contact, bodies[0], bodies[1])
    inverse = [scene.inverse[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6] for i in (0, 1)]
    assert k == pytest.approx(x @ (inverse[0] + inverse[1]) @ x, rel=1e-14)
    for body, own in zip("ab", inverse, strict=True):
        for name, expected in (("lever", x), ("turn", own @ x)):
            found = [contact[f"{name}_{body}{axis}"] for axis in "xyz"]
            np.testing.assert_allclose(found, expected, rtol=1e-13)


def test_what_is_met_aside_has_its_lever_where_the_body_will_be(rng) -> None:
    """Of B, that is farther on by what it moves along the surface until then."""
    scene = drawn(SWEPT, rng, [(0, 1)], fixed=())
    bodies, _, contacts = views(scene)
    row, aside = scene.contacts[0], rng.normal(size=3)
    put_vector(row, "tangential_", aside)
    k = interpreted(make_complete_row(SWEPT))(contacts[0], bodies[0], bodies[1])
    n, point = ([row[f"{name}{axis}"] for axis in "xyz"] for name in ("n", ""))
    expected = 0.0
    for i, moved in ((0, np.zeros(3)), (1, aside)):
        place = np.array([scene.bodies[axis][i] for axis in "xyz"]) + moved
        lever = cross_matrix(np.array(point) - place) @ n
        turn = scene.inverse[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6] @ lever
        expected += scene.bodies["inv_m"][i] + lever @ turn
    assert k == pytest.approx(expected, rel=1e-13)
