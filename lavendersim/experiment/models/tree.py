"""What rules read of the whole tree: its bodies by name, its axes, whether a body moves.

An arrangement `tower` of 30 has the bodies tower_1 to tower_30. Values of a wrong type, which are
refused elsewhere, make an arrangement of none.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from lavendersim.engine.effects import MOTION_KEYS
from lavendersim.experiment.text.node import Node, Path

MOST_BODIES = 100_000  # of a scene; their names alone are some megabytes
BODIES: Path = ("scene", "bodies")
ARRANGEMENTS: Path = ("scene", "arrangements")
# Keys of effects: a body where one is true has no mass, as a fixed one, but it moves.
PRESCRIBE_MOTION: Final = tuple(key.name for key in MOTION_KEYS)


def members(arrangement: Node) -> int:
    """Return how many bodies an arrangement has."""
    kind = arrangement.text_at("kind")
    if kind == "tower":
        return _whole(arrangement.get("count"))
    if kind == "pyramid":
        rows = _whole(arrangement.get("base_count"))
        return rows * (rows + 1) // 2
    counts = arrangement.get("counts")
    if kind != "grid" or counts is None or len(counts.items) != 3:
        return 0
    x, y, z = (_whole(item) for item in counts.items)
    return x * y * z


def _whole(node: Node | None) -> int:
    number = node.number if node is not None else None
    return int(number) if number is not None and 0 < number <= MOST_BODIES else 0


def member_name(arrangement: str, number: int) -> str:
    """Return the name of a body of an arrangement; numbers count from 1."""
    return f"{arrangement}_{number}"


def body_names(root: Node) -> Iterator[str]:
    """Yield the names of all bodies, in their order; no more than a scene may have."""
    yield from root.entries_at(*BODIES)
    left = MOST_BODIES
    for name, arrangement in root.entries_at(*ARRANGEMENTS).items():
        count = min(members(arrangement), left)
        left -= count
        yield from (member_name(name, number) for number in range(1, count + 1))


def body_node(root: Node, name: str | None) -> Node | None:
    """Return the node that describes the body of this name, None where there is none."""
    if name is None:
        return None
    single = root.entries_at(*BODIES).get(name)
    if single is not None:
        return single
    arrangement, _, number = name.rpartition("_")
    node = root.entries_at(*ARRANGEMENTS).get(arrangement)
    if node is None or not (number.isascii() and number.isdigit()) or len(number) > 6:
        return None
    return node.get("body") if 1 <= int(number) <= members(node) else None


def described(root: Node) -> Iterator[tuple[str, Node]]:
    """Yield every node that describes bodies, with the name of the body or the arrangement."""
    yield from root.entries_at(*BODIES).items()
    for name, arrangement in root.entries_at(*ARRANGEMENTS).items():
        body = arrangement.get("body")
        if body is not None:
            yield name, body


def is_static(body: Node) -> bool:
    """Tell whether a body never moves: a plane, or fixed."""
    return body.text_at("shape", "kind") == "plane" or body.is_true("fixed")


def prescribes_motion(body: Node) -> str | None:
    """Return the key by which a body moves whatever touches it, None where there is none."""
    return next((key for key in PRESCRIBE_MOTION if body.is_true(key)), None)


def immovable(body: Node | None, *, prescribed: bool) -> str | None:
    """Return in a word why nothing moves a body; a prescribed motion counts where it says so."""
    if body is None:
        return None
    if body.text_at("shape", "kind") == "plane":
        return "a plane"
    own = prescribes_motion(body) if prescribed else None
    return own or ("fixed" if is_static(body) else None)


def duration_of(root: Node) -> float | None:
    """Return the simulated time [s], None where it is no number."""
    return root.number_at("duration")


def products(root: Node) -> tuple[Node, ...]:
    """Return the mappings of axes whose products, one after the other, are the sweep."""
    sweep = root.get("sweep")
    if sweep is None:
        return ()
    return (sweep,) if sweep.entries else sweep.items


def swept_values(root: Node) -> dict[str, list[Node]]:
    """Return the nodes of the values of every axis, over all products of the sweep."""
    values: dict[str, list[Node]] = {}
    for product in products(root):
        for axis, node in product.entries.items():
            values.setdefault(axis, []).extend(node.items_at("values"))
    return values
