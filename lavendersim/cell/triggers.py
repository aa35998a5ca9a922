"""Triggers of a cell: states that make an event happen, once, after the first step that ends so."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any, Final, Literal, get_args

from lavendersim.cell.events import AnyEvent, CellEvent, CellGravity
from lavendersim.clock import Clock
from lavendersim.quantities.model import ResolvedModel
from lavendersim.quantities.quantity import Vector3
from lavendersim.quantities.scalars import exact

Condition = Literal["touches", "leaves", "faster_than", "slower_than", "above", "below"]
CONDITIONS: Final[tuple[Condition, ...]] = get_args(Condition)
OF_CONTACT: Final = ("touches", "leaves")
OF_PLACE: Final = ("above", "below")
MOST_TRIGGERS: Final = 63  # bits of the column that says which of them a step met


class CellTrigger(ResolvedModel):
    """A state that bodies come to: see `engine.effects.triggers`."""

    condition: Condition
    bodies: tuple[str, ...]  # two of a contact, else one
    along: Vector3 | None = None  # unit vector, of a place
    value: float | None = None  # [m/s] of a speed, [m] of a place

    @property
    def text(self) -> str:
        """The state in words."""
        body, condition = self.bodies[0], self.condition
        if condition in OF_CONTACT:
            return f"{body} {condition} {self.bodies[1]}"
        if self.along is None:
            return f"{body} is {condition.replace('_', ' ')} {self.value:g} m/s"
        along = ", ".join(f"{part:.3g}" for part in self.along)
        return f"{body} is {condition} {self.value:g} m along [{along}]"


class CellTriggeredEvent(ResolvedModel):
    """An event that a trigger makes happen; its own time says nothing."""

    when: CellTrigger
    event: CellEvent | CellGravity


def met_after(steps: Iterable[Any]) -> dict[int, int]:
    """Return how many steps were done when the states of triggers were met, by their index.

    steps: rows of the steps of a run, in parts.
    """
    found: dict[int, int] = {}
    for rows in steps:
        if "triggered" not in rows.dtype.names:  # its plan was overridden: nothing was looked for
            continue
        for row in rows[rows["triggered"] != 0]:
            bits = int(row["triggered"])
            found |= {k: int(row["step"]) for k in range(MOST_TRIGGERS) if bits >> k & 1}
    return found


def happened(
    timed: Iterable[AnyEvent],
    triggered: Iterable[CellTriggeredEvent],
    met_after: Mapping[int, int],
    clock: Clock,
) -> tuple[AnyEvent, ...]:
    """Return the events of a run at their times, those of triggers as they happened.

    met_after: how many steps were done when the state of a trigger was met, by its index. What
    would happen to a body that is removed already is left out.
    """
    events = [*timed]
    for index, one in enumerate(triggered):
        if index in met_after:
            at = _begin_of_step(met_after[index], clock)
            events.append(one.event.model_copy(update={"at": at}))
    removed: dict[str, float] = {}
    for event in events:
        if isinstance(event, CellEvent) and event.remove:
            removed[event.body] = min(event.at, removed.get(event.body, math.inf))
    return tuple(event for event in events if not _too_late(event, removed))


def _begin_of_step(done: int, clock: Clock) -> float:
    """Return a time [s] that comes to act after so many steps: that of the state, as a double."""
    at = float(clock.time(done))
    return at if clock.steps_until(exact(at)) <= done else math.nextafter(at, 0.0)


def _too_late(event: Any, removed: Mapping[str, float]) -> bool:
    if not isinstance(event, CellEvent) or event.body not in removed:
        return False
    return event.at > removed[event.body]
