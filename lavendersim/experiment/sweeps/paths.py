"""The dotted path of an axis, followed through models and tree to the value that it varies."""

from __future__ import annotations

from typing import Any, Final, get_origin

from lavendersim.experiment.checks.annotations import (
    Model,
    alternatives,
    fields,
    inside,
    is_model,
    is_vector,
    model_for,
    models_of,
    names_of,
)
from lavendersim.experiment.models.experiment import CellSource
from lavendersim.experiment.models.surface_pairs import paired
from lavendersim.experiment.text.node import Node, Path
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.found import nearest, quoted

# Keys whose value may be the name of an entry of a section of the scene.
NAMED: Final = {"surface": "surfaces", "shape": "shapes"}
SWEPT_SECTIONS = (
    *("constants", "scene", "events", "numerics", "duration", "effects", "study"),
    *("engine", "engines"),
)


class _NoPath(Exception):  # noqa: N818 - carries the sentence; never leaves this module
    pass


def find_path(path: Node, root: Node, report: Report) -> Path | None:
    """Return the steps of a path that a sweep may vary; notes why it may not."""
    try:
        return _resolve(path.text or "", root)
    except _NoPath as reason:
        report.add(path.mark, f"path: {reason}")
        return None


def _resolve(path: str, root: Node) -> Path:
    steps = path.split(".")
    if steps[0] not in SWEPT_SECTIONS:
        reached = ", ".join(SWEPT_SECTIONS)
        raise _NoPath(f"a sweep cannot reach {quoted(steps[0])}; it reaches {reached}")
    annotation: Any = CellSource
    node = root
    found: list[str | int] = []
    for step in steps:
        annotation, key = _enter(annotation, node, step, ".".join(map(str, found)))
        node = node.get(key)
        if key in NAMED and node.text:
            if key == "surface" and len(found) + 1 < len(steps):
                _refuse_paired(node.text, root, path, ".".join(steps[len(found) + 1 :]))
            node = root.get("scene", NAMED[key], node.text) or node
        found.append(key)
    by_name = found[-1] in NAMED and root.get("scene", NAMED[str(found[-1])])
    if not by_name and not _takes_value(annotation):
        raise _NoPath(f"{path} is a mapping; name one value inside it")
    return tuple(found)


def _refuse_paired(surface: str, root: Node, path: str, key: str) -> None:
    """A body's own copy of a surface has no name, and would leave the pairs that name it."""
    if pair := paired(root, surface):
        instead = f"scene.surfaces.{surface}.{key} or scene.surface_pairs.{pair}.{key}"
        reason = f"which {pair} of surface_pairs names"
        raise _NoPath(f"{path} enters {quoted(surface)}, {reason}; expected {instead}")


def _enter(annotation: Any, node: Node, step: str, where: str) -> tuple[Any, str | int]:
    """Return the type and the key of one step inside `where`."""
    if (named := inside(annotation, dict)) is not None:
        return named, _name(node, step, where)
    models, item = models_of(annotation), inside(annotation, tuple)
    into_list = bool(node.items) if node else step.isdigit()
    if item is not None and (into_list or not models):
        return item, _index(node, step, where)
    if not models:
        raise _NoPath(f"{where} is a single value, there is no {quoted(step)} in it")
    model = _model_of(annotation, node, step, where)
    valid = fields(model)
    if step not in valid and (named := names_of(model)) is not None:
        return named, step
    if step not in valid:
        raise _NoPath(f"there is no {quoted(step)} in {where or 'a config'}{nearest(step, valid)}")
    if where and not node and any(info.is_required() for info in valid.values()):
        raise _NoPath(f"{where} is not written in this file; write it, then sweep {quoted(step)}")
    return valid[step].annotation, step


def _model_of(annotation: Any, node: Node, step: str, where: str) -> Model:
    if node.text is not None and where != "numerics":
        raise _NoPath(f"{where} is {quoted(node.text)}, there is no {quoted(step)} in it")
    if node.number is not None:
        raise _NoPath(f"{where} is a number in this file; write it as a mapping to sweep {step}")
    model = model_for(annotation, node)
    if model is None:
        raise _NoPath(f"{where} has no known kind, so that nothing in it can be swept")
    return model


def _name(node: Node, step: str, where: str) -> str:
    if step not in node.entries:
        hint = nearest(step, node.entries) or "; nothing is written there"
        raise _NoPath(f"there is no {quoted(step)} in {where}{hint}")
    return step


def _index(node: Node, step: str, where: str) -> int:
    length = len(node.items)
    if not length:
        raise _NoPath(f"{where} is no list in this file; write it, then sweep {quoted(step)}")
    if not (step.isascii() and step.isdigit() and len(step) < 8 and int(step) < length):
        raise _NoPath(f"{where} has items 0 to {length - 1}, there is no {quoted(step)}")
    return int(step)


def _takes_value(annotation: Any) -> bool:
    """Tell whether one of the forms of this type is a number, a text, a switch or a vector."""
    return any(
        is_vector(member)
        or not (is_model(member) or get_origin(member) in (dict, tuple) or member is type(None))
        for member in alternatives(annotation)
    )
