"""A model's annotations and a tree of nodes in; every node with what the model says about it out.

pydantic checks values but does not tell, for a place in the file, which keys are valid there or
that a text is the name of a body. This walk does, for any model, from the annotations alone.
"""

from __future__ import annotations

import types
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from lavendersim.experiment.text.node import Mark, Node, Path, key_mark
from lavendersim.quantities.names import Refers

Model = type[BaseModel]


@dataclass(frozen=True)
class Place:
    """One node (or one key of a mapping) and what the model says about it."""

    path: Path
    node: Node
    mark: Mark
    model: Model | None = None  # the node is a mapping with the fields of this model
    refers: Refers | None = None  # its text is the name of such a thing
    axis: str | None = None  # it is one value, of this axis of the sweep
    kinds: tuple[str, ...] = ()  # its `kind` is none of these


def field_name(model: Model, name: str) -> str:
    """Return the key under which a field stands in a file."""
    return model.model_fields[name].alias or name


def fields(model: Model) -> dict[str, FieldInfo]:
    """Return the fields of a model by the keys under which they stand in a file."""
    return {field_name(model, name): info for name, info in model.model_fields.items()}


def names_of(model: Model) -> Any:
    """Return the type of what stands under keys that are names; None where keys are fields only."""
    if model.model_config.get("extra") != "allow":
        return None
    return get_args(get_type_hints(model)["__pydantic_extra__"])[1]


def annotation_of(info: FieldInfo) -> Any:
    """Return the field's type with the metadata that pydantic split off."""
    annotation: Any = info.annotation
    for item in info.metadata:
        annotation = Annotated[annotation, item]
    return annotation


def alternatives(annotation: Any) -> list[tuple[Any, tuple[Any, ...]]]:
    """Return the members of a union (or the type alone), each with its metadata."""
    metadata: tuple[Any, ...] = ()
    while get_origin(annotation) is Annotated:
        annotation, *more = get_args(annotation)
        metadata = (*more, *metadata)
    if isinstance(annotation, types.UnionType) or get_origin(annotation) is Union:
        inner = [pair for member in get_args(annotation) for pair in alternatives(member)]
        return [(member, (*metadata, *own)) for member, own in inner]
    return [(annotation, metadata)]


def is_model(annotation: Any) -> bool:
    """Tell whether the type is a pydantic model."""
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def model_for(annotation: Any, node: Node | None) -> Model | None:
    """Return the model that a mapping at this place follows: by its `kind`, or the only one."""
    models = [member for member, _ in alternatives(annotation) if is_model(member)]
    if len(models) > 1 and node is not None:
        kind = node.get("kind")
        text = kind.text if kind is not None else None
        models = [model for model in models if text in kinds(model)]
    return models[0] if len(models) == 1 else None


def _literals(annotation: Any) -> tuple[Any, ...]:
    return get_args(annotation) if get_origin(annotation) is Literal else ()


def kinds(model: Model) -> tuple[str, ...]:
    """Return the values of `kind` that choose this model."""
    info = model.model_fields.get("kind")
    return _literals(info.annotation) if info is not None else ()


def places(annotation: Any, node: Node, path: Path = ()) -> Iterator[Place]:
    """Yield every node below `node` that the annotation says something about, in file order."""
    if node.text is not None:
        members = alternatives(annotation)
        if any(node.text in _literals(member) for member, _ in members):
            return
        for _, metadata in members:
            refers = next((item for item in metadata if isinstance(item, Refers)), None)
            if refers is not None:
                yield Place(path, node, node.mark, refers=refers)
    elif isinstance(node.content, tuple):
        yield from _items(annotation, node, path)
    elif isinstance(node.content, dict):
        model = model_for(annotation, node)
        if model is not None:
            yield Place(path, node, node.mark, model=model)
            for key, info in fields(model).items():
                if (child := node.get(key)) is not None:
                    yield from places(annotation_of(info), child, (*path, key))
        else:
            models = [member for member, _ in alternatives(annotation) if is_model(member)]
            if valid := tuple(kind for one in models for kind in kinds(one)):
                yield Place(path, node, node.mark, kinds=valid)
            yield from _entries(annotation, node, path)


def _items(annotation: Any, node: Node, path: Path) -> Iterator[Place]:
    for member, _ in alternatives(annotation):
        if get_origin(member) in (tuple, list):
            arguments = get_args(member)
            repeated = len(arguments) == 1 or Ellipsis in arguments
            for index, item in enumerate(node.items):
                if repeated or index < len(arguments):
                    inner = arguments[0] if repeated else arguments[index]
                    yield from places(inner, item, (*path, index))


def _entries(annotation: Any, node: Node, path: Path) -> Iterator[Place]:
    for member, _ in alternatives(annotation):
        if get_origin(member) is not dict:
            continue
        key_type, value_type = get_args(member)
        for _, metadata in alternatives(key_type):
            for refers in (item for item in metadata if isinstance(item, Refers)):
                for key, child in node.entries.items():
                    mark = key_mark(node, key)
                    key_node = Node(key, mark)
                    yield Place((*path, key), key_node, mark, refers=refers)
                    if refers.to == "axis":
                        yield from _axis_values(child, key, (*path, key))
        for key, child in node.entries.items():
            yield from places(value_type, child, (*path, key))


def _axis_values(node: Node, axis: str, path: Path) -> Iterator[Place]:
    for item in node.items or (node,):
        if not isinstance(item.content, dict):
            yield Place(path, item, item.mark, axis=axis)
