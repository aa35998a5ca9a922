"""The bases of every model of a config: frozen, no unknown keys; as written, or resolved."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any, ClassVar, Protocol, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationInfo, create_model, model_validator


class ConfigModel(BaseModel):
    """A part of a config as written: no silent conversions.

    Sequences arrive as tuples, mappings as dicts, ratios as `scalars.Ratio` (a float). A file is
    validated with a context (`experiment.checks.reading`) that knows where each mapping stands; it
    learns which model reads it, and applies the model's rules there.
    """

    # Validators are made when first used: of a file's many possible models few are.
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, defer_build=True)

    # Keys that people write here and that stand elsewhere: what to write, for the message.
    MISPLACED: ClassVar[Mapping[str, str]] = {}
    # What stands in such a mapping, for who wrote none; none: the keys that it requires.
    FORM: ClassVar[str] = ""

    @model_validator(mode="before")
    @classmethod
    def _enter(cls, data: Any, info: ValidationInfo) -> Any:
        if info.context is not None:
            info.context.enter(cls, data)
        return data

    @classmethod
    def rules(cls, at: Any) -> None:
        """Refuse what is wrong between values; at: the mapping in its file (`text.place.Place`).

        Called before the values themselves are checked, so that a defect of one hides none of
        another: a rule says nothing about values of a wrong type, those are refused elsewhere.
        """


class ResolvedModel(BaseModel):
    """A part of a resolved config."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    @classmethod
    def of(cls, **values: Any) -> Self:
        """Return a model of values that are right, which nothing checks: one for every field.

        Which fields were given is the same for all of them, and kept once.
        """
        fields, given = _fields_of(cls)
        if len(values) != len(fields):
            raise TypeError(f"{cls.__name__} has {fields}, not {[*values]}")
        # As `model_construct` leaves it, which takes four times as long.
        made = cls.__new__(cls)
        state = {
            "__dict__": {name: values[name] for name in fields},
            "__pydantic_fields_set__": given,
            "__pydantic_extra__": None,
            "__pydantic_private__": None,
        }
        made.__setstate__(state)
        return made


@cache
def _fields_of(model: type[BaseModel]) -> tuple[tuple[str, ...], set[str]]:
    """Return the fields of a model in their order, and as a set."""
    fields = tuple(model.model_fields)
    return fields, set(fields)


class DeclaredKey(Protocol):
    """A key of a config that an effect declares."""

    @property
    def name(self) -> str:
        """Name of the key."""

    @property
    def type(self) -> Any:
        """Its type, annotated with its quantity."""

    @property
    def default(self) -> Any:
        """Its value where a file does not specify it."""

    @property
    def doc(self) -> str:
        """Unit and meaning."""


def declared(name: str, base: type[BaseModel], keys: Iterable[DeclaredKey]) -> Any:
    """Return a model with the keys that effects declare, behind those that its base has.

    Its fields are known when it is made.
    """
    fields: dict[str, Any] = {
        key.name: (key.type, Field(default=key.default, description=key.doc))
        for key in keys
        if key.name not in base.model_fields
    }
    return create_model(name, __base__=base, **fields)
