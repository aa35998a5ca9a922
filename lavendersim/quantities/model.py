"""The bases of every model of a config: frozen, no unknown keys; as written, or resolved."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol

from pydantic import BaseModel, ConfigDict, Field, create_model


class ConfigModel(BaseModel):
    """A part of a config as written: no silent conversions.

    Sequences arrive as tuples, mappings as dicts, ratios as `scalars.Ratio` (a float).
    """

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class ResolvedModel(BaseModel):
    """A part of a resolved config."""

    model_config = ConfigDict(frozen=True, extra="forbid")


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
    """Return a model with the keys that effects declare; its fields are known when it is made."""
    fields: dict[str, Any] = {
        key.name: (key.type, Field(default=key.default, description=key.doc)) for key in keys
    }
    return create_model(name, __base__=base, **fields)
