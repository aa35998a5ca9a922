"""Bodies of a resolved config enter; the rows of the engine's body table leave, as descriptions.

Row k is body k; the parts of compounds follow behind all bodies, each with the row of its owner. A
compound's own row moves and has no surface; its parts have surfaces and do not move by themselves.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, inf
from typing import Any, NamedTuple

UPRIGHT = (1.0, 0.0, 0.0, 0.0)


class Collider(NamedTuple):
    """One row of the body table: a body, or a part of one."""

    shape: dict[str, Any]
    body: dict[str, Any]  # the body it belongs to
    owner: int  # row of that body; its own row where it is no part
    part: dict[str, Any] | None = None  # of its compound, with its place in it

    @property
    def kind(self) -> str:
        """Name of the shape."""
        return str(self.shape["kind"])


def colliders(bodies: Sequence[dict[str, Any]]) -> list[Collider]:
    """Return a description of every row of the body table."""
    rows = [Collider(body["shape"], body, row) for row, body in enumerate(bodies)]
    for row, body in enumerate(bodies):
        parts = body["shape"].get("parts", ())
        rows.extend(Collider(part["shape"], body, row, part) for part in parts)
    return rows


def is_movable(body: dict[str, Any]) -> bool:
    """Whether contacts and forces move a body of a resolved config."""
    return body["shape"]["kind"] != "plane" and not body["fixed"]


def bounding_radius(shape: dict[str, Any]) -> float:
    """Return the radius of the sphere about the centre that holds the shape [m]; planes: inf."""
    kind = shape["kind"]
    if kind == "plane":
        return inf
    if kind == "sphere":
        return float(shape["radius"])
    if kind == "box":
        return 0.5 * hypot(*shape["size"])
    if kind == "capsule":
        return 0.5 * float(shape["length"]) + float(shape["radius"])
    if kind == "cylinder":
        return hypot(0.5 * float(shape["length"]), float(shape["radius"]))
    if kind == "hull":
        return max(hypot(*point) for point in shape["points"])
    return max(hypot(*part["position"]) + bounding_radius(part["shape"]) for part in shape["parts"])
