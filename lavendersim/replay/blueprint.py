"""The layout of the viewer: the bodies beside the plots, or alone.

+----------------------+-------------+
|                      | force [N]   |
|  bodies, contacts,   +-------------+
|  force arrows        | depth [mm]  |
|                      +-------------+
|                      | residual    |
+----------------------+-------------+
|  sim_time                          |
+------------------------------------+

The log of a scene in which nothing can touch has no such plots: the bodies take the whole width.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
import rerun as rr
import rerun.blueprint as rrb

from lavendersim.replay.camera import Camera
from lavendersim.replay.columns import (
    plots_of,
    time_in_nanoseconds,
    values_of,
)
from lavendersim.replay.force_scale import ForceScale
from lavendersim.replay.layer import ALONE, Layer
from lavendersim.replay.scene import WORLD, DrawnBody, Extent, grid_spacing
from lavendersim.replay.timeline import TIMELINE

if TYPE_CHECKING:
    from lavendersim.trace import Trace

BACKGROUND = (24, 26, 30)
MARGIN = 0.06  # of a plot's range, on every side

SHOWN_SECONDS = 8.0  # contacts are short: play slowly enough to be seen, never faster than life


def blueprint(
    trace: Trace,
    bodies: Sequence[DrawnBody],
    room: Extent,
    scale: ForceScale | None,
    camera: Camera,
    speed: float | None = None,
) -> rrb.Blueprint:
    """Lay out the 3D view and the plots of a recording; scale: None where nothing can touch.

    speed: simulated seconds per second; by default slow enough to be seen.
    """
    times = time_in_nanoseconds(trace)
    seconds = float(times[-1] - times[0]) * 1e-9 if len(times) else 0.0
    grounded = any(body.kind == "plane" for body in bodies)
    rulers = [scale.label if scale is not None else "bodies"]
    rulers += [f"grid {grid_spacing(room):g} m"] if grounded else []
    scene = scene_view("; ".join(rulers), contents_of(ALONE, scale is not None), camera)
    curves = [
        curves_view(plot.entity, plot.title, values_of(trace, plot), seconds, least=plot.least)
        for plot in plots_of(trace)
    ]
    beside = rrb.Horizontal(scene, rrb.Vertical(*curves), column_shares=[3, 2])
    return laid_out(beside if curves else scene, seconds, speed)


def contents_of(layer: Layer, contacts: bool) -> list[str]:
    """The entities of a log that a view of its scene has."""
    folders = ("bodies", "connections", "paths", "grid", "cell", *["contacts"] * contacts)
    return [f"{layer.path(folder)}/**" for folder in folders]


def scene_view(
    name: str, contents: list[str], camera: Camera, layer: Layer = ALONE
) -> rrb.Spatial3DView:
    """The view of a scene; layer: of the body that the camera follows."""
    return rrb.Spatial3DView(
        origin="/",
        contents=contents,
        name=name,
        background=rrb.Background(color=BACKGROUND),
        eye_controls=camera.controls(layer),
        line_grid=rrb.LineGrid3D(visible=False),
        spatial_information=rrb.SpatialInformation(target_frame=WORLD),
    )


def playback_speed(seconds: float) -> float:
    """Simulated seconds per second at which a recording of that length is played by default."""
    return float(np.clip(seconds / SHOWN_SECONDS, 0.05, 1.0))


def laid_out(
    views: rrb.Container | rrb.View, seconds: float, speed: float | None = None
) -> rrb.Blueprint:
    """The viewer with these views and nothing else; seconds: of the recording."""
    return rrb.Blueprint(
        views,
        rrb.TopPanel(state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.TimePanel(
            state="collapsed",
            timeline=TIMELINE,
            playback_speed=playback_speed(seconds) if speed is None else speed,
            play_state="playing",
            loop_mode="all",
        ),
        auto_layout=False,
        auto_views=False,
    )


def curves_view(
    entity: str,
    title: str,
    values: npt.NDArray[np.float64],
    seconds: float,
    legend: rrb.Corner2D | None = None,
    least: float = 0.0,
) -> rrb.TimeSeriesView:
    """One plot, the whole recording in view: first and last step must not lie on the frame.

    values: all that are drawn in it; not finite where there is nothing to draw. least: a curve that
    changes by no more is a straight line.
    """
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    margin = MARGIN * (high - low) if high - low > least else 1.0
    shown = rr.TimeRange(
        start=rrb.TimeRangeBoundary.absolute(seconds=-MARGIN * seconds),
        end=rrb.TimeRangeBoundary.absolute(seconds=(1 + MARGIN) * seconds),
    )
    return rrb.TimeSeriesView(
        origin=entity,
        name=title,
        axis_x=rrb.TimeAxis(view_range=shown),
        axis_y=rrb.ScalarAxis(range=(low - margin, high + margin)),
        plot_legend=rrb.PlotLegend(legend, visible=legend is not None),
    )
