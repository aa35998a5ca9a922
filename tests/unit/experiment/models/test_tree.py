"""Bodies of a tree by name: those written, and members of arrangements by their numbers."""

from __future__ import annotations

from typing import Any

import pytest

from lavendersim.experiment.models.tree import (
    MOST_BODIES,
    bodies_of,
    body_path,
    described,
    immovable,
    members,
    removals,
    swept_values,
)
from lavendersim.experiment.text.node import Mark, Node

AT = Mark(1, 1)


def tree(value: Any) -> Node:
    """Return plain data as nodes."""
    if isinstance(value, dict):
        return Node({key: tree(one) for key, one in value.items()}, AT)
    if isinstance(value, list):
        return Node(tuple(map(tree, value)), AT)
    return Node(value, AT)


@pytest.mark.parametrize(
    ("arrangement", "bodies"),
    [
        ({"kind": "tower", "count": 30}, 30),
        ({"kind": "pyramid", "base_count": 4}, 4 + 3 + 2 + 1),
        ({"kind": "rack", "rows": 5}, 15),
        ({"kind": "grid", "counts": [2, 3, 4]}, 24),
        ({"kind": "grid", "counts": [2, 3]}, 0),
        ({"kind": "tower", "count": "many"}, 0),
        ({"kind": "tower", "count": MOST_BODIES + 1}, 0),
        ({"kind": "heap", "count": 3}, 0),
    ],
)
def test_how_many_bodies_an_arrangement_has(arrangement: dict[str, Any], bodies: int) -> None:
    assert members(tree(arrangement)) == bodies


SCENE = tree(
    {
        "scene": {
            "bodies": {"floor": {"shape": {"kind": "plane"}}},
            "arrangements": {
                "row": {"kind": "row", "count": 3, "body": {"mass": 1.0}, "first": {"mass": 9.0}}
            },
        },
        "events": [
            {"at": 2.0, "body": "row_2", "remove": True},
            {"at": 1.0, "body": "row_2", "remove": True},
            {"at": 0.5, "body": "row_2"},
        ],
        "sweep": [{"e": {"values": [0.1, 0.2]}}, {"e": {"values": [0.3]}}],
    }
)


def test_members_stand_behind_written_bodies_and_the_first_has_its_own_node() -> None:
    bodies = bodies_of(SCENE)
    assert list(bodies) == ["floor", "row_1", "row_2", "row_3"]
    assert [bodies[f"row_{k}"].get("mass").number for k in (1, 2, 3)] == [9.0, 1.0, 1.0]
    assert body_path(SCENE, "row_3") == ("scene", "arrangements", "row", "body")
    assert body_path(SCENE, "row_4") == ()
    assert [name for name, _ in described(SCENE)] == ["floor", "row", "row_1"]


def test_why_nothing_moves_a_body() -> None:
    lift = tree({"kinematic": True})
    assert immovable(bodies_of(SCENE)["floor"], prescribed=False) == "a plane"
    assert immovable(tree({"fixed": True}), prescribed=False) == "fixed"
    assert immovable(lift, prescribed=True) == "kinematic"
    assert immovable(lift, prescribed=False) is None


def test_the_first_removal_of_a_body_counts() -> None:
    (one,) = removals(SCENE).values()
    assert (one.at, one.event) == (1.0, 1)
    assert one.sentence("body", "row_2") == 'body: "row_2" is removed at 1 s by events[1]'


def test_values_of_an_axis_are_those_of_all_products() -> None:
    assert [node.number for node in swept_values(SCENE)["e"]] == [0.1, 0.2, 0.3]
