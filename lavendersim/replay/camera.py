"""From where a scene is seen: from the front right, from a side, from a place, or after a body.

By default everything is in view over the whole recording, from the open side of the planes.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import rerun.blueprint as rrb

from lavendersim.errors import UsageError
from lavendersim.quantities.found import nearest, quoted
from lavendersim.replay.layer import Layer
from lavendersim.replay.shapes import DrawnBody, Vector
from lavendersim.replay.viewpoint import SIDES, Viewpoint

if TYPE_CHECKING:
    from lavendersim.replay.scene import Extent
    from lavendersim.trace import Trace

# From the front right and a little above: floors are seen from above, stacks from the side.
VIEW_DIRECTION: Final = np.array([0.5, -1.0, 0.35])
VIEW_DISTANCE: Final = 1.15  # diagonals: the whole extent within rerun's vertical field of view
FOLLOWED_DISTANCE: Final = 12.0  # bounding radii: a body with what it touches


class Camera(NamedTuple):
    """Where the eye stands and what it looks at [m], at first; the body it then moves with."""

    position: Vector
    target: Vector
    follow: str = ""

    def controls(self, layer: Layer) -> rrb.EyeControls3D:
        """What rerun takes; layer: of the body that it follows."""
        return rrb.EyeControls3D(
            kind=rrb.Eye3DKind.Orbital,
            position=self.position,
            look_target=self.target,
            eye_up=(0, 0, 1),
            tracking_entity=layer.path("bodies", self.follow) if self.follow else None,
        )

    def is_behind(self, plane: DrawnBody) -> bool:
        """Whether a plane, drawn as a slab, would hide what is on its open side."""
        return float(self.position @ plane.normal) < plane.offset


def camera_of(
    trace: Trace, bodies: Sequence[DrawnBody], room: Extent, viewpoint: Viewpoint
) -> Camera:
    """Return where a recording is seen from.

    Raises UsageError for a body that it cannot follow.
    """
    target, distance = room.centre, VIEW_DISTANCE * room.diagonal
    if viewpoint.follow:
        followed = _followed(bodies, viewpoint.follow)
        places = trace.recorded_pose.pose[:, trace.bodies.index(followed.name), :3]
        places = places[np.isfinite(places).all(axis=1)]
        target = places[0] if len(places) else target
        distance = FOLLOWED_DISTANCE * followed.bounding_radius
    place = viewpoint.camera
    if isinstance(place, tuple):
        return Camera(np.array(place), target, viewpoint.follow)
    direction = np.array(SIDES[place]) if place else _open_side(bodies)
    direction = direction / np.linalg.norm(direction)
    return Camera(np.asarray(target + distance * direction), target, viewpoint.follow)


def _followed(bodies: Sequence[DrawnBody], name: str) -> DrawnBody:
    known = {body.name: body for body in bodies if body.kind != "plane"}
    if name not in known:
        hint = nearest(name, known)
        raise UsageError(f"--follow: no body that can be followed is called {quoted(name)}{hint}")
    return known[name]


def _open_side(bodies: Sequence[DrawnBody]) -> Vector:
    """Return the direction from which as many planes as can be are seen from their open side."""
    direction = VIEW_DIRECTION / np.linalg.norm(VIEW_DIRECTION)
    for plane in (body for body in bodies if body.kind == "plane"):
        direction = direction + max(0.0, 0.3 - float(direction @ plane.normal)) * plane.normal
    return np.asarray(direction)
