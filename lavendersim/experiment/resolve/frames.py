"""Frames of bodies: those that a file means, and those of the principal axes that a cell has."""

from __future__ import annotations

from typing import NamedTuple

from lavendersim.cell.body import CellBody
from lavendersim.geometry.quaternions import (
    Quaternion,
    inverse,
    product,
    to_body,
    to_world,
)
from lavendersim.quantities.quantity import Vector3


class Frames(NamedTuple):
    """What is written in the frames of bodies as their file has them, in those of the cell."""

    written: dict[str, Quaternion]  # by body: its frame as written to world, at the start
    bodies: dict[str, CellBody]

    def vector(self, name: str, vector: Vector3) -> Vector3:
        """Return a vector of a body's frame as written in the frame of its principal axes."""
        before, after = self.written[name], self.bodies[name].orientation
        return vector if before == after else to_body(after, to_world(before, vector))

    def orientation(self, name: str, turned: Quaternion) -> Quaternion:
        """Return the orientation of a body whose frame as written is turned so."""
        before, after = self.written[name], self.bodies[name].orientation
        if before == after:
            return turned
        return product(turned, product(inverse(before), after))
