"""The `record` section of a config: what is kept beyond every step's state and contacts."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, Tag
from pydantic_core import CoreSchema, core_schema

from lavendersim.experiment.base import ConfigModel
from lavendersim.experiment.quantities import Quantity, either, refusal

NONE = "none"
# Up to a billion, ten times the steps that a run may have.
_EVERY = re.compile(r"every ([1-9][0-9]{0,8})")


class Window(ConfigModel):
    """A stretch of simulated time."""

    begin: Annotated[float, Quantity("s", minimum=0)] = Field(alias="from", description="[s]")
    end: Annotated[float, Quantity("s", minimum=0)] = Field(alias="to", description="[s]")


def _residuals_form(value: Any) -> str | None:
    forms: dict[type, str] = {str: "switch", dict: "window"}
    return forms.get(type(value))


Residuals = Annotated[
    Annotated[Literal["none", "all"], Tag("switch")] | Annotated[Window, Tag("window")],
    either("none, all or {from: seconds, to: seconds}", _residuals_form),
]


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


class Record(ConfigModel):
    """What is logged beyond every step's state and contacts."""

    residuals: Residuals = Field(default="none", description="[m/s] residual of every sweep")
    problems: Annotated[str, EverySteps()] = Field(
        default=NONE,
        description="none, or every N: the contact problems of steps N, 2 N, ... as FCLIB files",
    )
