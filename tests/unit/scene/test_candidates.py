"""Candidates are all pairs of rows of which one moves, in the order their kernel takes them."""

from __future__ import annotations

import math

import pytest

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.scene.candidates import candidate_pairs
from tests.made_cells import made_body

BALL = {"kind": "sphere", "radius": 0.1}
BOX = {"kind": "box", "size": [1.0, 1.0, 1.0]}
PLANE = {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}


@pytest.mark.parametrize("balls", [0, 1, 2, 7])
def test_n_balls_on_a_floor_are_n_and_n_over_two_pairs(balls: int) -> None:
    pairs = candidate_pairs([made_body(PLANE), *[made_body(BALL)] * balls])
    assert len(pairs) == balls + math.comb(balls, 2)
    assert len({frozenset((one.a, one.b)) for one in pairs}) == len(pairs)


def test_two_that_never_move_are_none() -> None:
    assert candidate_pairs([made_body(PLANE), made_body(BOX, fixed=True)]) == []


@pytest.mark.parametrize("bodies", [(BOX, BALL), (BALL, BOX)])
def test_the_order_is_that_of_the_kernel_whatever_the_order_of_bodies(bodies: tuple) -> None:
    (one,) = candidate_pairs([made_body(shape) for shape in bodies])
    kinds = bodies[one.a]["kind"], bodies[one.b]["kind"]
    assert kinds == SHAPE_PAIRS[one.shape_pair].shapes


def test_surfaces_are_mixed() -> None:
    bodies = [
        made_body(PLANE, surface={"friction": 0.9}),
        made_body(BALL, surface={"friction": 0.4}),
    ]
    (pair,) = candidate_pairs(bodies)
    assert pair.surface.friction == pytest.approx(0.6, rel=1e-15)  # the geometric mean
