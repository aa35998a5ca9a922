"""What a measure, a check or a panel reads of every step of a log, beside the sums of `/step`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

from lavendersim.quantities.model import ConfigModel

Readings = frozenset[str]  # keys of the section `record`
CONTACTS: Final = frozenset({"contacts"})
POSES: Final = frozenset({"poses"})
VELOCITIES: Final = frozenset({"poses", "velocities"})  # those of the steps whose poses are
SUMS: Final[Readings] = frozenset()  # what `/step` has, which every log has of every step
EVERYTHING: Final = CONTACTS | POSES


class Reader(ConfigModel):
    """A measure or a panel of a config."""

    # What it takes of every step of a log; of a kind that does not say, anything.
    READS: ClassVar[Readings] = EVERYTHING

    @classmethod
    def reads(cls, given: Mapping[str, str | None]) -> Readings:
        """Return what it takes of every step; given: the keys of a config, with their texts."""
        return cls.READS
