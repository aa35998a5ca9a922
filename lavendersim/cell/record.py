"""What a cell logs: of which steps contacts and poses, residuals of sweeps, contact problems."""

from __future__ import annotations

import re
from functools import partial
from typing import Annotated, Any, Final, Literal

from pydantic import (
    Field,
    PlainValidator,
    SerializerFunctionWrapHandler,
    WithJsonSchema,
    model_serializer,
)

from lavendersim.quantities.model import ResolvedModel
from lavendersim.quantities.quantity import refusal

NONE: Final = "none"
ALL: Final = "all"
# Up to a billion, ten times the steps that a run may have.
_EVERY = re.compile(r"every ([1-9][0-9]{0,8})")


def _every(beside: str, value: object) -> str:
    """Return the text `every N`, or the one that stands beside it; or raise the refusal."""
    if isinstance(value, str) and (value == beside or _EVERY.fullmatch(value)):
        return value
    hint = ""
    if isinstance(value, int) and not isinstance(value, bool) and value > 0:
        hint = f'; did you mean "every {value}"?'
    elif value == ALL:
        hint = '; did you mean "every 1"?'
    expected = f"{beside} or every N with a whole number of steps N of 1 or more"
    raise refusal(expected, value, hint)


def _schema(beside: str) -> dict[str, Any]:
    return {"type": "string", "pattern": f"^({beside}|{_EVERY.pattern})$"}


EveryOrNone = Annotated[str, PlainValidator(partial(_every, NONE)), WithJsonSchema(_schema(NONE))]
EveryOrAll = Annotated[str, PlainValidator(partial(_every, ALL)), WithJsonSchema(_schema(ALL))]


def steps_between(every: str) -> int:
    """Return N of `every N`, 0 of `none` and of `all`."""
    found = _EVERY.fullmatch(every)
    return int(found[1]) if found else 0


class TimeWindow(ResolvedModel):
    """A stretch of simulated time [s]."""

    begin: float = Field(alias="from")
    end: float = Field(alias="to")


Recorded = str | TimeWindow  # all, every N, or a stretch of time


def in_words(recorded: Recorded) -> str:
    """Return of which steps something is recorded, as a config would say it."""
    if isinstance(recorded, TimeWindow):
        return f"from {recorded.begin:g} to {recorded.end:g} s"
    return recorded


class CellRecord(ResolvedModel):
    """What is logged: of which steps, and beyond state and contacts."""

    residuals: Literal["none", "all"] | TimeWindow
    problems: str  # none, or every N
    # logs of older versions have all of both, and do not say so
    contacts: Recorded = ALL
    poses: Recorded = ALL
    velocities: bool = False  # of the steps whose poses are recorded; absent where false

    @model_serializer(mode="wrap")
    def _written(self, serialize: SerializerFunctionWrapHandler) -> dict[str, Any]:
        written: dict[str, Any] = serialize(self)
        if not self.velocities:
            written.pop("velocities", None)
        return written
