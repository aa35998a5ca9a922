"""Which bodies events remove, and when: nothing happens to a body that is gone."""

from __future__ import annotations

from typing import NamedTuple

from lavendersim.experiment.text.node import Node
from lavendersim.experiment.text.place import place_of


class Removal(NamedTuple):
    """When a body is removed."""

    at: float  # [s]
    event: int  # its index

    def sentence(self, key: str, name: str | None) -> str:
        """Return why the value of this key comes too late for the body."""
        event = place_of(("events", self.event))
        return f'{key}: "{name}" is removed at {self.at:g} s by {event}'


def removals(root: Node) -> dict[str, Removal]:
    """Return the first removal of each body that is removed, by its name."""
    gone: dict[str, Removal] = {}
    for index, event in enumerate(root.items_at("events")):
        at, body = event.number_at("at"), event.text_at("body")
        if event.is_true("remove") and at is not None and body is not None:
            one = Removal(at, index)
            gone[body] = min(gone.get(body, one), one)
    return gone
