"""From pydantic's errors to sentences at the places of the file.

Every sentence says what was found, what is expected, and the nearest valid name. An unknown key is
reported at the key, a bad value at the value, a missing key at the mapping that lacks it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from lavendersim.experiment.text.node import BROKEN, Broken, Mark, Node, Path, key_mark
from lavendersim.experiment.text.place import missing_key, name_of, place_of
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.chosen_kind import NO_KIND
from lavendersim.quantities.found import MEANT, found, near, nearest, quoted
from lavendersim.quantities.model import ConfigModel

Model = type[BaseModel]

# What pydantic expects, by the type of its error; in braces from the error's context.
_EXPECTED = {
    "form": "{expected}",
    "string_type": "text",
    "string_too_short": "text",
    "bool_type": "true or false",
    "dict_type": "a mapping",
    "model_type": "a mapping",
    NO_KIND: "a mapping",
    "tuple_type": "a list",
    "too_short": "{min_length} item{s} or more",
    "too_long": "{max_length} item{s} or fewer",
}
_QUOTED = re.compile("'([^']*)'")  # pydantic has a Literal's texts so, in one text
_SWITCHED = ["on", "off"]  # plain texts in YAML 1.2
_SWITCHES = {"yes": "true", "on": "true", "no": "false", "off": "false"}


@cache
def fields(model: Model) -> dict[str, FieldInfo]:
    """Return the fields of a model by the keys under which they stand in a file."""
    return {info.alias or name: info for name, info in model.model_fields.items()}


def report_errors(
    error: ValidationError, root: Node, models: Mapping[Path, Model], report: Report
) -> None:
    """Note every error of a validation of `root`; models: what each of its mappings was read as."""
    errors = error.errors(include_url=False)
    replaced = _replaced_keys(errors, root, models)
    judged: set[Path] = set()  # a value that fits no form of a union has one error per form
    # Mappings that were read as a model and found wrong inside: another form, such as a number in
    # place of the mapping, was not meant.
    wrong_inside = {
        path[:end]
        for path in (_place_of(item, root) for item in errors)
        for end in range(1, len(path))
    }
    for item in errors:
        path, node = locate(root, item["loc"])
        if item["type"] not in ("missing", "extra_forbidden"):
            if path in judged:
                continue
            judged.add(path)
        if isinstance(node.content, Broken) or item.get("input") is BROKEN:
            continue
        if path in wrong_inside and _refuses_a_mapping(item):
            continue
        if item["type"] == "missing" and (node.incomplete or (path, item["loc"][-1]) in replaced):
            continue
        if item["type"] == "too_short" and len(node.items) >= item["ctx"]["min_length"]:
            continue  # pydantic does not count the items that it refused
        mark, sentence = _sentence(item, path, node, root, models)
        report.add(mark, sentence)


def _refuses_a_mapping(item: ErrorDetails) -> bool:
    sentence = str(item.get("ctx", {}).get("sentence", ""))
    return item["type"] in _EXPECTED or sentence.endswith(found({}))


def _place_of(item: ErrorDetails, root: Node) -> Path:
    """Return the path of an error; of a missing key, as if it were there."""
    path, _ = locate(root, item["loc"])
    return (*path, item["loc"][-1]) if item["type"] == "missing" else path


def locate(root: Node, loc: tuple[str | int, ...]) -> tuple[Path, Node]:
    """Return the deepest node on the way of a location; pydantic's have union tags, no keys."""
    path: list[str | int] = []
    node = root
    for step in loc:
        if child := node.get(step):
            path.append(step)
            node = child
    return tuple(path), node


def _replaced_keys(
    errors: list[ErrorDetails], root: Node, models: Mapping[Path, Model]
) -> set[tuple[Path, str | int]]:
    """Return the missing keys that are there, but misspelt: the unknown key says it all."""
    missing = {locate(root, item["loc"])[0] for item in errors if item["type"] == "missing"}
    replaced: set[tuple[Path, str | int]] = set()
    for item in errors:
        if item["type"] == "extra_forbidden":
            path = locate(root, item["loc"])[0][:-1]
            if path in missing:
                replaced.add((path, near(item["loc"][-1], _keys_at(models, path)) or ""))
    return replaced


