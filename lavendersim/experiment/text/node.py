"""A parsed YAML value that remembers where it stands; every message points at one of these."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from lavendersim.errors import Defect
from lavendersim.quantities.scalars import Value


class Mark(NamedTuple):
    """A place in the text; both counted from 1, columns in characters."""

    line: int
    column: int
    file: str = ""  # where it is not the config itself: a file that it extends, or an option

    def defect(self, config: str, message: str) -> Defect:
        """Return a defect at this place; config: what messages call the config."""
        return Defect(self.file or config, self.line, self.column, message)


UNWRITTEN = Mark(0, 0)  # of a preset's values: before every place of the file


class Broken:
    """Stands in the data for a value that was already refused, so that it is reported once."""


BROKEN = Broken()
Path = tuple[str | int, ...]


@dataclass(slots=True, eq=False)  # frozen, a file of 100,000 values takes a tenth longer
class Node:
    """`content` is a scalar, a tuple of nodes, a dict of nodes by key, or BROKEN."""

    content: Value | tuple[Node, ...] | dict[str, Node] | Broken
    mark: Mark
    keys: Mapping[str, Mark] = field(default_factory=dict)  # of a mapping: where each key stands
    incomplete: bool = False  # one of its keys was refused, so that what it lacks is not known

    def get(self, *path: str | int) -> Node:
        """Return the node at the path below this one, or ABSENT, which is false, without one."""
        node = self
        for step in path:
            content = node.content
            if isinstance(step, str):
                node = content.get(step, ABSENT) if isinstance(content, dict) else ABSENT
            else:
                items = content if isinstance(content, tuple) else ()
                node = items[step] if 0 <= step < len(items) else ABSENT
        return node

    def __bool__(self) -> bool:
        return self is not ABSENT

    @property
    def entries(self) -> dict[str, Node]:
        """The entries of a mapping; nothing for any other node."""
        return self.content if isinstance(self.content, dict) else {}

    @property
    def items(self) -> tuple[Node, ...]:
        """The items of a list; nothing for any other node."""
        return self.content if isinstance(self.content, tuple) else ()

    @property
    def text(self) -> str | None:
        """The text of a text scalar; None for any other node."""
        return self.content if isinstance(self.content, str) else None

    @property
    def texts(self) -> Iterator[str]:
        """Every text at this node and below that is no key."""
        if isinstance(self.content, str):
            yield self.content
        for below in (*self.entries.values(), *self.items):
            yield from below.texts

    @property
    def number(self) -> float | None:
        """The number of a number scalar; None for any other node."""
        content = self.content
        if isinstance(content, bool) or not isinstance(content, int | float):
            return None
        return content

    @property
    def is_true(self) -> bool:
        """Whether it is `true`."""
        return self.content is True

    @property
    def data(self) -> Any:
        """The plain value: scalars, tuples and dicts."""
        if isinstance(self.content, tuple):
            return tuple(item.data for item in self.content)
        if isinstance(self.content, dict):
            return {key: node.data for key, node in self.content.items()}
        return self.content


ABSENT = Node(None, UNWRITTEN)  # has no text, number, entries or items


def key_mark(parent: Node, key: str) -> Mark:
    """Return where a key of the mapping stands."""
    return parent.keys.get(key, parent.mark)


def graft(root: Node, path: Path, value: Node) -> Node:
    """Return the tree with `value` at `path`; mappings missing on the way are made."""
    if not path:
        return value
    step, rest = path[0], path[1:]
    if isinstance(step, int):
        items = list(root.items)
        items[step] = graft(items[step], rest, value)
        return Node(tuple(items), root.mark)
    entries = dict(root.entries)
    below = entries.get(step, Node({}, value.mark))
    entries[step] = graft(below, rest, value)
    return Node(entries, root.mark, {step: value.mark, **root.keys}, root.incomplete)
