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

from typing import Annotated, Final, Literal

from pydantic import Field

from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Either, Quantity
from lavendersim.quantities.readings import CONTACTS, POSES

NONE: Final = "none"
DERIVED: Final = "derived"
FINITE: Final = "finite"
# That a cell ends where its config says; `diverges` is what it does instead.
COMPLETES: Final = "completes"
DIVERGES: Final = "diverges"
# Begins the status of a cell that was stopped at a bound; the name of the check follows.
BEYOND_BOUNDS: Final = "beyond bounds: "


_Off = Literal["none"]
Share = Annotated[
    _Off | Annotated[float, Quantity("", above=0)],
    Either("a number above 0 or none", NONE, float),
]
Depth = Annotated[
    Literal["none", "derived"] | Annotated[float, Quantity("m", minimum=0)],
    Either("a number of 0 or more [m], derived or none", (NONE, DERIVED), float),
]
Speed = Annotated[
    _Off | Annotated[float, Quantity("m/s", above=0)],
    Either("a number above 0 [m/s] or none", NONE, float),
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
