"""The first body of an arrangement has its own keys, and the others' for the rest."""

from __future__ import annotations

from typing import Any

import pytest

from lavendersim.experiment.resolve.first_members import with_first_members
from lavendersim.experiment.text.node import Mark, Node

AT = Mark(1, 1)


def tree(value: Any) -> Node:
    """Return plain data as nodes."""
    if isinstance(value, dict):
        return Node({key: tree(one) for key, one in value.items()}, AT)
    return Node(value, AT)


def first(own: dict[str, Any], body: dict[str, Any]) -> Any:
    """Return what the first body of an arrangement is."""
    root = tree({"scene": {"arrangements": {"row": {"body": body, "first": own}}}})
    found = with_first_members(root)
    assert found.get("scene", "arrangements", "row", "body").data == body
    return found.get("scene", "arrangements", "row", "first").data


@pytest.mark.parametrize(
    ("own", "whole"),
    [
        ({"surface": "ice"}, {"mass": 1.0, "surface": "ice"}),
        ({"density": 2.0}, {"density": 2.0, "surface": "wood"}),  # in place of the mass
        ({"mass": 3.0}, {"mass": 3.0, "surface": "wood"}),
        ({"fixed": True}, {"fixed": True, "surface": "wood"}),  # has no mass
        ({"kinematic": True}, {"kinematic": True, "surface": "wood"}),
        ({"fixed": False}, {"fixed": False, "mass": 1.0, "surface": "wood"}),
    ],
)
def test_own_keys_stand_over_those_of_the_body(own: dict[str, Any], whole: dict[str, Any]) -> None:
    assert first(own, {"mass": 1.0, "surface": "wood"}) == whole


def test_inertia_without_a_mass_of_its_own_stands_beside_the_bodys_mass() -> None:
    body = {"mass": 1.0, "inertia": 5.0}
    assert first({"inertia": 2.0}, body) == {"mass": 1.0, "inertia": 2.0}
    assert first({"mass": 2.0}, body) == {"mass": 2.0}  # the other one's inertia is not of it


def test_without_a_first_nothing_changes() -> None:
    root = tree({"scene": {"arrangements": {"row": {"body": {"mass": 1.0}}}}})
    assert with_first_members(root) is root
