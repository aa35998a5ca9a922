"""The rerun recording of two logs on one timeline, with the distances of their bodies.

    side by side                          overlaid
    +-----------+-----------+             +---------------+-----------+
    |  A        |  B        |             |  A, B's bodies| distance  |
    +-----------+-----------+             |  as pale lines+-----------+
    |  distance | log10     |             |               | log10     |
    +-----------+-----------+             +---------------+-----------+

Both are seen from one place, in one scale of forces, so that what looks different is.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from lavendersim.replay import columns, scene
from lavendersim.replay.blueprint import contents_of, curves_view, laid_out, scene_view
from lavendersim.replay.camera import Camera, camera_of
from lavendersim.replay.force_scale import ForceScale, force_scale, scene_size
from lavendersim.replay.layer import Layer
from lavendersim.replay.pair import Distances, LogPair, distances_of
from lavendersim.replay.viewpoint import Viewpoint

if TYPE_CHECKING:
    from lavendersim.trace import Trace

A, B = Layer("A"), Layer("B")
Curve = np.ndarray[Any, np.dtype[np.float64]]


class _Plot(NamedTuple):
    """Distances as they are drawn."""

    folder: str
    title: str
    shown: Callable[[Curve], Curve]
    legend: rrb.Corner2D  # where curves that grow are not


# Where both are equal to the bit the logarithm has a gap.
_PLOTS: Final = (
    _Plot("distance", "distance between A and B [mm]", columns.millimetres, rrb.Corner2D.LeftTop),
    _Plot(
        "log10_distance",
        "log10 distance between A and B [m]",
        columns.log10,
        rrb.Corner2D.RightBottom,
    ),
)


def record_pair(
    pair: LogPair, stream: rr.RecordingStream, title: str, viewpoint: Viewpoint
) -> None:
    """Send two logs and the layout of the viewer to `stream`."""
    bodies = {layer: scene.shapes(trace.config) for layer, trace in _layers(pair)}
    rooms = [scene.extent(trace, bodies[layer]) for layer, trace in _layers(pair)]
    room = scene.Extent(
        np.min([one.low for one in rooms], axis=0), np.max([one.high for one in rooms], axis=0)
    )
    scale = _common_scale(pair, scene_size(room.diagonal, bodies[A]))
    found = distances_of(pair)
    stream.send_recording_name(title)
    camera = camera_of(pair.a, bodies[A], room, viewpoint)
    stream.send_blueprint(_blueprint(pair, scale, found, camera, viewpoint.speed))
    for layer, trace in _layers(pair):
        ghost = pair.overlay and layer == B
        scene.draw(stream, trace, bodies[layer], scene.Stage(room, camera, layer, ghost))
        touching = trace.has("/contacts") and not ghost
        columns.send_scene(stream, trace, room, scale if touching else None, layer)
    _send_distances(stream, found)


def _layers(pair: LogPair) -> list[tuple[Layer, Trace]]:
    return [(A, pair.a), (B, pair.b)]


def _common_scale(pair: LogPair, size: float) -> ForceScale | None:
    """Return the scale of the log with the larger forces; None where nothing can touch."""
    scales = [
        force_scale(columns.contacts_of(trace), size)
        for _, trace in _layers(pair)
        if trace.has("/contacts")
    ]
    return max(scales, key=lambda one: one.newtons_per_metre, default=None)


def _blueprint(
    pair: LogPair,
    scale: ForceScale | None,
    found: Distances,
    camera: Camera,
    speed: float | None,
) -> rrb.Blueprint:
    seconds = float(max(columns.time_in_nanoseconds(t)[-1] for _, t in _layers(pair))) * 1e-9
    curves = [
        curves_view(
            f"plot/{plot.folder}",
            plot.title,
            np.concatenate([np.empty(0), *(plot.shown(one.metres) for one in found.bodies)]),
            seconds,
            legend=plot.legend,
        )
        for plot in _PLOTS
    ]
    ruler = f"; {scale.label}" if scale is not None else ""
    name_a, name_b = pair.short_names
    if pair.overlay:
        name = f"A: {name_a}, B as pale lines: {name_b}{ruler}"
        seen = [*contents_of(A, scale is not None), *contents_of(B, False)]
        view = scene_view(name, seen, camera, A)
        beside = rrb.Horizontal(view, rrb.Vertical(*curves), column_shares=[3, 2])
        return laid_out(beside, seconds, speed)
    views = [
        scene_view(f"{layer.name}: {name}{ruler}", contents_of(layer, True), camera, layer)
        for layer, name in ((A, name_a), (B, name_b))
    ]
    rows = rrb.Vertical(rrb.Horizontal(*views), rrb.Horizontal(*curves), row_shares=[3, 2])
    return laid_out(rows, seconds, speed)


def _send_distances(stream: rr.RecordingStream, found: Distances) -> None:
    times = found.times.astype("timedelta64[ns]")
    for plot in _PLOTS:
        for one in found.bodies:
            colour = scene.MOVABLE_COLOURS[one.place % len(scene.MOVABLE_COLOURS)]
            path = rr.new_entity_path(["plot", plot.folder, one.body])
            look = rr.SeriesLines(
                colors=[colour], names=[one.body], widths=[1.5], aggregation_policy="MinMax"
            )
            stream.log(path, look, static=True)
            columns.send_curve(stream, path, times, plot.shown(one.metres))
