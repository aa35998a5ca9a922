"""What effects cost, as a run keeps it (`overheads` of `results.json`): a row an effect."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from lavendersim.measures.spread import Spread
from lavendersim.measures.typed_tables import plain, read_as


@dataclass(frozen=True)
class OverheadTiming:
    """Two engines, without an effect and with it, over the same steps.

    Spreads are in ns per unit and step, samples in ns per step.
    """

    same_motion: bool
    contacts_off: float  # a step
    contacts_on: float
    compile_s_off: float  # [s]
    compile_s_on: float
    off: Spread
    on: Spread
    overhead: Spread  # of the differences, sample by sample
    within_noise: bool
    samples_off: list[float]
    samples_on: list[float]


@dataclass(frozen=True)
class OverheadRow:
    """One effect in one scene."""

    effect: str
    required: bool  # by the scene
    reason: str
    unit: str  # body or contact
    units: float  # a step
    on_top_of: list[str]  # effects that both engines have, for its sake
    why_not: str  # there are no two engines; "" where there are
    timing: OverheadTiming | None  # None: see `why_not`


@dataclass(frozen=True)
class OverheadTable:
    """What each effect costs in a scene."""

    first_step: int  # that is timed
    steps: int
    repeats: int
    clock: str  # what times were taken with
    processor: str
    bodies: int  # movable
    contacts_per_step: float
    rows: list[OverheadRow]
    interrupted: str = ""  # what ended the repeats before their time
    only_required: bool = False  # effects that the scene does not require are left out

    @classmethod
    def of(cls, data: dict[str, Any]) -> OverheadTable:
        """Return a table that was read. ValueError where something in it is missing or wrong."""
        rows = [{**row, "timing": None if row.get("why_not") else row} for row in data["rows"]]
        return read_as(cls, {**data, "rows": rows})

    def as_data(self) -> dict[str, Any]:
        """Return the table as it is written: numbers of a timing beside those of its row."""
        rows = [{**row, **(row.pop("timing") or {})} for row in map(plain, self.rows)]
        return {**plain(self), "rows": rows}
