"""The resolved shape of a body in; how large and how thin it is out [m]."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np


def bounding_radius(shape: Mapping[str, Any]) -> float:
    """Return the distance from the centre of mass to the farthest point [m]; 0 for a plane."""
    kind = shape["kind"]
    if kind == "plane":
        return 0.0
    if kind == "box":
        return 0.5 * math.hypot(*shape["size"])
    if kind == "hull":
        return max(math.hypot(*point) for point in shape["points"])
    if kind == "compound":
        return max(
            math.hypot(*part["position"]) + bounding_radius(part["shape"])
            for part in shape["parts"]
        )
    half = 0.5 * float(shape.get("length", 0.0))
    radius = float(shape["radius"])
    return math.hypot(radius, half) if kind == "cylinder" else radius + half


def thickness(shape: Mapping[str, Any]) -> float:
    """Return the least width along the axes of its frame [m]; of a compound, its thinnest part's.

    Infinite for a plane, which has no other side.
    """
    kind = shape["kind"]
    if kind == "plane":
        return math.inf
    if kind == "box":
        return min(float(edge) for edge in shape["size"])
    if kind == "hull":
        return float(np.ptp(np.asarray(shape["points"], dtype=float), axis=0).min())
    if kind == "compound":
        return min(thickness(part["shape"]) for part in shape["parts"])
    width = 2.0 * float(shape["radius"])
    return min(width, float(shape["length"])) if kind == "cylinder" else width
