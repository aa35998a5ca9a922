"""A belt's velocity shifts the slip by its tangential parts, in the frame of its body."""

from __future__ import annotations

from types import SimpleNamespace

import convex
import numpy as np
from interpreted import interpreted
from plain_facts import body_facts, facts, matrix_fields, one_row, pair_facts, vector_fields

from lavendersim.engine.effects.surface_velocity import EFFECT, body_values, make, resolve
from lavendersim.engine.spec import Spec


def test_the_slip_has_that_of_b_less_that_of_a_along_the_tangents(rng) -> None:
    kernel = interpreted(make(Spec()))
    for _ in range(10):
        frame, one, other = (convex.random_rotation(rng) for _ in range(3))
        s_a, s_b = rng.normal(size=(2, 3))
        contact = one_row(
            surface_1=0.0, surface_2=0.0, **vector_fields("t1", frame[:, 1]),
            **vector_fields("t2", frame[:, 2]),
        )  # fmt: skip
        bodies = [
            one_row(**matrix_fields(turn), **vector_fields("s", s))
            for turn, s in ((one, s_a), (other, s_b))
        ]
        kernel(contact, *bodies)
        expected = frame[:, 1:].T @ (other @ s_b - one @ s_a)
        np.testing.assert_allclose((contact.surface_1, contact.surface_2), expected, atol=1e-14)


def test_a_config_says_it_in_the_bodys_frame() -> None:
    belt = SimpleNamespace(surface_velocity=(1.0, 2.0, 3.0))
    assert body_values(belt) == {"sx": 1.0, "sy": 2.0, "sz": 3.0}
    assert resolve((1.0, 2.0, 3.0), lambda v: (v[1], v[2], v[0])) == (2.0, 3.0, 1.0)


def test_it_is_on_where_a_surface_moves_and_something_has_friction() -> None:
    def decided(speeds, friction: float):
        belt, *later = (SimpleNamespace(surface_velocity=(s, 0.0, 0.0)) for s in speeds)
        body = body_facts("belt", config=belt, later=tuple(later))
        return EFFECT.decide(facts(body, pairs=(pair_facts("belt", "box", friction=friction),))).on

    assert decided((1.0,), 0.5)
    assert decided((0.0, 1.0), 0.5)  # by an event
    assert not decided((0.0,), 0.5)
    assert not decided((1.0,), 0.0)
