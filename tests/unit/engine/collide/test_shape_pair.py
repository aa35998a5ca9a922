"""Pairs are numbered in their order, one for every two shapes that can touch."""

from __future__ import annotations

from itertools import combinations_with_replacement

import pytest

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.collide.shape_pair import ShapePair, numbered
from lavendersim.engine.collide.shapes import SHAPES
from lavendersim.engine.records import CAVITIES


def pair(name: str, *shapes: str) -> ShapePair:
    return ShapePair(name, shapes, "convex")


def test_the_number_is_the_place_among_those_declared() -> None:
    found = numbered(pair("b", "x", "y"), pair("a", "x", "x"))
    assert list(found) == ["b", "a"]
    assert [each.kind for each in found.values()] == [0, 1]
    assert found["a"].shapes == ("x", "x")


def test_two_pairs_of_one_name_or_of_the_same_shapes_are_refused() -> None:
    for other in (pair("one", "x", "z"), pair("other", "x", "y")):
        with pytest.raises(AssertionError):
            numbered(pair("one", "x", "y"), other)


def test_every_two_shapes_that_can_touch_have_exactly_one_pair() -> None:
    """Two that stand still never touch, and a compound's parts are shapes of their own."""
    solid = [name for name in SHAPES if name not in ("plane", "compound", "mesh", *CAVITIES)]
    expected = [{a, b} for a, b in combinations_with_replacement(solid, 2)]
    expected += [{still, name} for still in ("plane", "mesh", *CAVITIES) for name in solid]
    found = [set(each.shapes) for each in SHAPE_PAIRS.values()]
    assert len(found) == len(expected)
    assert all(shapes in found for shapes in expected)


def test_a_plane_comes_first_and_closed_forms_are_of_round_bodies() -> None:
    for each in SHAPE_PAIRS.values():
        assert CAVITIES.isdisjoint(each.shapes[1:])
        assert {"plane", "mesh"}.isdisjoint(each.shapes[1:])
    closed = {name for name, each in SHAPE_PAIRS.items() if each.closed_form}
    assert closed == {"sphere_sphere", "sphere_box", "sphere_capsule", "capsule_capsule"}
