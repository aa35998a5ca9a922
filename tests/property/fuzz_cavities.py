"""The bowl or the drum that one drawn scene of six stands in: at rest, carried on, or turning.

It is drawn from a seed of its own, so that all other scenes stay what they are. A body is in every
cavity of its scene: its radius is such that all fit, and one of them is at the wall, or beyond.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from fuzz_drives import set_in_motion

EVERY = 6  # of so many scenes one has a cavity, in the mean


def cavity(pen: Any, bodies: dict[str, Any], sizes: dict[str, float]) -> None:
    """Add a cavity around bodies, in most scenes none. pen: of another seed than theirs."""
    if pen.integer(1, EVERY) > 1:
        return
    kind = pen.one_of(("bowl", "drum"))
    places = {name: np.array(bodies[name]["position"]) for name in sizes}
    at_wall = pen.one_of([*sizes])
    spread = max(np.linalg.norm(place - places[at_wall]) + sizes[name]
                 for name, place in places.items())  # fmt: skip
    needed = max(least_radius(bodies[name]["shape"], size) for name, size in sizes.items())
    radius = max(needed, float(spread) * pen.one_of((0.2, 1.0, 3.0)))
    way = np.array(pen.some_vector(0.0, 0.0))
    way *= (radius - sizes[at_wall] * (1.5 - pen.share())) / np.linalg.norm(way)
    body: dict[str, Any] = {
        "shape": {"kind": kind, "radius": radius},
        "position": (places[at_wall] - way).tolist(),
        "orientation": pen.turn(),
        "surface": pen.surface(radius),
    }
    if pen.has("surface_velocity"):
        body["surface_velocity"] = pen.vector(pen.power(-2.0, 1.0))
    set_in_motion(pen, body, 2.0)
    bodies["cavity"] = body


def least_radius(shape: dict[str, Any], size: float) -> float:
    """Return a radius [m] of cavities that hold a shape of this size.

    No shape is thicker than 2.2 sizes. An ellipsoid touches in one point where all its radii of
    curvature are less than the cavity's; the largest is a^2/c.
    """
    return max(1.1 * size, *(1.01 * max(axes) ** 2 / min(axes) for axes in _semi_axes(shape)), 0.0)


def _semi_axes(shape: dict[str, Any]) -> Iterator[list[float]]:
    if shape["kind"] == "ellipsoid":
        yield shape["semi_axes"]
    for part in shape.get("parts", ()):
        yield from _semi_axes(part["shape"])
