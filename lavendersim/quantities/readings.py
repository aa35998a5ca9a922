"""What a measure, a check or a panel reads of every step of a log, beside the sums of `/step`."""

from __future__ import annotations

from typing import Final

Readings = frozenset[str]  # keys of the section `record`
CONTACTS: Final = frozenset({"contacts"})
POSES: Final = frozenset({"poses"})
SUMS: Final[Readings] = frozenset()  # what `/step` has, which every log has of every step
EVERYTHING: Final = CONTACTS | POSES
