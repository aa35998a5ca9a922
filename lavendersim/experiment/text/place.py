"""A mapping of a config at its place in the file, and the sentences that name places."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from lavendersim.experiment.text.node import Mark, Node, Path, key_mark
from lavendersim.quantities.found import quoted


def name_of(path: Path) -> str:
    """Return how a sentence calls the value at the path: its key, with the index in a list."""
    keys = [index for index, step in enumerate(path) if isinstance(step, str)]
    if not keys:
        return "the file"
    indices = "".join(f"[{step}]" for step in path[keys[-1] + 1 :])
    return f"{path[keys[-1]]}{indices}"


def place_of(path: Path) -> str:
    """Return how a sentence calls the mapping at the path: all keys on the way."""
    if not path:
        return "the experiment"
    dotted = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path)
    return dotted.lstrip(".")


def missing_key(key: str, path: Path, meaning: str | None) -> str:
    """Return the sentence for a key that a mapping lacks."""
    return f"missing key {quoted(key)} in {place_of(path)}" + (f": {meaning}" if meaning else "")


@dataclass(frozen=True, slots=True)
class Place:
    """One mapping, as the rules of its model see it."""

    node: Node
    path: Path
    root: Node  # of the whole file
    refuse: Callable[[Mark, str], None]
    doubt: Callable[[], None]  # something is wrong that is refused elsewhere

    def __str__(self) -> str:
        return place_of(self.path)

    @property
    def index(self) -> int:
        """Its place in its list."""
        assert isinstance(self.path[-1], int)
        return self.path[-1]

    def get(self, *path: str | int) -> Node:
        """Return the node at the path below, ABSENT without one."""
        return self.node.get(*path)

    def key(self, key: str) -> Mark:
        """Return where a key stands."""
        return key_mark(self.node, key)

    def written(self, key: str) -> Mark | None:
        """Return where a key stands that is written; null writes nothing."""
        written = self.node.entries.get(key)
        return None if written is None or written.content is None else self.key(key)

    def given(self, keys: Iterable[str]) -> Iterator[tuple[str, Mark]]:
        """Yield those of some keys that are written, and where."""
        yield from ((key, mark) for key in keys if (mark := self.written(key)))

    def refuse_both(self, keys: Iterable[str]) -> int:
        """Refuse the later of two keys that exclude each other; how many of them are written."""
        found = dict(self.given(keys))
        if len(found) > 1:
            sentence = f"{self} specifies both {' and '.join(found)}; keep one"
            self.refuse(max(found.values()), sentence)
        return len(found)

    def refuse_pair(self, one: Node, other: Node, sentence: str) -> None:
        """Refuse values that exclude each other at the later: what is swept stands below."""
        self.refuse(max(one.mark, other.mark), sentence)

    def lacks(self, key: str, meaning: str) -> None:
        """Refuse the mapping for a key that it lacks."""
        self.refuse(self.node.mark, missing_key(key, self.path, meaning))
