"""Shapes by name: `shape: cube` becomes what `scene.shapes` says of cube."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from lavendersim.experiment.models.tree import ARRANGEMENTS, BODIES
from lavendersim.experiment.text.node import BROKEN, Node, graft
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.found import nearest, quoted

SHAPE: Final = "shape"


def with_named_shapes(root: Node, report: Report) -> Node:
    """Return the tree with the shapes of names in bodies and arrangements; notes unknown names."""
    shapes = root.get("scene", "shapes").entries
    if not shapes:
        return root
    bodies = root.get(*BODIES)
    named = {key: _with_shape(body, shapes, report) for key, body in bodies.entries.items()}
    if bodies:
        root = graft(root, BODIES, replace(bodies, content=named))
    arrangements = root.get(*ARRANGEMENTS)
    for name, arrangement in arrangements.entries.items():
        for key in ("body", "first"):
            if body := arrangement.get(key):
                shaped = _with_shape(body, shapes, report)
                root = graft(root, (*ARRANGEMENTS, name, key), shaped)
    return root


def _with_shape(body: Node, shapes: dict[str, Node], report: Report) -> Node:
    shape = body.get(SHAPE)
    if shape.text is None:
        return body
    named = shapes.get(shape.text)
    if named is None:
        sentence = f"{SHAPE}: no shape is called {quoted(shape.text)}{nearest(shape.text, shapes)}"
        report.add(shape.mark, sentence)
        named = Node(BROKEN, shape.mark)
    return replace(body, content={**body.entries, SHAPE: named})
