"""Triggers as written: the state that makes an event happen, `events[k].when`."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from lavendersim.cell.triggers import CONDITIONS, OF_CONTACT, OF_PLACE, Condition
from lavendersim.experiment.text.node import Node
from lavendersim.experiment.text.place import Place
from lavendersim.quantities.found import quoted
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import BodyName
from lavendersim.quantities.quantity import Direction, Quantity

_TwoBodies = Annotated[tuple[BodyName, ...], Field(min_length=2, max_length=2)]


class Trigger(ConfigModel):
    """A state of one body, or of two, that makes an event happen once."""

    touches: _TwoBodies | None = Field(
        default=None, description="names of two bodies: they press on each other in a step"
    )
    leaves: _TwoBodies | None = Field(
        default=None, description="names of two bodies: they press no more, having done so"
    )
    body: BodyName | None = Field(default=None, description="the body of a speed or a place")
    faster_than: Annotated[float, Quantity("m/s", minimum=0)] | None = Field(
        default=None, description="[m/s] speed of its centre of mass is larger"
    )
    slower_than: Annotated[float, Quantity("m/s", above=0)] | None = Field(
        default=None, description="[m/s] speed of its centre of mass is less"
    )
    along: Direction = Field(
        default=(0.0, 0.0, 1.0),
        description="direction of `above` and `below`, world frame; is normalised",
    )
    above: Annotated[float, Quantity("m")] | None = Field(
        default=None, description="[m] its centre of mass lies farther along the direction"
    )
    below: Annotated[float, Quantity("m")] | None = Field(
        default=None, description="[m] its centre of mass lies less far"
    )

    @property
    def condition(self) -> Condition:
        """The key of its state."""
        return next(key for key in CONDITIONS if getattr(self, key) is not None)

    @classmethod
    def rules(cls, at: Place) -> None:
        """One state, of the bodies that it takes."""
        given = [key for key in CONDITIONS if at.written(key)]
        if not given:
            if not at.node.incomplete and at.node.entries.keys() <= cls.model_fields.keys():
                at.lacks("touches", f"a state, {', '.join(CONDITIONS[:-1])} or {CONDITIONS[-1]}")
            return
        if len(given) > 1:
            at.refuse(at.key(given[1]), f"{given[1]}: {at} has {given[0]}; expected one state")
            return
        (key,) = given
        if key in OF_CONTACT:
            if body := at.written("body"):
                at.refuse(body, f"body: {key} names its two bodies")
            names = [node.text for node in at.get(key).items]
            if len(names) == 2 and names[0] == names[1]:
                sentence = f"{key}: expected two bodies, found {quoted(names[0])} twice"
                at.refuse(at.get(key).mark, sentence)
        elif not at.written("body") and not at.node.incomplete:
            at.lacks("body", f"name of the body of {key}")
        if key not in OF_PLACE and (along := at.written("along")):
            at.refuse(along, f"along: {key} has no direction; expected above or below")


def triggers(root: Node) -> list[int]:
    """Return the indices of the events that have one."""
    events = enumerate(root.get("events").items)
    return [index for index, event in events if event.get("when").content is not None]
