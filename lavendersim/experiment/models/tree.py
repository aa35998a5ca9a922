"""What rules read of the whole tree: bodies by name, whether and how long they move; its axes.

An arrangement `tower` of 30 has the bodies tower_1 to tower_30. Values of a wrong type, which are
refused elsewhere, make an arrangement of none.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import Final, NamedTuple

from lavendersim.engine.effects import MOTION_KEYS
from lavendersim.experiment.models.axis import axis_values
from lavendersim.experiment.text.node import Node, Path
from lavendersim.experiment.text.place import Place, place_of

MOST_BODIES = 100_000  # of a scene; their names alone are some megabytes
BODIES: Path = ("scene", "bodies")
ARRANGEMENTS: Path = ("scene", "arrangements")
# Keys of effects: a body where one is true has no mass, as a fixed one, but it moves.
PRESCRIBE_MOTION: Final = tuple(key.name for key in MOTION_KEYS)


def members(arrangement: Node) -> int:
    """Return how many bodies an arrangement has."""
    kind = arrangement.get("kind").text
    if kind in ("tower", "row", "ring"):
        return _whole(arrangement.get("count"))
    if kind in ("pyramid", "rack"):
        rows = _whole(arrangement.get("base_count" if kind == "pyramid" else "rows"))
        return rows * (rows + 1) // 2
    counts = arrangement.get("counts").items
    if kind != "grid" or len(counts) != 3:
        return 0
    return math.prod(map(_whole, counts))


def _whole(node: Node) -> int:
    number = node.number
    return int(number) if number is not None and 0 < number <= MOST_BODIES else 0


def member_name(arrangement: str, number: int) -> str:
    """Return the name of a body of an arrangement; numbers count from 1."""
    return f"{arrangement}_{number}"


@lru_cache(maxsize=1)  # several rules and warnings ask for bodies of one tree
def _body_paths(root: Node) -> dict[str, Path]:
    """Return where the nodes stand that describe all bodies, in their order; see `bodies_of`."""
    paths: dict[str, Path] = {name: (*BODIES, name) for name in root.get(*BODIES).entries}
    left = MOST_BODIES
    for name, arrangement in root.get(*ARRANGEMENTS).entries.items():
        count = min(members(arrangement), left)
        left -= count
        path = (*ARRANGEMENTS, name, "body")
        for number in range(1, count + 1):
            own = number == 1 and arrangement.get("first").entries
            paths.setdefault(member_name(name, number), (*path[:-1], "first") if own else path)
    return paths


@lru_cache(maxsize=1)  # every force and event asks for one
def bodies_of(root: Node) -> dict[str, Node]:
    """Return the nodes that describe all bodies, in their order; no more than a scene may have."""
    paths = _body_paths(root)
    nodes = {path: root.get(*path) for path in dict.fromkeys(paths.values())}
    return {name: nodes[path] for name, path in paths.items()}


def body_path(root: Node, name: str) -> Path:
    """Return where the node stands that describes the body of this name, () where there is none."""
    return _body_paths(root).get(name, ())


def described(root: Node) -> Iterator[tuple[str, Node]]:
    """Yield every node that describes bodies, with the name of the body or the arrangement."""
    yield from root.get(*BODIES).entries.items()
    for name, arrangement in root.get(*ARRANGEMENTS).entries.items():
        if body := arrangement.get("body"):
            yield name, body
        if (first := arrangement.get("first")) and first.entries:
            yield member_name(name, 1), first


def prescribes_motion(body: Node) -> str | None:
    """Return the key by which a body moves whatever touches it, None where there is none."""
    return next((key for key in PRESCRIBE_MOTION if body.get(key).is_true), None)


def immovable(body: Node, *, prescribed: bool) -> str | None:
    """Return in a word why nothing moves a body; a prescribed motion counts where it says so."""
    if body.get("shape", "kind").text == "plane":
        return "a plane"
    own = prescribes_motion(body) if prescribed else None
    kind = body.get("shape", "kind").text
    if kind in ("bowl", "drum", "mesh", "height_field") and not prescribes_motion(body):
        return f"a {kind}"
    return own or ("fixed" if body.get("fixed").is_true else None)


def after_the_end(at: Place, key: str) -> bool:
    """Refuse a time [s] that comes after the run; tells whether it does."""
    time, length = at.get(key), at.root.get("duration").number
    late = time.number is not None and length is not None and time.number > length > 0
    if late:
        sentence = f"{time.number:g} s is after the end of the run, duration {length:g} s"
        at.refuse(time.mark, f"{key}: {sentence}")
    return late


def not_after(at: Place, begin: float) -> None:
    """Refuse an end that does not come after the beginning [s]."""
    end = at.get("to")
    at.refuse(end.mark, f"to: expected a time after from ({begin:g} s), found {end.number:g}")


def products(root: Node) -> tuple[Node, ...]:
    """Return the mappings of axes whose products, one after the other, are the sweep."""
    sweep = root.get("sweep")
    return (sweep,) if sweep.entries else sweep.items


def swept_values(root: Node) -> dict[str, list[Node]]:
    """Return the nodes of the values of every axis, over all products of the sweep."""
    values: dict[str, list[Node]] = {}
    for product in products(root):
        for axis, node in product.entries.items():
            values.setdefault(axis, []).extend(axis_values(node))
    return values


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
    for index, event in enumerate(root.get("events").items):
        at, body = event.get("at").number, event.get("body").text
        if event.get("remove").is_true and at is not None and body is not None:
            one = Removal(at, index)
            gone[body] = min(gone.get(body, one), one)
    return gone
