"""The tables of docs/config.md, written from the models: keys, defaults, meaning with unit.

A table stands between two comments; the first names its models, and what stands between is
replaced. Whatever an effect declares as a key of a config is a field of a model, and so in a table.

    <!-- keys: Scene -->          key | default | meaning, one row a field
    <!-- kinds: Tower Grid -->    the same for models that a `kind` chooses
    <!-- presets: Numerics -->    key | one column a preset | meaning
    <!-- end -->
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from markdown_tables import escaped, markdown
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from lavendersim.cell.numerics import Numerics
from lavendersim.engine.effects import SCENE_KEYS
from lavendersim.experiment.checks.messages import fields
from lavendersim.experiment.models.experiment import ExperimentConfig
from lavendersim.experiment.resolve.presets import PRESETS
from lavendersim.quantities.chosen_kind import kinds
from lavendersim.quantities.scalars import label

# Keys that effects declare; their own keys follow in the same table.
_OF_EFFECTS = frozenset(key.name for key in SCENE_KEYS)
_TABLE = re.compile(r"(<!-- (keys|kinds|presets): ([\w ]+) -->\n).*?(<!-- end -->)", re.DOTALL)


def with_key_tables(text: str) -> str:
    """Return a page with every table written anew."""
    models = {model.__name__: model for model in models_below(ExperimentConfig)}
    models["Numerics"] = Numerics
    tables: dict[str, Callable[..., Iterator[Sequence[str]]]] = {
        "keys": keys_table,
        "kinds": kinds_table,
        "presets": presets_table,
    }

    def table(found: re.Match[str]) -> str:
        head, form, names, end = found.groups()
        heads, *rows = tables[form](*(models[name] for name in names.split()))
        return f"{head}\n{markdown(heads, rows)}\n\n{end}"

    return _TABLE.sub(table, text)


def alternatives(annotation: Any) -> list[Any]:
    """Return the members of a union, or the type alone, without their metadata."""
    while get_origin(annotation) is Annotated:
        annotation = get_args(annotation)[0]
    if get_origin(annotation) in (Union, UnionType):
        return [one for member in get_args(annotation) for one in alternatives(member)]
    return [annotation]


def models_of(annotation: Any) -> list[type[BaseModel]]:
    """Return the models among the members of a union."""
    return [
        member
        for member in alternatives(annotation)
        if isinstance(member, type) and issubclass(member, BaseModel)
    ]


def models_below(annotation: Any) -> list[type[BaseModel]]:
    """Return every model that a config of this type may hold, each once."""
    found: dict[type[BaseModel], None] = {}
    for member in alternatives(annotation):
        parts = get_args(member)
        if models_of(member):
            found[member] = None
            parts = tuple(info.annotation for info in member.model_fields.values())
        for part in parts:
            found |= dict.fromkeys(models_below(part))
    return list(found)


def keys_table(*models: type[BaseModel]) -> Iterator[list[str]]:
    """Yield the rows of a table of the models' keys."""
    yield ["key", "default", "meaning"]
    for model in models:
        for key, info in fields(model).items():
            yield [f"`{key}`", _default(info), _meaning(info)]
            if key in _OF_EFFECTS:
                for inner in models_below(info.annotation):
                    for name, one in fields(inner).items():
                        yield [f"`{key}[].{name}`", _default(one), _meaning(one)]


def kinds_table(*models: type[BaseModel]) -> Iterator[list[str]]:
    """Yield the rows of a table of kinds, and below each one those of its keys."""
    yield ["`kind`", "key", "default", "meaning"]
    for model in models:
        doc = " ".join((model.__doc__ or "").split())
        yield [f"`{kinds(model)[0]}`", "", "", escaped(doc)]
        for key, info in fields(model).items():
            if key != "kind":
                yield ["", f"`{key}`", _default(info), _meaning(info)]


def presets_table(model: type[BaseModel]) -> Iterator[list[str]]:
    """Yield the rows of a table of the model's keys with the numbers of every preset."""
    yield ["key", *(f"`{name}`" for name in PRESETS), "meaning"]
    for key, info in fields(model).items():
        numbers = [_value(getattr(preset, key)) for preset in PRESETS.values()]
        yield [f"`{key}`", *numbers, _meaning(info)]


def _default(info: FieldInfo) -> str:
    if info.is_required():
        return "required"
    value = info.get_default(call_default_factory=True, validated_data={})
    if isinstance(value, BaseModel):
        return "its defaults"
    if value is None or (isinstance(value, str | tuple | dict) and not value):
        return "none"
    return f"`{value}`" if isinstance(value, str) else _value(value)


def _value(value: object) -> str:
    """Return a value as a config writes it, without a needless zero: 1e-6."""
    if isinstance(value, tuple) and all(isinstance(item, Fraction | int | float) for item in value):
        return f"[{', '.join(_value(item) for item in value)}]"
    return re.sub(r"e([-+])0", r"e\1", label(value))


def _meaning(info: FieldInfo) -> str:
    return escaped(info.description or "")
