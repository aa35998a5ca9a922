"""The `record` section of a config: what is logged of which steps, and what beyond every step."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.cell.record import ALL, NONE, EveryOrAll, EveryOrNone
from lavendersim.experiment.models.tree import after_the_end, not_after
from lavendersim.experiment.text.place import Place
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Either, Quantity


class Window(ConfigModel):
    """A stretch of simulated time."""

    begin: Annotated[float, Quantity("s", minimum=0)] = Field(alias="from", description="[s]")
    end: Annotated[float, Quantity("s", minimum=0)] = Field(alias="to", description="[s]")

    @classmethod
    def rules(cls, at: Place) -> None:
        """It ends after it begins, and begins in the run."""
        begin, end = at.get("from").number, at.get("to").number
        if begin is None or end is None:
            return
        if begin >= end:
            not_after(at, begin)
        else:
            after_the_end(at, "from")


Residuals = Annotated[
    Literal["none", "all"] | Window, Either("none, all or {from: seconds, to: seconds}", str, dict)
]
Steps = Annotated[  # a number is read as the text, which says how it would be right
    EveryOrAll | Window, Either("all, every N or {from: seconds, to: seconds}", (str, int), dict)
]


class Record(ConfigModel):
    """What is logged of which steps, and beyond their state and contacts."""

    contacts: Steps = Field(
        default=ALL, description="of which steps: all, every N, or {from, to} [s]"
    )
    poses: Steps = Field(default=ALL, description="of which steps: all, every N, or {from, to} [s]")
    velocities: bool = Field(
        default=False,
        description="true: velocities and spins of all bodies, of the steps whose poses are",
    )
    residuals: Residuals = Field(default="none", description="[m/s] residual of every sweep")
    problems: EveryOrNone = Field(
        default=NONE,
        description="none, or every N: the contact problems of steps N, 2 N, ... as FCLIB files",
    )
