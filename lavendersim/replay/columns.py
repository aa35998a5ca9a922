"""Poses, contacts, forces and plots of a log, as rerun columns on `sim_time`.

A step without contacts sends an empty list, which clears the arrows of the step before.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt
import rerun as rr

from lavendersim.cell import Plane
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.periodic_cell import wrapped
from lavendersim.geometry.shapes import bounding_radius
from lavendersim.replay.blocks import blocks, send_columns
from lavendersim.replay.connections import send_connections
from lavendersim.replay.force_scale import CONTACT_KEY, ForceScale
from lavendersim.replay.joint_forces import with_whole_forces
from lavendersim.replay.layer import ALONE, Layer
from lavendersim.replay.removal import clear_removed
from lavendersim.replay.scene import BODIES, GRIDS, WORLD, Extent, entity

if TYPE_CHECKING:
    from lavendersim.trace import Trace

CONTACT_POINTS = ("contacts", "points")
CONTACT_FORCES = ("contacts", "forces")

ARROW_OF_SCENE = 0.006  # radius of a shaft in diagonals of the scene, at most
ARROW_OF_BODY = 0.06  # and in bounding radii of the median movable body

# What is read of a contact, whatever else its log holds.
CONTACT_FIELDS = ("step", *CONTACT_KEY, "x", "y", "z", "nx", "ny", "nz", "force_n")

FORCE_COLOUR = 0xF0E442FF  # yellow
CUT_FORCE_COLOUR = 0xD55E00FF  # vermilion: this arrow would be longer
POINT_COLOUR = (255, 255, 255)


class Plot(NamedTuple):
    """One curve: which field of the log, under which name with unit, and how it is shown.

    `topic`: the log's own curve of the field; without it the field is not worth drawing.
    `dots`: drawn as points, because its values stand alone where contacts last one step.
    `least`: a curve that changes by no more, in its unit, is a straight line: round-off.
    """

    topic: str
    entity: str
    field: str
    title: str
    colour: tuple[int, int, int]
    shown: Callable[[npt.NDArray[np.float64]], npt.NDArray[np.float64]]
    dots: bool = False
    least: float = 0.0


def millimetres(metres: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Lengths [m] in millimetres."""
    return metres * 1e3


