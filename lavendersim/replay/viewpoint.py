"""What a person may choose of a replay's view; it knows nothing of rerun."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

from lavendersim.errors import UsageError
from lavendersim.quantities.found import near, quoted

Place = tuple[float, float, float]

# Towards the eye, with z up. From above it leans a little: up must not be the line of sight.
SIDES: Final[dict[str, Place]] = {
    "front": (0.0, -1.0, 0.0),
    "back": (0.0, 1.0, 0.0),
    "left": (-1.0, 0.0, 0.0),
    "right": (1.0, 0.0, 0.0),
    "above": (0.0, -1e-3, 1.0),
}


class Viewpoint(NamedTuple):
    """From where and how fast a recording is seen.

    camera: one of SIDES, a place [m], or "" for the front right; follow: a body that it moves with;
    speed: simulated seconds per second, by default slow enough to be seen.
    """

    camera: str | Place = ""
    follow: str = ""
    speed: float | None = None


DEFAULT_VIEW: Final = Viewpoint()


def camera_from(text: str) -> str | Place:
    """Read a side or a place: "above", "3,-2,1".

    Raises UsageError for anything else.
    """
    if text in SIDES:
        return text
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        close = near(text, SIDES)
        hint = f'; did you mean "{close}"?' if close else ""
        raise UsageError(
            f"--camera: expected {', '.join(SIDES)} or a place X,Y,Z [m], got {quoted(text)}{hint}"
        ) from None
    if not all(map(math.isfinite, (x, y, z))):
        raise UsageError(f"--camera: expected a place at finite coordinates, got {quoted(text)}")
    return x, y, z
