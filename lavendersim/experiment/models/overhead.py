"""The section `overhead`: what each effect costs in this scene; what is timed, and how often."""

from __future__ import annotations

from typing import Annotated, Final, Literal

from pydantic import Field

from lavendersim.experiment.text.node import Node, Path, key_mark
from lavendersim.experiment.text.place import Place
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Either, Quantity

REQUIRED: Final = "required"


EffectNames = Annotated[
    Literal["all", "required"] | Annotated[tuple[str, ...], Field(min_length=1)],
    Either("all, required, or a list of effects", ("all", REQUIRED), tuple),
]


TimedFrom = Annotated[
    float,
    Quantity("s", minimum=0),
    Field(
        alias="from",
        description="[s] simulated time at which what is timed begins; it ends with the run",
    ),
]


class OverheadSpec(ConfigModel):
    """What each effect costs in this scene: taken by `lavender run`, after the cells."""

    effects: EffectNames = Field(
        default="all",
        description="`required`: what the plan of the scene has; or a list of names, as `lavender "
        "plan` shows them",
    )
    repeats: Annotated[int, Quantity(whole=True, minimum=1, maximum=1000)] = Field(
        default=9, description="rounds; every round visits every effect, on and off, in turn"
    )
    begin: TimedFrom = 0.0

    @classmethod
    def rules(cls, at: Place) -> None:
        """Every sample is the same steps of one cell, in one go."""
        refuse_what_interrupts(at, "one cell", ("sweep",))


def refuse_what_interrupts(at: Place, expected: str, *others: Path) -> None:
    """Refuse what keeps a cell's steps from being timed in one go, and a beginning at its end."""
    for path in (*others, ("events",), ("scene", "forces")):
        other = at.root.get(*path)
        items = other.items
        if path[-1] == "forces":
            items = tuple(force for force in items if _interrupts(force))
        if other.entries or items:
            found = ".".join(map(str, path))
            sentence = (
                f"{at}: expected {expected} without events and constant forces, found {found}"
            )
            at.refuse(key_mark(at.root, str(at)), sentence)
    start, length = at.get("from"), at.root.get("duration").number
    if start.number is not None and length is not None and start.number >= length > 0:
        sentence = f"expected a time before the end (duration {length:g} s), found {start.number:g}"
        at.refuse(start.mark, f"from: {sentence}")


def _interrupts(force: Node) -> bool:
    """Tell whether a force begins and ends between steps; one that varies acts within them."""
    point = any(item.number for item in force.get("point").items)
    return not (force.get("factor").entries or force.get("frame").text == "body" or point)
