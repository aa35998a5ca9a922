"""Who can turn: what spins, is twisted, or has contacts that exert a torque. A turn is Cayley's."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from interpreted import interpreted
from plain_facts import body_facts, facts, matrix_fields, one_row, pair_facts, vector_fields

from lavendersim.engine.effects.rotation import EFFECT, make
from lavendersim.engine.spec import Spec

FLOOR = body_facts("floor", "plane", movable=False)


def test_the_matrix_turns_about_omega_by_the_cayley_angle_and_what_is_still_keeps_its_bits() -> (
    None
):
    """tan(angle/2) = |omega| dt/2; by Rodrigues' formula about the world axis."""
    omega, dt = np.array([2.0, -3.0, 6.0]), 0.1
    body = one_row(qw=1.0, qx=0.0, qy=0.0, qz=0.0, **matrix_fields(np.eye(3)))
    kernel = interpreted(make(Spec()))
    assert kernel(body, one_row(**vector_fields("w", omega)), dt)
    angle, k = 2.0 * np.arctan(0.35), np.cross(omega / 7.0, np.eye(3)).T  # k v = omega x v / 7
    expected = np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * k @ k
    found = np.array([[body[f"r{i}{j}"] for j in range(3)] for i in range(3)])
    np.testing.assert_allclose(found, expected, atol=1e-15)
    still = one_row(qw=0.1, qx=0.2, qy=0.3, qz=0.4, **matrix_fields(np.eye(3)))
    assert kernel(still, one_row(**vector_fields("w", (0.0, 0.0, 0.0))), dt)
    assert (still.qw, still.qx, still.qy, still.qz) == (0.1, 0.2, 0.3, 0.4)


@pytest.mark.parametrize(
    ("body", "pair", "on"),
    [
        (body_facts("b", spins=True), None, True),
        (body_facts("b", movable=False, kinematic=True, spins=True), None, True),
        (body_facts("b", movable=False, kinematic=True), None, False),
        (body_facts("b", reoriented=True), None, True),
        (body_facts("b", torque=True), None, True),
        (body_facts("b", twisted=True), None, True),
        (body_facts("b"), None, False),
        (body_facts("b"), {}, True),  # a box is pushed past its centre
        (body_facts("b", "sphere"), {}, False),
        (body_facts("b", "sphere"), {"friction": 0.3}, True),
        (body_facts("b", "sphere"), {"rolling_friction": 0.3}, True),
        (body_facts("b", "sphere"), {"torsional_friction": 0.3}, True),
        (body_facts("b", "sphere", movable=False), {"friction": 0.3}, False),
    ],
)
def test_what_can_turn(body, pair, on: bool) -> None:
    pairs = () if pair is None else (pair_facts("floor", "b", **pair),)
    assert EFFECT.decide(facts(FLOOR, body, pairs=pairs)).on is on


def test_friction_turns_those_who_have_it_and_bodies_alike_to_them() -> None:
    """A pair stands for all of its kinds: a ball of the same surface is turned, another is not."""

    def ball(name: str, own: str):
        return body_facts(name, "sphere", config=SimpleNamespace(surface=own))

    pairs = (pair_facts("floor", "one", friction=0.5), pair_facts("floor", "slick"))
    bodies = FLOOR._replace(config=ball("floor", "f").config), ball("one", "a"), ball("two", "a")
    found = EFFECT.decide(facts(*bodies, ball("slick", "s"), pairs=pairs))
    assert found.on
    assert "one, two: friction exerts a torque" in found.reason
    assert "slick cannot turn" in found.reason
