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

from lavendersim.replay.columns import (
    plots_of,
    time_in_nanoseconds,
    values_of,
)
from lavendersim.replay.force_scale import ForceScale
from lavendersim.replay.layer import ALONE, Layer
from lavendersim.replay.scene import WORLD, DrawnBody, Extent, Vector, grid_spacing
from lavendersim.replay.timeline import TIMELINE

if TYPE_CHECKING:
    from lavendersim.trace import Trace

BACKGROUND = (24, 26, 30)
MARGIN = 0.06  # of a plot's range, on every side

# From the front right and a little above: floors are seen from above, stacks from the side.
VIEW_DIRECTION = np.array([0.5, -1.0, 0.35])
VIEW_DISTANCE = 1.15  # diagonals: the whole extent within rerun's vertical field of view

SHOWN_SECONDS = 8.0  # contacts are short: play slowly enough to be seen, never faster than life


def blueprint(
    trace: Trace, bodies: Sequence[DrawnBody], room: Extent, scale: ForceScale | None
) -> rrb.Blueprint:
    """Lay out the 3D view and the plots of a recording; scale: None where nothing can touch."""
    times = time_in_nanoseconds(trace)
    seconds = float(times[-1] - times[0]) * 1e-9 if len(times) else 0.0
    grounded = any(body.kind == "plane" for body in bodies)
    rulers = [scale.label if scale is not None else "bodies"]
    rulers += [f"grid {grid_spacing(room):g} m"] if grounded else []
    scene = scene_view("; ".join(rulers), contents_of(ALONE, scale is not None), bodies, room)
    curves = [
        curves_view(plot.entity, plot.title, values_of(trace, plot), seconds)
        for plot in plots_of(trace)
    ]
    beside = rrb.Horizontal(scene, rrb.Vertical(*curves), column_shares=[3, 2])
    return laid_out(beside if curves else scene, seconds)


def contents_of(layer: Layer, contacts: bool) -> list[str]:
    """The entities of a log that a view of its scene has."""
    folders = ("bodies", "paths", "grid", *(["contacts"] if contacts else []))
    return [f"{layer.path(folder)}/**" for folder in folders]


def scene_view(
    name: str, contents: list[str], bodies: Sequence[DrawnBody], room: Extent
) -> rrb.Spatial3DView:
    """The view of a scene."""
    return rrb.Spatial3DView(
        origin="/",
        contents=contents,
        name=name,
        background=rrb.Background(color=BACKGROUND),
        eye_controls=rrb.EyeControls3D(
            kind=rrb.Eye3DKind.Orbital,
            position=eye_position(bodies, room),
            look_target=room.centre,
            eye_up=(0, 0, 1),
        ),
        line_grid=rrb.LineGrid3D(visible=False),
        spatial_information=rrb.SpatialInformation(target_frame=WORLD),
    )


def laid_out(views: rrb.Container | rrb.View, seconds: float) -> rrb.Blueprint:
    """The viewer with these views and nothing else; seconds: of the recording."""
    return rrb.Blueprint(
        views,
        rrb.TopPanel(state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.TimePanel(
            state="collapsed",
            timeline=TIMELINE,
            playback_speed=float(np.clip(seconds / SHOWN_SECONDS, 0.05, 1.0)),
            play_state="playing",
            loop_mode="all",
        ),
        auto_layout=False,
        auto_views=False,
    )


def eye_position(bodies: Sequence[DrawnBody], room: Extent) -> Vector:
    """Where the camera stands [m]: far enough to see everything, on the open side of each plane."""
    direction = VIEW_DIRECTION / np.linalg.norm(VIEW_DIRECTION)
    for plane in (body for body in bodies if body.kind == "plane"):
        direction = direction + max(0.0, 0.3 - float(direction @ plane.normal)) * plane.normal
    direction = direction / np.linalg.norm(direction)
    return np.asarray(room.centre + VIEW_DISTANCE * room.diagonal * direction)


def curves_view(
    entity: str,
    title: str,
    values: npt.NDArray[np.float64],
    seconds: float,
    legend: rrb.Corner2D | None = None,
) -> rrb.TimeSeriesView:
    """One plot, the whole recording in view: first and last step must not lie on the frame.

    values: all that are drawn in it; not finite where there is nothing to draw.
    """
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    margin = MARGIN * (high - low) or 1.0
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
