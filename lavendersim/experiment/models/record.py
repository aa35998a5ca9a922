"""The `record` section of a config: what is logged of which steps, and what beyond every step."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, Tag

from lavendersim.cell.record import ALL, NONE, EverySteps
from lavendersim.experiment.models.tree import duration_of
from lavendersim.experiment.text.place import Place
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Quantity, either


class Window(ConfigModel):
    """A stretch of simulated time."""

    begin: Annotated[float, Quantity("s", minimum=0)] = Field(alias="from", description="[s]")
    end: Annotated[float, Quantity("s", minimum=0)] = Field(alias="to", description="[s]")

    @classmethod
    def rules(cls, at: Place) -> None:
        """It ends after it begins, and begins in the run."""
        begin, end = at.node.number_at("from"), at.node.number_at("to")
        length = duration_of(at.root)
        if begin is None or end is None:
            return
        if begin >= end:
            sentence = f"to: expected a time after from ({begin:g} s), found {end:g}"
            at.refuse(at.node.entries["to"].mark, sentence)
        elif length is not None and begin > length:
            sentence = f"from: {begin:g} s is after the end of the run, duration {length:g} s"
            at.refuse(at.node.entries["from"].mark, sentence)


def _residuals_form(value: Any) -> str | None:
    forms: dict[type, str] = {str: "switch", dict: "window"}
    return forms.get(type(value))


Residuals = Annotated[
    Annotated[Literal["none", "all"], Tag("switch")] | Annotated[Window, Tag("window")],
    either("none, all or {from: seconds, to: seconds}", _residuals_form),
]


def _steps_form(value: Any) -> str | None:
    # a number is read as the text, which says how it would be right
    forms: dict[type, str] = {str: "every", int: "every", dict: "window"}
    return forms.get(type(value))


Steps = Annotated[
    Annotated[str, EverySteps(ALL), Tag("every")] | Annotated[Window, Tag("window")],
    either("all, every N or {from: seconds, to: seconds}", _steps_form),
]


class Record(ConfigModel):
    """What is logged of which steps, and beyond their state and contacts."""

    contacts: Steps = Field(
        default=ALL, description="of which steps: all, every N, or {from, to} [s]"
    )
    poses: Steps = Field(default=ALL, description="of which steps: all, every N, or {from, to} [s]")
    residuals: Residuals = Field(default="none", description="[m/s] residual of every sweep")
    problems: Annotated[str, EverySteps()] = Field(
        default=NONE,
        description="none, or every N: the contact problems of steps N, 2 N, ... as FCLIB files",
    )
