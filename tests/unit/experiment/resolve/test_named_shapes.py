"""A shape by name is what `scene.shapes` says of it, in bodies and arrangements."""

from __future__ import annotations

from typing import Any

from lavendersim.experiment.resolve.named_shapes import with_named_shapes
from lavendersim.experiment.text.node import BROKEN, Mark, Node
from lavendersim.experiment.text.report import Report

CUBE = {"kind": "box"}


def tree(value: Any, line: int = 1) -> Node:
    """Return plain data as nodes, each entry of a mapping on a line of its own."""
    if isinstance(value, dict):
        content = {key: tree(one, line + k) for k, (key, one) in enumerate(value.items())}
        return Node(content, Mark(line, 1))
    return Node(value, Mark(line, 1))


def test_names_become_shapes() -> None:
    scene = {
        "shapes": {"cube": CUBE},
        "bodies": {"a": {"shape": "cube"}, "b": {"shape": {"kind": "sphere"}}, "c": {}},
        "arrangements": {"row": {"body": {"shape": "cube"}, "first": {"shape": "cube"}}},
    }
    report = Report("a.yaml")
    root = with_named_shapes(tree({"scene": scene}), report)
    assert report.defects == ()
    bodies = root.get("scene", "bodies").data
    assert bodies == {"a": {"shape": CUBE}, "b": {"shape": {"kind": "sphere"}}, "c": {}}
    row = root.get("scene", "arrangements", "row").data
    assert row == {"body": {"shape": CUBE}, "first": {"shape": CUBE}}


def test_a_name_of_none_is_said_once_with_the_nearest() -> None:
    report = Report("a.yaml")
    scene = {"shapes": {"cube": CUBE}, "bodies": {"a": {"shape": "cubes"}}}
    root = with_named_shapes(tree({"scene": scene}), report)
    (defect,) = report.defects
    assert defect.message == 'shape: no shape is called "cubes"; did you mean "cube"?'
    assert root.get("scene", "bodies", "a", "shape").content is BROKEN


def test_without_shapes_a_text_is_left_to_be_refused_elsewhere() -> None:
    root = tree({"scene": {"bodies": {"a": {"shape": "cube"}}}})
    assert with_named_shapes(root, Report("a.yaml")) is root
