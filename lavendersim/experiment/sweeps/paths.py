"""The dotted path of an axis, followed to the value that it varies.

What stands on the way is read from the tree, and what may stand there is asked of pydantic: it
validates a config that has nothing but the path, with something at its end that no type takes, and
where it refuses what tells what each step leads into.
"""

from __future__ import annotations

from typing import Any, Final

from pydantic import ValidationError

from lavendersim.experiment.checks.messages import Model, fields
from lavendersim.experiment.models.experiment import CellSource
from lavendersim.experiment.models.surface_pairs import paired
from lavendersim.experiment.text.node import Node, Path
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.chosen_kind import NO_KIND
from lavendersim.quantities.found import nearest, quoted

# Keys whose value may be the name of an entry of a section of the scene.
NAMED: Final = {"surface": "surfaces", "shape": "shapes"}
SWEPT_SECTIONS = (
    *("constants", "scene", "events", "numerics", "duration", "effects", "study"),
    *("engine", "engines"),
)
# Errors of what is a mapping, or a list of any length, in every form.
_COLLECTIONS: Final = {"model_type", "dict_type", "tuple_type", NO_KIND}


class _NoPath(Exception):  # noqa: N818 - carries the sentence; never leaves this module
    pass


class _Probe:
    """A config with one path, as pydantic reads it: a context that learns what models it enters."""

    def __init__(self, nodes: list[Node], path: Path) -> None:
        self._models: dict[int, Model] = {}
        self._data = [data := _NOTHING]
        for node, step in zip(reversed(nodes), reversed(path), strict=True):
            self._data.append(data := _holding(node, step, data))
        self._data.reverse()
        self.refused: list[set[str]] = [set() for _ in self._data]  # types of errors, by steps
        try:
            CellSource.model_validate(data, context=self)
        except ValidationError as error:
            for item in error.errors(include_url=False):
                if item["type"] != "missing":
                    depth = _depth(item["loc"], path)
                    self.refused[depth].add(item["type"])

    def model(self, depth: int) -> Model | None:
        """Return the model that the mapping behind so many steps is read as."""
        return self._models.get(id(self._data[depth]))

    def enter(self, model: Model, data: object) -> None:
        """Note a model that pydantic enters."""
        self._models[id(data)] = model

    def refusal_of(self, kind: str, name: str) -> None:
        """Take any name: others of the config are not there."""


_NOTHING: Final = object()  # no type takes it


def find_path(path: Node, root: Node, report: Report) -> Path | None:
    """Return the steps of a path that a sweep may vary; notes why it may not."""
    text = path.text or ""
    try:
        return _resolve(text, root)
    except _NoPath as reason:
        whole = _with_section(text, root)
        hint = f"; did you mean {whole}?" if whole else ""
        report.add(path.mark, f"path: {reason}{hint}")
        return None


def _with_section(path: str, root: Node) -> str | None:
    """Return the path with the section that it leaves out in front, where one has such a value."""
    if path.split(".")[0] in SWEPT_SECTIONS:
        return None
    for section in ("scene", "scene.bodies", "numerics"):
        try:
            _resolve(whole := f"{section}.{path}", root)
        except _NoPath:
            continue
        return whole
    return None


def _resolve(path: str, root: Node) -> Path:
    steps = path.split(".")
    if steps[0] not in SWEPT_SECTIONS:
        reached = ", ".join(SWEPT_SECTIONS)
        raise _NoPath(f"a sweep cannot reach {quoted(steps[0])}; it reaches {reached}")
    found: list[str | int] = []
    nodes = [root]
    for step in steps:
        key = _index(nodes[-1], step, ".".join(steps[: len(found)])) if nodes[-1].items else step
        node = nodes[-1].get(key)
        found.append(key)
        if key in NAMED and node.text:
            if key == "surface" and len(found) < len(steps):
                _refuse_paired(node.text, root, path, ".".join(steps[len(found) :]))
            node = root.get("scene", NAMED[str(key)], node.text) or node
        nodes.append(node)
    probe = _Probe(nodes[:-1], tuple(found))
    for depth, step in enumerate(steps):
        _enter(probe, depth, nodes[depth], step, ".".join(steps[:depth]))
    by_name = found[-1] in NAMED and root.get("scene", NAMED[str(found[-1])])
    refused = probe.refused[-1]
    if not by_name and refused and refused <= _COLLECTIONS:
        raise _NoPath(f"{path} is a mapping; name one value inside it")
    return tuple(found)


def _refuse_paired(surface: str, root: Node, path: str, key: str) -> None:
    """A body's own copy of a surface has no name, and would leave the pairs that name it."""
    if pair := paired(root, surface):
        instead = f"scene.surfaces.{surface}.{key} or scene.surface_pairs.{pair}.{key}"
        reason = f"which {pair} of surface_pairs names"
        raise _NoPath(f"{path} enters {quoted(surface)}, {reason}; expected {instead}")


def _enter(probe: _Probe, depth: int, node: Node, step: str, where: str) -> None:
    """Refuse a step that does not lead into `where`, which stands at `node`."""
    model, refused = probe.model(depth), probe.refused[depth]
    if node.items:
        return
    is_value = node.text is not None or node.number is not None
    if model is None and not refused and not is_value:
        if step not in node.entries:  # names
            hint = nearest(step, node.entries) or "; nothing is written there"
            raise _NoPath(f"there is no {quoted(step)} in {where}{hint}")
        return
    is_mapping = model is not None or NO_KIND in refused
    is_list = "tuple_type" in refused or ("lavender" in refused and step.isdigit())  # or a vector
    if is_list and not is_mapping and not node:
        raise _NoPath(f"{where} is no list in this file; write it, then sweep {quoted(step)}")
    if not is_mapping:
        raise _NoPath(f"{where} is a single value, there is no {quoted(step)} in it")
    if node.text is not None and where != "numerics":
        raise _NoPath(f"{where} is {quoted(node.text)}, there is no {quoted(step)} in it")
    if node.number is not None:
        raise _NoPath(f"{where} is a number in this file; write it as a mapping to sweep {step}")
    if model is None:
        raise _NoPath(f"{where} has no known kind, so that nothing in it can be swept")
    valid = fields(model)
    if "extra_forbidden" in probe.refused[depth + 1]:
        raise _NoPath(f"there is no {quoted(step)} in {where or 'a config'}{nearest(step, valid)}")
    if where and not node and any(info.is_required() for info in valid.values()):
        raise _NoPath(f"{where} is not written in this file; write it, then sweep {quoted(step)}")


def _holding(node: Node, step: str | int, data: Any) -> Any:
    """Return what holds this data: a mapping with its kind, or the list with it in its place."""
    if isinstance(step, int):
        return tuple(data if k == step else item.data for k, item in enumerate(node.items))
    kind = node.get("kind")
    return {step: data} | ({"kind": kind.data} if kind else {})


def _depth(loc: tuple[str | int, ...], path: Path) -> int:
    """Return how many steps of the path an error is behind; pydantic's have tags of unions, too."""
    depth = 0
    for step in loc:
        depth += depth < len(path) and step == path[depth]
    return depth


def _index(node: Node, step: str, where: str) -> int:
    length = len(node.items)
    if not (step.isascii() and step.isdigit() and len(step) < 8 and int(step) < length):
        raise _NoPath(f"{where} has items 0 to {length - 1}, there is no {quoted(step)}")
    return int(step)
