"""The base of every model of a config: frozen, no unknown keys, no silent conversions."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict


class ConfigModel(BaseModel):
    """Sequences arrive as tuples, mappings as dicts, ratios as `scalars.Ratio` (a float)."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)
