"""What annotations of models say: keys, forms of a union, the model of a mapping by its kind."""

from __future__ import annotations

import types
from functools import cache
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from lavendersim.experiment.text.node import Node, Path

Model = type[BaseModel]


def field_name(model: Model, name: str) -> str:
    """Return the key under which a field stands in a file."""
    return model.model_fields[name].alias or name


@cache
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


def literals(annotation: Any) -> tuple[Any, ...]:
    """Return the values of a Literal; nothing of any other type."""
    return get_args(annotation) if get_origin(annotation) is Literal else ()


def kinds(model: Model) -> tuple[str, ...]:
    """Return the values of `kind` that choose this model."""
    info = model.model_fields.get("kind")
    return literals(info.annotation) if info is not None else ()


def below(annotation: Any, path: Path) -> Any:
    """Return the type of what stands at a path through mappings of names and lists."""
    for _ in path:
        containers = [m for m, _ in alternatives(annotation) if get_origin(m) in (dict, tuple)]
        if not containers:
            return None
        arguments = get_args(containers[0])
        annotation = arguments[1] if get_origin(containers[0]) is dict else arguments[0]
    return annotation
