"""What a cell logs beyond state and contacts: residuals of sweeps, contact problems."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Literal

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from lavendersim.quantities.model import ResolvedModel
from lavendersim.quantities.quantity import refusal

NONE = "none"
# Up to a billion, ten times the steps that a run may have.
_EVERY = re.compile(r"every ([1-9][0-9]{0,8})")


@dataclass(frozen=True)
class EverySteps:
    """The text `none`, or `every N`: steps N, 2 N, ... of a run."""

    def check(self, value: object) -> str:
        """Return the text, or raise the refusal."""
        if isinstance(value, str) and (value == NONE or _EVERY.fullmatch(value)):
            return value
        hint = ""
        if isinstance(value, int) and not isinstance(value, bool) and value > 0:
            hint = f'; did you mean "every {value}"?'
        elif value == "all":
            hint = '; did you mean "every 1"?'
        raise refusal("none or every N with a whole number of steps N of 1 or more", value, hint)

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Validate with `check`."""
        return core_schema.no_info_plain_validator_function(self.check)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Describe the text by its pattern."""
        return {"type": "string", "pattern": f"^({NONE}|{_EVERY.pattern})$"}


def steps_between(every: str) -> int:
    """Return N of `every N`, 0 of `none`."""
    found = _EVERY.fullmatch(every)
    return int(found[1]) if found else 0


class ResidualWindow(ResolvedModel):
    """A stretch of simulated time [s]."""

    begin: float = Field(alias="from")
    end: float = Field(alias="to")


class CellRecord(ResolvedModel):
    """What is logged beyond every step."""

    residuals: Literal["none", "all"] | ResidualWindow
    problems: str  # none, or every N
