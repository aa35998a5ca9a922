"""The bases of every model of a config: frozen, no unknown keys; as written, or resolved."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict


class ConfigModel(BaseModel):
    """A part of a config as written: no silent conversions.

    Sequences arrive as tuples, mappings as dicts, ratios as `scalars.Ratio` (a float).
    """

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class ResolvedModel(BaseModel):
    """A part of a resolved config."""

    model_config = ConfigDict(frozen=True, extra="forbid")
