"""The resolved config of one cell: what is simulated, hashed and logged, with nothing left open.

Surfaces stand in place, arrangements have become bodies, density has become mass, a release has
become a position, the preset has become numbers.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from typing import Any

from lavendersim.cell.choices import Mistake, Switch
from lavendersim.cell.engine import CellEngine
from lavendersim.cell.events import AnyEvent, CellTimestep
from lavendersim.cell.numerics import Numerics
from lavendersim.cell.record import CellRecord
from lavendersim.cell.scene import CellScene
from lavendersim.cell.triggers import CellTriggeredEvent
from lavendersim.clock import Clock
from lavendersim.quantities.model import ResolvedModel
from lavendersim.quantities.scalars import exact

# Numerator and denominator: to hash a Fraction takes longer than what is looked up.
Ratio = tuple[int, int]


@lru_cache(maxsize=256)  # it never changes, and the cells of most sweeps have one
def _clock(timestep: Ratio, changes: tuple[tuple[Fraction, Fraction], ...]) -> Clock:
    return Clock(Fraction(*timestep), changes)


@lru_cache(maxsize=256)
def _steps(timestep: Ratio, changes: tuple[tuple[Fraction, Fraction], ...], duration: float) -> int:
    return _clock(timestep, changes).steps_of(exact(duration))


class CellEffects(ResolvedModel):
    """What the plan is overridden by."""

    force: bool  # what is off is left out even where the scene requires it
    switches: dict[str, Switch]  # by the name of an effect or a shape pair, sorted


class CellStudy(ResolvedModel):
    """The deliberate error of the run, if any."""

    mistake: Mistake


class CellConfig(ResolvedModel):
    """One cell of an experiment, complete."""

    scene: CellScene
    events: tuple[AnyEvent, ...]
    numerics: Numerics
    duration: float  # [s]
    record: CellRecord
    effects: CellEffects
    study: CellStudy
    # Both are absent from the data of cells that have none, as in older logs.
    engine: CellEngine | None = None  # None: lavender's
    triggered: tuple[CellTriggeredEvent, ...] = ()

    @property
    def planned_events(self) -> tuple[AnyEvent, ...]:
        """Every event that may happen; the times of those with a trigger say nothing."""
        return (*self.events, *(one.event for one in self.triggered))

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> CellConfig:
        """Return the config that `as_dict` gave this data, such as a log's attachment."""
        return cls.model_validate_json(json.dumps(data))  # JSON's mode reads `1/480` and lists

    def as_dict(self) -> dict[str, Any]:
        """Return plain JSON-able data: ratios as `1/480`, vectors as lists."""
        return self.model_dump(mode="json", by_alias=True, exclude=self._absent)

    def as_json(self) -> str:
        """Return the text of `as_dict`, in one line."""
        return self.model_dump_json(by_alias=True, exclude=self._absent)

    @property
    def _absent(self) -> set[str] | None:
        """What its data does without."""
        return {name for name in ("engine", "triggered") if not getattr(self, name)} or None

    def refined(self, divisor: int) -> CellConfig:
        """Return the same cell at timesteps of 1/divisor, those of events included.

        One whose steps are as long as its accuracy allows: at the accuracy such substeps have.
        """
        if self.numerics.accuracy is not None:
            accuracy = self.numerics.accuracy / divisor**2
            numerics = self.numerics.model_copy(update={"accuracy": accuracy})
            return self.model_copy(update={"numerics": numerics})
        numerics = self.numerics.model_copy(update={"timestep": self.numerics.timestep / divisor})
        events = tuple(
            event.model_copy(update={"timestep": event.timestep / divisor})
            if isinstance(event, CellTimestep)
            else event
            for event in self.events
        )
        return self.model_copy(update={"numerics": numerics, "events": events})

    @property
    def clock(self) -> Clock:
        """The times of its steps."""
        return _clock(self.numerics.timestep.as_integer_ratio(), self._timed)

    @property
    def steps(self) -> int:
        """How many steps the duration has, see `Clock.steps_of`."""
        timestep = self.numerics.timestep.as_integer_ratio()
        return _steps(timestep, self._timed, self.duration)

    @property
    def _timed(self) -> tuple[tuple[Fraction, Fraction], ...]:
        changes = [one for one in self.events if isinstance(one, CellTimestep)]
        return tuple((exact(one.at), one.timestep) for one in changes)