def log10(numbers: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Base-10 logarithm; NaN (a gap in the curve) where a number is exactly zero."""
    logarithm = np.full(len(numbers), np.nan)
    np.log10(numbers, out=logarithm, where=numbers > 0)
    return logarithm


PLOTS = (
    Plot(
        "/plot/force",
        "plot/force",
        "total_normal_force",
        "total normal force [N]",
        (240, 228, 66),
        np.asarray,
    ),
    Plot(
        "/plot/penetration",
        "plot/depth",
        "max_penetration",
        "max penetration [mm]",
        (86, 180, 233),
        millimetres,
        least=1e-6,
    ),
    Plot(
        "/plot/log10_residual",
        "plot/residual",
        "residual",
        "log10 residual [m/s]",
        (204, 121, 167),
        log10,
        dots=True,
    ),
)


def values_of(trace: Trace, plot: Plot) -> npt.NDArray[np.float64]:
    """The plotted values of every row; not finite where there is nothing to plot."""
    return plot.shown(np.asarray(trace.step[plot.field], dtype=np.float64))


def contacts_of(trace: Trace) -> npt.NDArray[Any]:
    """The trace's contacts, and one force a joint; a run without any may not name their fields."""
    contact = with_whole_forces(trace.recorded_contact)
    return contact if len(contact) else np.zeros(0, [(name, "f8") for name in CONTACT_FIELDS])


def plots_of(trace: Trace) -> list[Plot]:
    """The plots whose topic and field the log has; which it has follows the experiment's plan."""
    fields = trace.step.dtype.names or ()
    return [plot for plot in PLOTS if plot.topic not in trace.absent and plot.field in fields]


def time_in_nanoseconds(trace: Trace) -> npt.NDArray[np.int64]:
    """Simulated time of every row [ns], from the log's integers."""
    return np.asarray(trace.step["time_ns"], dtype=np.int64)


def send(
    stream: rr.RecordingStream,
    trace: Trace,
    room: Extent,
    scale: ForceScale | None,
    since: int = 0,
) -> None:
    """Send everything that changes from step to step; contacts where there is a scale for them.

    since: the row of the log that is the first to be sent.
    """
    send_scene(stream, trace, room, scale, since=since)
    times = time_in_nanoseconds(trace).astype("timedelta64[ns]")
    _send_plots(stream, trace, times, since)


def send_scene(
    stream: rr.RecordingStream,
    trace: Trace,
    room: Extent,
    scale: ForceScale | None,
    layer: Layer = ALONE,
    since: int = 0,
) -> None:
    """Send what changes in the scene: poses, connections, contacts, and what is removed."""
    nanoseconds = time_in_nanoseconds(trace)
    _send_poses(stream, trace, nanoseconds.astype("timedelta64[ns]"), layer, since)
    send_connections(stream, trace, nanoseconds, layer, since)
    if scale is not None:
        _send_contacts(stream, trace, room, scale, layer, since)
    clear_removed(stream, trace, nanoseconds, [BODIES, GRIDS], layer)


def _send_poses(
    stream: rr.RecordingStream, trace: Trace, times: npt.NDArray[Any], layer: Layer, since: int
) -> None:
    given, cell = trace.config.scene.bodies, trace.config.scene.periodic
    recorded, pose = trace.recorded_pose
    for body, name in enumerate(trace.bodies):
        if isinstance(given[name].shape, Plane):
            continue  # drawn in the world's frame
        # A diverged run's last rows may hold NaN, which no viewer can place.
        rows = np.flatnonzero(np.isfinite(pose[:, body]).all(axis=1))
        if len(rows) and (pose[rows, body] == pose[rows[0], body]).all():
            rows = rows[:1]  # it never moves: one row is enough
        rows = rows[recorded[rows] >= since]
        for block in blocks(len(rows)):
            here = rows[block]
            columns = rr.Transform3D.columns(
                translation=wrapped(pose[here, body, :3], cell),
                quaternion=pose[here, body][:, [4, 5, 6, 3]],  # ours is w x y z, rerun's x y z w
                child_frame=[layer.frame(name)] * len(here),
                parent_frame=[WORLD] * len(here),
            )
            send_columns(stream, entity(name, layer), times[recorded[here]], columns)


def _send_contacts(
    stream: rr.RecordingStream,
    trace: Trace,
    room: Extent,
    scale: ForceScale,
    layer: Layer,
    since: int,
) -> None:
    times = time_in_nanoseconds(trace).astype("timedelta64[ns]")
    thickness = arrow_thickness(trace, room)
    points = rr.Points3D.from_fields(colors=[POINT_COLOUR], radii=[1.5 * thickness])
    stream.log(layer.path(*CONTACT_POINTS), rr.CoordinateFrame(WORLD), points, static=True)
    arrows = rr.Arrows3D.from_fields(radii=[thickness])
    stream.log(layer.path(*CONTACT_FORCES), rr.CoordinateFrame(WORLD), arrows, static=True)

    contact = contacts_of(trace)
    recorded = trace.recorded_rows("/contacts")
    recorded = recorded[recorded >= since]
    steps, times = trace.step["step"][recorded], times[recorded]
    first = np.searchsorted(contact["step"], steps, side="left")
    end = np.searchsorted(contact["step"], steps, side="right")
    for block in blocks(len(times)):
        lengths = (end - first)[block]
        rows = contact[first[block][0] : end[block][-1]]
        origins = wrapped(_vectors(rows, "x", "y", "z"), trace.config.scene.periodic)
        vectors, cut = scale.arrows(_vectors(rows, "nx", "ny", "nz"), rows["force_n"])
        colours = np.where(cut, CUT_FORCE_COLOUR, FORCE_COLOUR).astype(np.uint32)
        forces = rr.Arrows3D.columns(origins=origins, vectors=vectors, colors=colours)
        send_columns(stream, layer.path(*CONTACT_FORCES), times[block], forces.partition(lengths))
        spots = rr.Points3D.columns(positions=origins)
        send_columns(stream, layer.path(*CONTACT_POINTS), times[block], spots.partition(lengths))


def arrow_thickness(trace: Trace, room: Extent) -> float:
    """Radius [m] of an arrow's shaft: seen in the whole scene, and thin beside the bodies.

    In a crowd of small bodies arrows of a share of the scene would cover them.
    """
    bodies = trace.config.scene.bodies.values()
    radii = [
        bounding_radius(body.shape)
        for body in bodies
        if is_movable(body) and not isinstance(body.shape, Plane)
    ]
    beside = ARROW_OF_BODY * float(np.median(radii)) if radii else math.inf
    return min(ARROW_OF_SCENE * room.diagonal, beside)


def _vectors(rows: npt.NDArray[Any], x: str, y: str, z: str) -> npt.NDArray[np.float64]:
    return np.stack([rows[x], rows[y], rows[z]], axis=-1).reshape(-1, 3)


def _send_plots(
    stream: rr.RecordingStream, trace: Trace, times: npt.NDArray[Any], since: int
) -> None:
    for plot in plots_of(trace):
        look: dict[str, Any] = {"colors": [plot.colour], "names": [plot.title]}
        style = (
            rr.SeriesPoints(markers="circle", marker_sizes=[1.5], **look)
            if plot.dots
            # Impacts last one step: an average over a pixel's steps would hide them.
            else rr.SeriesLines(widths=[1.5], aggregation_policy="MinMax", **look)
        )
        stream.log(plot.entity, style, static=True)
        send_curve(stream, plot.entity, times[since:], values_of(trace, plot)[since:])


def send_curve(
    stream: rr.RecordingStream,
    path: str,
    times: npt.NDArray[Any],
    values: npt.NDArray[np.float64],
) -> None:
    """Send a plot's values at these times, with a gap where they are not finite."""
    for block in blocks(len(times)):
        known = np.isfinite(values[block])
        curve = rr.Scalars.columns(scalars=values[block][known])
        send_columns(stream, path, times[block], curve.partition(known.astype(np.int64)))
