"""What connects bodies, as lines that move with them.

    rope, spring    from end to end; a rope that is slack straight, too, and dark
    joint           from the centre of each body that moves to the joint, where A has it

A connection vanishes with the first of its bodies that is removed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt
import rerun as rr

from lavendersim.cell import CellBody, CellScene, Plane
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.rotations import rotation_matrices, rotation_matrix
from lavendersim.replay.blocks import blocks, send_columns
from lavendersim.replay.layer import Layer
from lavendersim.replay.removal import removed
from lavendersim.replay.scene import WORLD
from lavendersim.replay.timeline import at_time

if TYPE_CHECKING:
    from lavendersim.trace import Trace

CONNECTIONS: Final = "connections"
LINE_COLOUR, SLACK_COLOUR = 0xE6E6E6FF, 0x80808CFF
WIDTH: Final = 1.5  # [points of the screen]
# Of a rope's length, by which its ends are closer where it is drawn as slack.
SLACK: Final = 1e-3

Floats = npt.NDArray[np.float64]


class Corner(NamedTuple):
    """A corner of a line: a point in the frame of a body."""

    body: str
    point: Floats  # [m]


class DrawnLine(NamedTuple):
    """How a connection is drawn."""

    path: tuple[str, ...]  # of its entity
    ends: tuple[Corner, ...]
    length: float | None = None  # [m] of a rope

    @property
    def bodies(self) -> list[str]:
        """The names of the bodies whose points it has."""
        return [end.body for end in self.ends]


def lines_of(scene: CellScene) -> list[DrawnLine]:
    """Return a line for each rope, spring and joint, in the order of the config."""
    lines = []
    for name, one in scene.connections.items():
        if one.kind != "rope":  # a joint
            lines.append(DrawnLine(("joints", name), _arms(one, scene.bodies)))
            continue
        ends = [
            Corner(body, np.array(at)) for body, at in zip(one.between, one.points, strict=True)
        ]
        a, b = (_in_world(scene.bodies[end.body], end.point) for end in ends)
        length = one.length if one.length is not None else float(np.linalg.norm(b - a))
        lines.append(DrawnLine(("ropes", name), tuple(ends), length))
    for number, spring in enumerate(scene.springs):
        tied = ((spring.a, spring.point_a), (spring.b, spring.point_b))
        ends = [Corner(body, np.array(point)) for body, point in tied]
        lines.append(DrawnLine(("springs", str(number)), tuple(ends)))
    return lines


def _arms(joint: Any, bodies: dict[str, CellBody]) -> tuple[Corner, ...]:
    """Return the centre of A, the joint in the frame of A, and the centre of B; of what moves."""
    a, b = joint.between
    body = bodies[a]
    point = np.array(joint.at)
    if not isinstance(body.shape, Plane):
        point = rotation_matrix(body.orientation).T @ (point - np.array(body.position))
    centres = [[Corner(name, np.zeros(3))] if is_movable(bodies[name]) else [] for name in (a, b)]
    return (*centres[0], Corner(a, point), *centres[1])


def _in_world(body: CellBody, point: Floats) -> Floats:
    """Return where a body's point is as the run begins [m]."""
    if isinstance(body.shape, Plane):
        return point
    return np.array(body.position) + rotation_matrix(body.orientation) @ point


def corners_of(line: DrawnLine, trace: Trace, rows: npt.NDArray[np.int64]) -> Floats:
    """Return the corners of a line (rows, corners, 3) [m]; rows: of the recorded poses."""
    pose = trace.recorded_pose.pose
    bodies = trace.config.scene.bodies
    corners = []
    for name, point in line.ends:
        if isinstance(bodies[name].shape, Plane):  # its points are the world's
            corners.append(np.broadcast_to(point, (len(rows), 3)))
            continue
        own = pose[rows, trace.bodies.index(name)]
        corners.append(own[:, :3] + rotation_matrices(own[:, 3:7]) @ point)
    return np.stack(corners, axis=1)


def send_connections(
    stream: rr.RecordingStream,
    trace: Trace,
    times: npt.NDArray[np.int64],
    layer: Layer,
    since: int,
) -> None:
    """Send the lines of all connections of what moves.

    times: of the log's rows [ns]; since: the first of them that is sent.
    """
    scene = trace.config.scene
    lines = [one for one in lines_of(scene) if any(is_movable(scene.bodies[n]) for n in one.bodies)]
    if not lines:
        return
    recorded, pose = trace.recorded_pose
    # A diverged run's last rows may hold NaN, which no viewer can place.
    rows = np.flatnonzero(np.isfinite(pose).all(axis=(1, 2)) & (recorded >= since))
    gone = removed(trace)
    for line in lines:
        place = layer.path(CONNECTIONS, *line.path)
        end = min((gone[name] for name in line.bodies if name in gone), default=len(times))
        drawn = rows[recorded[rows] < end]
        look = rr.LineStrips3D.from_fields(radii=rr.Radius.ui_points(WIDTH))
        stream.log(place, rr.CoordinateFrame(WORLD), look, static=True)
        for block in blocks(len(drawn)):
            here = drawn[block]
            corners = corners_of(line, trace, here)
            strips = rr.LineStrips3D.columns(strips=list(corners), colors=_colours(line, corners))
            moments = times[recorded[here]].astype("timedelta64[ns]")
            send_columns(stream, place, moments, strips)
        if end < len(times):
            with at_time(stream, int(times[end])):
                stream.log(place, rr.LineStrips3D([]))  # what is static cannot be cleared


def _colours(line: DrawnLine, corners: Floats) -> npt.NDArray[np.uint32]:
    """Return the colour of a line in each row."""
    slack = np.zeros(len(corners), dtype=bool)
    if line.length is not None:
        apart = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
        slack = apart < (1.0 - SLACK) * line.length
    return np.where(slack, SLACK_COLOUR, LINE_COLOUR).astype(np.uint32)
