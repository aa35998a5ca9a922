"""Where a release above a plane puts a body; by the extent of its shape.

The gap between the body's surface and the plane n.x = offset, measured along n, is

    clearance + phase * sqrt(2 g h) * dt,    h = clearance, g = -gravity.n

so that the centre stands at  n.x = offset + extent + gap,  extent: how far the body's surface lies
below its centre along n (radius; for a box half the sum of |edge . n|). A step at impact falls
sqrt(2 g h) dt, hence phases 0..15/16 sample where in a step the impact falls.
"""

from __future__ import annotations

import math
from fractions import Fraction

from lavendersim.cell.body import Release
from lavendersim.cell.shapes import CellCompound, CellSimple, Plane
from lavendersim.experiment.text.node import Path
from lavendersim.geometry.support import extent_against
from lavendersim.geometry.vectors import dot, unit
from lavendersim.quantities.quantity import LARGEST, OF_64_BITS, Quaternion, Vector3


class SceneError(ValueError):
    """Values that fit their types and make no scene; `path`: the steps to what to change."""

    def __init__(self, path: Path, sentence: str) -> None:
        super().__init__(sentence)
        self.path = path


class below:  # noqa: N801 - a context manager, called like a function; it is entered for each body
    """Put these steps before the path of a SceneError that comes from within."""

    __slots__ = ("_steps",)

    def __init__(self, *steps: str | int) -> None:
        self._steps = steps

    def __enter__(self) -> None:
        """Nothing is to be done."""

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        """Raise the error with its whole path."""
        if isinstance(error, SceneError):
            raise SceneError((*self._steps, *error.path), str(error)) from None


def released_position(
    release: Release,
    plane: Plane,
    shape: CellSimple | CellCompound,
    orientation: Quaternion,
    gravity: Vector3,
    timestep: Fraction,
) -> Vector3:
    """Return the centre of mass [m] of a released body; raises SceneError, path from the body."""
    normal = unit(plane.normal)
    gap = release.clearance
    if release.phase:
        pull = -dot(gravity, normal)  # [m/s^2] towards the plane
        if pull <= 0.0:
            sentence = f"gravity does not pull towards {release.above}, so that there is no impact"
            raise SceneError(("release", "phase"), f"phase: {sentence} to shift; leave it out")
        try:
            gap += float(release.phase * timestep) * math.sqrt(2.0 * pull * release.clearance)
        except OverflowError:
            gap = math.inf
        if not gap <= LARGEST:
            sentence = f"expected a shift of {LARGEST:g} m or less{OF_64_BITS}"
            raise SceneError(("release", "phase"), f"phase: {sentence}")
    distance = plane.offset + extent_against(shape, orientation, normal) + gap
    nx, ny, nz = normal
    if release.at is None:
        return (nx * distance, ny * distance, nz * distance)
    x, y = release.at
    if abs(nz) < 1e-9:
        sentence = f"at: {release.above} stands upright, x and y do not say how high the body is"
        raise SceneError(("release", "at"), f"{sentence}; specify a position")
    return (x, y, (distance - nx * x - ny * y) / nz)
