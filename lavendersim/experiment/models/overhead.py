"""The `price` section of a config in; a validated PriceSpec out: what is timed, and how often."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, Tag

from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Quantity, either


def _effects_form(value: Any) -> str | None:
    return "all" if value == "all" else "named" if isinstance(value, list | tuple) else None


EffectNames = Annotated[
    Annotated[Literal["all"], Tag("all")]
    | Annotated[tuple[str, ...], Field(min_length=1), Tag("named")],
    either("all, or a list of effects", _effects_form),
]


class PriceSpec(ConfigModel):
    """What each effect costs in this scene: taken by `lavender run`, after the cells."""

    effects: EffectNames = Field(default="all", description="all, or names of effects")
    repeats: Annotated[int, Quantity(whole=True, minimum=1, maximum=1000)] = Field(
        default=9, description="rounds; every round visits every effect, on and off, in turn"
    )
    begin: Annotated[float, Quantity("s", minimum=0)] = Field(
        alias="from",
        default=0.0,
        description="[s] simulated time at which what is timed begins; it ends with the run",
    )
