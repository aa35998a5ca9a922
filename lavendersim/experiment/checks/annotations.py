"""What annotations of models say: keys, forms of a union, the model of a mapping by its kind."""

from __future__ import annotations

import types
from functools import cache
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from lavendersim.experiment.text.node import Node

Model = type[BaseModel]


@cache
def fields(model: Model) -> dict[str, FieldInfo]:
    """Return the fields of a model by the keys under which they stand in a file."""
    return {info.alias or name: info for name, info in model.model_fields.items()}


def names_of(model: Model) -> Any:
    """Return the type of what stands under keys that are names; None where keys are fields only."""
    if model.model_config.get("extra") != "allow":
        return None
    return get_args(get_type_hints(model)["__pydantic_extra__"])[1]


def alternatives(annotation: Any) -> list[Any]:
    """Return the members of a union, or the type alone, without their metadata."""
    while get_origin(annotation) is Annotated:
        annotation = get_args(annotation)[0]
    if isinstance(annotation, types.UnionType) or get_origin(annotation) is Union:
        return [one for member in get_args(annotation) for one in alternatives(member)]
    return [annotation]


def is_model(annotation: Any) -> bool:
    """Tell whether the type is a pydantic model."""
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def models_of(annotation: Any) -> list[Model]:
    """Return the models among the members of a union."""
    return [member for member in alternatives(annotation) if is_model(member)]


def model_for(annotation: Any, node: Node) -> Model | None:
    """Return the model that a mapping at this place follows: by its `kind`, or the only one."""
    models = models_of(annotation)
    if len(models) > 1:
        models = [model for model in models if node.get("kind").text in kinds(model)]
    return models[0] if len(models) == 1 else None


def literals(annotation: Any) -> tuple[Any, ...]:
    """Return the values of a Literal; nothing of any other type."""
    return get_args(annotation) if get_origin(annotation) is Literal else ()


def kinds(model: Model) -> tuple[str, ...]:
    """Return the values of `kind` that choose this model."""
    info = model.model_fields.get("kind")
    return literals(info.annotation) if info is not None else ()


def inside(annotation: Any, container: type) -> Any:
    """Return the type of the values of a dict, or of the items of a tuple; None where it is none.

    annotation: of the container, or a union with it.
    """
    for member in alternatives(annotation):
        if get_origin(member) is container:
            return get_args(member)[container is dict]
    return None


def is_vector(annotation: Any) -> bool:
    """Tell whether the type is a tuple of fixed length."""
    return get_origin(annotation) is tuple and Ellipsis not in get_args(annotation)
