"""How far poses (..., 7), x y z [m] and qw qx qy qz, are from each other."""

from __future__ import annotations

import numpy as np

from lavendersim.geometry.rotations import Floats


def distances(a: Floats, b: Floats) -> Floats:
    """Return the distances [m] of centres."""
    found: Floats = np.linalg.norm(a[..., :3] - b[..., :3], axis=-1)
    return found


def turns(a: Floats, b: Floats) -> Floats:
    """Return the angles [rad] between orientations.

    By the chord between unit quaternions, 2 sin(angle/4), which keeps its digits near 0; q and -q
    are one orientation.
    """
    p, q = a[..., 3:], b[..., 3:]
    chord = np.minimum(np.linalg.norm(p - q, axis=-1), np.linalg.norm(p + q, axis=-1))
    found: Floats = 4.0 * np.arcsin(np.minimum(0.5 * chord, 1.0))
    return found
