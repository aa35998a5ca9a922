"""What does nothing: a surface of no body, a run of which nothing is claimed."""

from __future__ import annotations

import pytest

from tests.unit.lint.scenes import config, found

BALL = "ball: {shape: {kind: sphere, radius: 1}, mass: 1, position: [0, 0, 1], surface: %s}"
SURFACES = "  surfaces: {rubber: {restitution: 0.5}, steel: {restitution: 0.9}}\n"


def test_a_surface_of_no_body_is_pointed_at() -> None:
    (defect,) = found(config(BALL % "steel", surfaces=SURFACES))
    assert (defect.line, defect.message) == (2, 'surface "rubber" is that of no body')


def test_a_surface_that_a_pair_alone_names_is_that_of_no_body() -> None:
    pairs = "  surface_pairs: {hard: {between: [rubber, steel], friction: 0.1}}\n"
    (defect,) = found(config(BALL % "steel", surfaces=SURFACES + pairs))
    assert defect.message == 'surface "rubber" is that of no body'


def test_a_surface_that_a_sweep_chooses_is_used() -> None:
    sweep = "sweep: {s: {path: scene.bodies.ball.surface, values: [rubber, steel]}}\nalways: {}\n"
    assert found(config(BALL % "steel", surfaces=SURFACES, rest=sweep)) == []


@pytest.mark.parametrize(
    ("rest", "claims"),
    [
        ("", False),
        ("measure: {v: {kind: top_speed}}\n", False),
        ("always: {}\n", True),
        ("measure: {v: {kind: top_speed}}\nexpect: [{name: v, measure: v, at_most: 1}]\n", True),
    ],
)
def test_a_run_of_which_nothing_is_claimed_is_pointed_at(rest: str, claims: bool) -> None:
    messages = [defect.message for defect in found(config(BALL % "{}", rest=rest))]
    assert len(messages) == (not claims)


def test_a_constant_that_no_formula_takes_is_pointed_at() -> None:
    ball = "ball: {shape: {kind: sphere, radius: $r}, mass: 1, position: [0, 0, 1]}"
    text = "constants: {r: 1, g_eff: 9.81}\n" + config(ball, rest="always: {}\n")
    (defect,) = found(text)
    sentence = 'constant "g_eff" is not used; a formula takes it as $g_eff'
    assert (defect.line, defect.column, defect.message) == (1, 19, sentence)


def test_a_shape_of_no_body_is_pointed_at() -> None:
    ball = "ball: {shape: small, mass: 1, position: [0, 0, 1]}"
    shapes = "  shapes: {small: {kind: sphere, radius: 1}, large: {kind: sphere, radius: 2}}\n"
    (defect,) = found(config(ball, surfaces=shapes, rest="always: {}\n"))
    assert defect.message == 'shape "large" is that of no body'
