"""What a periodic cell cannot be with, each with the path of the key that asks for it."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from typing import Final

from lavendersim.cell.config import CellConfig
from lavendersim.cell.shapes import Plane
from lavendersim.experiment.text.node import Path

AXES: Final = "xyz"
WITHOUT_IMAGES: Final = ("compound", "bowl", "drum")  # shapes


def limits_of_images(config: CellConfig) -> Iterator[tuple[Path, str]]:
    """Yield what cannot be with images: of connections, of shapes, and what is too large.

    Of bodies less than half a period across one image alone of each can touch another
    (`engine.collide.nearest_image`).
    """
    scene = config.scene
    if scene.periodic is None:
        return
    from lavendersim.geometry.shapes import bounding_radius  # late: it loads numpy

    periods = scene.periodic.periods
    axis = min(periods, key=periods.__getitem__)
    for key in ("connections", "springs"):
        if getattr(scene, key):
            sentence = "the scene is periodic, and none reaches across its faces yet"
            yield ("scene", key), f"{sentence}; leave one out"
    for name, body in scene.bodies.items():
        place, shape = ("scene", "bodies", name, "shape"), body.shape
        radius = bounding_radius(shape)
        if shape.kind in WITHOUT_IMAGES:
            yield place, f"the scene is periodic, and a {shape.kind} has no images yet ({name})"
        elif isinstance(shape, Plane):
            leaves = [one for one in periods if shape.normal[AXES.index(one)] != 0.0]
            if leaves:
                sentence = f"the scene is periodic along {leaves[0]}, which {name} does not contain"
                yield place, f"{sentence}; expected a plane whose normal is across it"
        elif isfinite(radius) and 4.0 * radius >= periods[axis]:
            sentence = f"the scene repeats itself along {axis} after {periods[axis]:g} m"
            yield (
                place,
                f"{sentence}; expected bodies less than half of that across, and {name} has "
                f"{2.0 * radius:g} m",
            )
