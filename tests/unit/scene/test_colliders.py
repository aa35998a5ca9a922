"""Rows of the body table: bodies in their order, then the parts of compounds with their owner."""

from __future__ import annotations

from lavendersim.scene.candidates import candidate_pairs
from lavendersim.scene.colliders import colliders, parts_of
from tests.made_cells import ORIGIN, UPRIGHT, made_body

BALL = {"kind": "sphere", "radius": 0.1}
PLANE = {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}
PART = {"shape": BALL, "position": ORIGIN, "orientation": UPRIGHT}
COMPOUND = {"kind": "compound", "parts": [PART, PART], "centre": ORIGIN, "axes": UPRIGHT}
BODIES = [made_body(COMPOUND), made_body(PLANE), made_body(COMPOUND)]


def test_parts_stand_behind_all_bodies_with_their_owner() -> None:
    rows = colliders(BODIES)
    assert [row.kind for row in rows] == ["compound", "plane", "compound", *["sphere"] * 4]
    assert [row.owner for row in rows] == [0, 1, 2, 0, 0, 2, 2]
    assert [row.part is None for row in rows] == [True] * 3 + [False] * 4
    assert all(row.body is BODIES[row.owner] for row in rows)


def test_only_a_compound_has_parts() -> None:
    assert parts_of(BODIES[1].shape) == ()
    assert len(parts_of(BODIES[0].shape)) == 2


def test_parts_of_one_body_are_no_pair() -> None:
    pairs = [{one.a, one.b} for one in candidate_pairs(BODIES)]
    assert {3, 4} not in pairs
    assert {3, 5} in pairs