def _sentence(
    item: ErrorDetails, path: Path, node: Node, root: Node, models: Mapping[Path, Model]
) -> tuple[Mark, str]:
    kind, context, step = item["type"], item.get("ctx", {}), item["loc"][-1]
    name, holder = name_of(path), path[:-1]
    if kind == "extra_forbidden" or step == "[key]":
        mark = key_mark(root.get(*holder) or root, str(path[-1]))
        if kind == "extra_forbidden":
            elsewhere = getattr(models.get(holder), "MISPLACED", {})
            misplaced = elsewhere.get(step) or elsewhere.get(MEANT.get(str(step), ""))
            hint = f"; {misplaced}" if misplaced else nearest(step, _keys_at(models, holder))
            return mark, f"unknown key {quoted(step)} in {place_of(holder)}{hint}"
        if kind == "lavender":
            return mark, f"{name_of(holder)}: {context['sentence']}"
        signs = '"_"' if holder == ("constants",) else '"_" and "-"'
        rule = f"use up to 64 letters, digits, {signs}, starting with a letter"
        return mark, f"{quoted(path[-1])} cannot be a name; {rule}"
    if kind == "missing":
        if isinstance(step, int):
            return node.mark, f"{name}: expected at least {step + 1} items, {_count(node)}"
        info = _keys_at(models, path).get(step)
        return node.mark, missing_key(str(step), path, info.description if info else None)
    if kind == NO_KIND and isinstance(node.content, dict):
        tag, valid = node.get("kind"), context["kinds"]
        if not tag:
            return node.mark, missing_key("kind", path, f"one of {valid}")
        if tag.text is None:
            return tag.mark, f"kind: expected one of {valid}, found {found(tag.data)}"
        hint = nearest(tag.text, valid.split(", "))
        return tag.mark, f"unknown kind {quoted(tag.text)} in {place_of(path)}{hint}"
    if kind == "lavender":
        return node.mark, f"{name}: {context['sentence']}"
    if kind == "literal_error":
        return node.mark, f"{name}: {_choice(context['expected'], item['input'])}"
    form = _form(context["class_name"]) if kind == "model_type" else ""
    if kind == NO_KIND and node.text and (meant := near(node.text, context["kinds"].split(", "))):
        form = f"; write {{kind: {meant}, ...}}"  # the kind in place of what is of this kind
    return node.mark, f"{name}: {_expected(item, node)}{form}"


def _form(model: str) -> str:
    """Return the mapping that a model is of as it is written: with what it requires, or most do."""
    classes = [ConfigModel]
    for one in classes:  # which grows meanwhile
        classes += one.__subclasses__()
    for meant in [one for one in classes if one.__name__ == model][:1]:
        required = [f"{key}: ..." for key, at in fields(meant).items() if at.is_required()]
        if form := meant.FORM or ", ".join(required):
            return f"; write {{{form}}}"
    return ""


def _choice(listed: str, value: Any) -> str:
    valid = _QUOTED.findall(listed)
    close = near(value, valid) if isinstance(value, str) else None
    hint = f'; did you mean "{close}"?' if close else ""
    if isinstance(value, bool) and valid == _SWITCHED:
        hint = f"; write {_SWITCHED[not value]}"
    return f"expected {' or '.join(valid)}, found {found(value)}{hint}"


def _expected(item: ErrorDetails, node: Node) -> str:
    kind, context, value = item["type"], item.get("ctx", {}), item["input"]
    if kind not in _EXPECTED:
        return f"{item['msg']}, found {found(value)}"  # of a type that a plug-in brings
    plural = "" if 1 in (context.get("min_length"), context.get("max_length")) else "s"
    expected = f"expected {_EXPECTED[kind].format(**context, s=plural)}"
    if kind in ("too_short", "too_long"):
        return f"{expected}, {_count(node)}"
    if kind == "string_too_short":
        return f"{expected}, found an empty one"
    sentence = f"{expected}, found {found(value)}"
    if kind == "string_type" and isinstance(value, int | float):
        return f"{sentence}; put it in quotes"
    if kind == "tuple_type" and isinstance(value, dict):
        return f"{sentence}; its items are written behind dashes, - ..."
    if kind == "dict_type" and isinstance(value, list | tuple):
        return f"{sentence}; each has its name in front, NAME: ..."
    if kind == "bool_type" and isinstance(value, str) and value.lower() in _SWITCHES:
        return f"{sentence}; write {_SWITCHES[value.lower()]}"
    return sentence


def _keys_at(models: Mapping[Path, Model], path: Path) -> dict[str, FieldInfo]:
    return fields(models[path]) if path in models else {}


def _count(node: Node) -> str:
    return f"found {len(node.items)}" if node.items else "found none"
