"""The names that all entities and frames of one log have in a recording that has several."""

from __future__ import annotations

from typing import NamedTuple

import rerun as rr


class Layer(NamedTuple):
    """A name before the path of each entity and each body's frame; none where a log is alone."""

    name: str = ""

    def path(self, *parts: str) -> str:
        """Entity path of these parts, escaped as rerun requires."""
        return rr.new_entity_path([self.name, *parts] if self.name else [*parts])

    def frame(self, body: str) -> str:
        """Name of a body's coordinate frame."""
        return f"{self.name}:{body}" if self.name else body


ALONE = Layer()
