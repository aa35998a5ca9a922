"""The tree of a config in; the names of all its bodies, and the node that describes each, out.

An arrangement `tower` of 30 has the bodies tower_1 to tower_30. Values of a wrong type, which are
refused elsewhere, make an arrangement of none.
"""

from __future__ import annotations

from collections.abc import Iterator

from lavendersim.experiment.models.arrangements import MOST_BODIES
from lavendersim.experiment.text.node import Node, Path

BODIES: Path = ("scene", "bodies")
ARRANGEMENTS: Path = ("scene", "arrangements")


def entries(root: Node, *path: str | int) -> dict[str, Node]:
    """Return the entries of the mapping at a path; nothing where there is none."""
    node = root.get(*path)
    return node.entries if node is not None else {}


def members(arrangement: Node) -> int:
    """Return how many bodies an arrangement has."""
    kind = arrangement.get("kind")
    text = kind.text if kind is not None else None
    if text == "tower":
        return _whole(arrangement.get("count"))
    if text == "pyramid":
        rows = _whole(arrangement.get("base_count"))
        return rows * (rows + 1) // 2
    counts = arrangement.get("counts")
    if text != "grid" or counts is None or len(counts.items) != 3:
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
    yield from entries(root, *BODIES)
    left = MOST_BODIES
    for name, arrangement in entries(root, *ARRANGEMENTS).items():
        count = min(members(arrangement), left)
        left -= count
        yield from (member_name(name, number) for number in range(1, count + 1))


def body_node(root: Node, name: str) -> Node | None:
    """Return the node that describes the body of this name, None where there is none."""
    stated = entries(root, *BODIES).get(name)
    if stated is not None:
        return stated
    arrangement, _, number = name.rpartition("_")
    node = entries(root, *ARRANGEMENTS).get(arrangement)
    if node is None or not (number.isascii() and number.isdigit()) or len(number) > 6:
        return None
    return node.get("body") if 1 <= int(number) <= members(node) else None


def described(root: Node) -> Iterator[tuple[Path, Node]]:
    """Yield every node that describes bodies: those of single ones, then those of arrangements."""
    for name, single in entries(root, *BODIES).items():
        yield (*BODIES, name), single
    for name, arrangement in entries(root, *ARRANGEMENTS).items():
        body = arrangement.get("body")
        if body is not None:
            yield (*ARRANGEMENTS, name, "body"), body
