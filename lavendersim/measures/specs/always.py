"""The `always` section of a config: bounds that every step of every cell must keep.

    always:
      energy: 1e-6
      penetration: 0.001
      speed: none

A key that is not given has a default; `none` leaves a check out. That the state is finite is
always checked. A cell ends with the first step that breaks a bound (`stop`). How each number is
taken, and why it stays within round-off where a run is right, stands in `lavendersim/measures`:
`balance` and `step_checks`.
"""

from __future__ import annotations

from typing import Annotated, Any, Final, Literal

from pydantic import Field, Tag

from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Quantity, either
from lavendersim.quantities.readings import CONTACTS, POSES

NONE: Final = "none"
DERIVED: Final = "derived"
FINITE: Final = "finite"
# That a cell ends where its config says; `diverges` is what it does instead.
COMPLETES: Final = "completes"
DIVERGES: Final = "diverges"
# Begins the status of a cell that was stopped at a bound; the name of the check follows.
BEYOND_BOUNDS: Final = "beyond bounds: "


def _form(value: Any, words: tuple[str, ...] = (NONE,)) -> str | None:
    if isinstance(value, str):
        return "off" if value in words else None
    return None if value is None or isinstance(value, bool | dict | list | tuple) else "bound"


def _form_of_depth(value: Any) -> str | None:
    return _form(value, (NONE, DERIVED))


_Off = Annotated[Literal["none"], Tag("off")]
Share = Annotated[
    _Off | Annotated[float, Quantity("", above=0), Tag("bound")],
    either("a number above 0 or none", _form),
]
Depth = Annotated[
    Annotated[Literal["none", "derived"], Tag("off")]
    | Annotated[float, Quantity("m", minimum=0), Tag("bound")],
    either("a number of 0 or more [m], derived or none", _form_of_depth),
]
Speed = Annotated[
    _Off | Annotated[float, Quantity("m/s", above=0), Tag("bound")],
    either("a number above 0 [m/s] or none", _form),
]


class Always(ConfigModel):
    """What every step of every cell must keep; `always: {}` takes every default."""

    energy: Share = Field(
        default=1e-6,
        description="most mechanical energy gained after any state, as a share of what is at play",
    )
    penetration: Depth = Field(
        default=DERIVED,
        description="[m] deepest penetration; derived: a tenth of the thinnest movable body",
    )
    impulses: Share = Field(
        default=1e-9,
        description="by how much contacts may pull or leave the friction cone, as a share of the "
        "largest normal impulse of the step",
    )
    momentum: Share = Field(
        default=1e-9,
        description="what of a step's change of momentum no impulse, gravity or force explains, as "
        "a share of all that enters the balance",
    )
    # A thousand times the tolerance of the default numerics: such a step was not solved at all.
    residual: Speed = Field(default=1e-6, description="[m/s] largest residual of any step")
    speed: Speed = Field(default=NONE, description="[m/s] greatest speed of any body")
    stop: bool = Field(
        default=True,
        description="whether a cell ends with the first step that breaks a bound; false: it goes "
        "on to its end, and the check fails all the same",
    )


# What a check takes of every step of a log; of the others, the sums of `/step`.
READS: Final = {
    "energy": CONTACTS,  # and poses, where forces do work or events give energy
    "penetration": CONTACTS,
    "impulses": CONTACTS,
    "momentum": CONTACTS,
    "speed": POSES,
}
# The names of the checks, in the order in which they are judged.
CHECKS: Final = (FINITE, *(name for name in Always.model_fields if name != "stop"))
# Those that a run is stopped by; one that is no longer finite ends by itself.
STOPPING: Final = tuple(name for name in CHECKS if name != FINITE)
