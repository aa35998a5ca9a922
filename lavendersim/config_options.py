"""What a config is read with beside its text: options that make another experiment of it.

They stand by these keys in the index of a run and in the identity of a shard, so that both are read
again as they were run.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple


class ConfigOptions(NamedTuple):
    """Options of reading; those of a run are compared with those of another."""

    reduced: bool = False  # a slow one, at its reduced length
    solver: str | None = None  # of every cell, instead of what the config says
    overrides: tuple[str, ...] = ()  # values instead of the file's, see `sweeps.option_overrides`
    divisor: int = 1  # of every timestep

    @property
    def row(self) -> dict[str, Any]:
        """The options by their keys on disk."""
        return {
            "reduced": self.reduced,
            "solver": self.solver,
            "timestep_divisor": self.divisor,
            "overrides": list(self.overrides),
        }

    @classmethod
    def of_row(cls, row: Mapping[str, Any]) -> ConfigOptions:
        """Return the options of such a row; KeyError for one that is missing."""
        overrides = tuple(row["overrides"])
        return cls(row["reduced"], row["solver"], overrides, row["timestep_divisor"])
