"""The dotted path of an axis, followed through models and tree to the value that it varies."""

from __future__ import annotations

from typing import Any, get_args, get_origin

from lavendersim.experiment.checks.annotations import (
    Model,
    alternatives,
    annotation_of,
    fields,
    is_model,
    model_for,
    names_of,
)
from lavendersim.experiment.models.experiment import CellSource
from lavendersim.experiment.text.node import Node, Path
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.found import nearest, quoted
from lavendersim.quantities.quantity import Vector

SWEPT_SECTIONS = ("scene", "events", "numerics", "duration", "effects", "study")


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
    node: Node | None = root
    found: list[str | int] = []
    for step in steps:
        annotation, key = _enter(annotation, node, step, ".".join(map(str, found)))
        node = node.get(key) if node is not None else None
        if key == "surface" and node is not None and node.text:
            node = root.get("scene", "surfaces", node.text) or node
        found.append(key)
    if not _takes_value(annotation):
        raise _NoPath(f"{path} is a mapping; name one value inside it")
    return tuple(found)


def _enter(annotation: Any, node: Node | None, step: str, where: str) -> tuple[Any, str | int]:
    """Return the type and the key of one step inside `where`."""
    members = alternatives(annotation)
    if any(get_origin(member) is dict for member, _ in members):
        return _enter_names(members, node, step, where)
    lists = [(member, data) for member, data in members if get_origin(member) is tuple]
    into_list = step.isdigit() if node is None else bool(node.items)
    if lists and (into_list or not _models(annotation)):
        return _enter_list(*lists[0], node, step, where)
    if not _models(annotation):
        raise _NoPath(f"{where} is a single value, there is no {quoted(step)} in it")
    model = _model_of(annotation, node, step, where)
    valid = fields(model)
    if step not in valid and (named := names_of(model)) is not None:
        return named, step
    if step not in valid:
        raise _NoPath(f"there is no {quoted(step)} in {where or 'a config'}{nearest(step, valid)}")
    if where and node is None and any(info.is_required() for info in valid.values()):
        raise _NoPath(f"{where} is not written in this file; write it, then sweep {quoted(step)}")
    return annotation_of(valid[step]), step


def _models(annotation: Any) -> list[Model]:
    return [member for member, _ in alternatives(annotation) if is_model(member)]


def _model_of(annotation: Any, node: Node | None, step: str, where: str) -> Model:
    if node is not None and node.text is not None and where != "numerics":
        raise _NoPath(f"{where} is {quoted(node.text)}, there is no {quoted(step)} in it")
    if node is not None and node.number is not None:
        raise _NoPath(f"{where} is a number in this file; write it as a mapping to sweep {step}")
    model = model_for(annotation, node)
    if model is None:
        raise _NoPath(f"{where} has no known kind, so that nothing in it can be swept")
    return model


def _enter_names(
    members: list[tuple[Any, tuple[Any, ...]]], node: Node | None, step: str, where: str
) -> tuple[Any, str]:
    names = node.entries if node is not None else {}
    if step not in names:
        hint = nearest(step, names) or "; nothing is written there"
        raise _NoPath(f"there is no {quoted(step)} in {where}{hint}")
    mapping = next(member for member, _ in members if get_origin(member) is dict)
    return get_args(mapping)[1], step


def _enter_list(
    member: Any, metadata: tuple[Any, ...], node: Node | None, step: str, where: str
) -> tuple[Any, int]:
    length = len(node.items) if node is not None else 0
    if not length:
        raise _NoPath(f"{where} is no list in this file; write it, then sweep {quoted(step)}")
    if not (step.isascii() and step.isdigit() and len(step) < 8 and int(step) < length):
        raise _NoPath(f"{where} has items 0 to {length - 1}, there is no {quoted(step)}")
    vector = next((item for item in metadata if isinstance(item, Vector)), None)
    return (float if vector is not None else get_args(member)[0]), int(step)


def _takes_value(annotation: Any) -> bool:
    """Tell whether one of the forms of this type is a number, a text, a switch or a vector."""
    return any(
        not is_model(member)
        and get_origin(member) is not dict
        and (get_origin(member) is not tuple or _is_vector(metadata))
        and member is not type(None)
        for member, metadata in alternatives(annotation)
    )


def _is_vector(metadata: tuple[Any, ...]) -> bool:
    return any(isinstance(item, Vector) for item in metadata)
