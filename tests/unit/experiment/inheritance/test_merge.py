"""A config over the one that it extends: mappings merge, all else replaces, null removes."""

from __future__ import annotations

from typing import Any

import pytest

from lavendersim.experiment.inheritance.merge import merged
from lavendersim.experiment.text.node import Node
from lavendersim.experiment.text.parse import parse
from lavendersim.experiment.text.report import Report


def tree(text: str, file: str = "") -> Node:
    report = Report(file)
    node = parse(text.encode(), report, file=file)
    assert node is not None
    assert report.defects == ()
    return node


def over(parent: str, child: str) -> Any:
    report = Report("child.yaml")
    data = merged(tree(parent), tree(child), report).data
    assert report.defects == ()
    return data


@pytest.mark.parametrize(
    ("parent", "child", "expected"),
    [
        ("{a: {b: 1, c: 2}}", "{a: {c: 3, d: 4}}", {"a": {"b": 1, "c": 3, "d": 4}}),
        ("{a: [1, 2, 3]}", "{a: [4]}", {"a": (4,)}),
        ("{a: {b: 1}}", "{a: 5}", {"a": 5}),
        ("{a: 1, b: 2}", "{a: null}", {"b": 2}),
        ("{b: 2}", "{a: null}", {"b": 2, "a": None}),  # refused later, with its place
        ("{a: {kind: box, size: 1}}", "{a: {kind: sphere}}", {"a": {"kind": "sphere"}}),
        ("{a: {kind: box, size: 1}}", "{a: {size: 2}}", {"a": {"kind": "box", "size": 2}}),
        (
            "{numerics: chapter}",
            "{numerics: {sweeps: 4}}",
            {"numerics": {"preset": "chapter", "sweeps": 4}},
        ),
        ("{numerics: {sweeps: 4}}", "{numerics: chapter}", {"numerics": "chapter"}),
        (
            "{numerics: {tolerance: 1}}",
            "{numerics: {tolerance: null}}",
            {"numerics": {"tolerance": None}},
        ),
        (
            "{sweep: {e: {path: p, values: [1, 2]}}}",
            "{sweep: {e: {values: [3]}, f: {path: q, values: [4]}}}",
            {"sweep": {"e": {"path": "p", "values": (3,)}, "f": {"path": "q", "values": (4,)}}},
        ),
    ],
)
def test_what_a_child_says_of_a_key(parent: str, child: str, expected: Any) -> None:
    found = over(parent, child)
    assert found == expected
    assert list(found) == list(expected)


def test_bodies_keep_the_order_of_the_parent() -> None:
    """It decides the order of contacts in the solver."""
    found = over("{scene: {bodies: {a: 1, b: 2}}}", "{scene: {bodies: {c: 3, b: 4}}}")
    assert list(found["scene"]["bodies"]) == ["a", "b", "c"]


def test_expectations_merge_by_their_names() -> None:
    parent = "{expect: [{name: x, at_most: 1}, {name: y, at_most: 2}, {name: z, at_most: 3}]}"
    child = (
        "{expect: [{name: w, at_most: 0}, {name: y, remove: true}, "
        "{name: x, at_most: null, at_least: 5}]}"
    )
    assert over(parent, child)["expect"] == (
        {"name": "x", "at_least": 5},
        {"name": "z", "at_most": 3},
        {"name": "w", "at_most": 0},
    )


def test_removing_an_expectation_that_is_not_there_is_refused_with_the_nearest_name() -> None:
    report = Report("child.yaml")
    child = tree("expect:\n  - {name: rebuond, remove: true}\n")
    merged(tree("{expect: [{name: rebound, at_most: 1}]}"), child, report)
    assert [str(defect) for defect in report.defects] == [
        'child.yaml:2:12: remove: no expectation of the parent is called "rebuond"; '
        'did you mean "rebound"?'
    ]


def test_every_node_keeps_the_file_and_place_that_says_it() -> None:
    both = merged(
        tree("{a: {b: 1,\n c: 2}}", "base.yaml"), tree("{a: {c: 3}}"), Report("child.yaml")
    )
    assert both.get("a", "b").mark == (1, 9, "base.yaml")
    assert both.get("a", "c").mark == (1, 9, "")
    assert both.get("a").keys["b"] == (1, 6, "base.yaml")
