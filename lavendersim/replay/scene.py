"""The extent of a scene, and its static geometry in rerun.

Entities are `bodies/<name>`. Each body is a coordinate frame of the same name below the world's, so
that its pose (see columns.py) moves whatever is drawn in it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import rerun as rr

from lavendersim.geometry.periodic_cell import bounds_with_cell, edges_of_cell, wrapped
from lavendersim.geometry.rotations import rotated, shortest_turn
from lavendersim.replay.camera import Camera
from lavendersim.replay.layer import ALONE, Layer
from lavendersim.replay.removal import removed
from lavendersim.replay.shapes import XYZW, DrawnBody, Vector, shapes
from lavendersim.replay.solids import BodyLook, archetypes, surface
from lavendersim.replay.timeline import at_time

if TYPE_CHECKING:
    from lavendersim.trace import Trace

__all__ = ["WORLD", "DrawnBody", "Extent", "Vector", "draw", "entity", "extent", "shapes"]

BODIES, GRIDS = "bodies", "grid"  # where bodies are drawn, and the grids of planes
CELL = "cell"  # and the edges of a periodic cell
WORLD = "tf#/"  # rerun's name of the root frame, which no body can have

# Okabe and Ito's palette, which stays distinct for all common kinds of colour blindness. Yellow
# and vermilion are kept for forces (columns.py).
MOVABLE_COLOURS = ((86, 180, 233), (204, 121, 167), (0, 158, 115), (0, 114, 178), (230, 159, 0))
FIXED_COLOUR = (150, 150, 150)
GHOST_COLOUR = (225, 225, 230)
GROUND_COLOUR = (74, 78, 86)
GRID_COLOUR = (112, 118, 128)

PATH_POINTS = 2000  # more than a screen has pixels along a path
SEEN_INTO = ("bowl", "drum")  # walls are around the bodies: solid ones would hide them
LABELLED_BODIES = 8  # more names than this cover what they name


class Extent(NamedTuple):
    """The box [m] that holds everything the movable bodies do, and its diagonal."""

    low: Vector
    high: Vector

    @property
    def centre(self) -> Vector:
        """Middle of the box [m]."""
        return (self.low + self.high) / 2

    @property
    def diagonal(self) -> float:
        """Length of the box's diagonal [m]; never zero."""
        return float(np.linalg.norm(self.high - self.low)) or 1.0


class Stage(NamedTuple):
    """How the bodies of a log are drawn.

    ghost: movable bodies alone, as pale lines, to lie over those of another log.
    """

    room: Extent
    camera: Camera
    layer: Layer = ALONE
    ghost: bool = False


def entity(name: str, layer: Layer = ALONE) -> str:
    """Entity path of a body; its last part is the body's name, escaped as rerun requires."""
    return layer.path(BODIES, name)


def extent(trace: Trace, bodies: Iterable[DrawnBody]) -> Extent:
    """The room that the bodies take over the whole trace, planes left out."""
    row_of = {name: row for row, name in enumerate(trace.bodies)}
    cell = trace.config.scene.periodic
    lows, highs = [], []
    for body in bodies:
        if body.kind == "plane":
            continue
        positions = wrapped(trace.recorded_pose.pose[:, row_of[body.name], :3], cell)
        positions = positions[np.isfinite(positions).all(axis=1)]
        if len(positions):
            lows.append(positions.min(axis=0) - body.bounding_radius)
            highs.append(positions.max(axis=0) + body.bounding_radius)
    if not lows:
        return Extent(np.full(3, -0.5), np.full(3, 0.5))
    return Extent(*bounds_with_cell(np.min(lows, axis=0), np.max(highs, axis=0), cell))


def draw(
    stream: rr.RecordingStream,
    trace: Trace,
    bodies: Sequence[DrawnBody],
    stage: Stage,
) -> None:
    """Log every body's geometry, and the path its centre takes, once.

    As static data, but for what is removed during the run: that can be cleared (`clear_removed`).
    """
    stream.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    layer, ghost = stage.layer, stage.ghost
    gone = removed(trace)
    begin = int(trace.step["time_ns"][0]) if len(trace.step) else 0
    if not ghost:
        _draw_cell(stream, trace, stage)
    movable = sum(not body.fixed for body in bodies)
    colours = iter(MOVABLE_COLOURS * (movable // len(MOVABLE_COLOURS) + 1))
    for body in bodies:
        stays = body.name not in gone
        if ghost and body.fixed:
            continue
        if body.kind == "plane":
            with at_time(stream, begin):
                _draw_plane(stream, body, stage, stays)
            continue
        colour = FIXED_COLOUR if body.fixed else GHOST_COLOUR if ghost else next(colours)
        _draw_path(stream, trace, body, colour, layer)
        labelled = len(bodies) <= LABELLED_BODIES and not ghost
        # Forces act at surfaces and point into bodies: solid bodies would hide them.
        look = BodyLook(colour, body.fixed and body.kind not in SEEN_INTO, body.name, labelled)
        drawn = archetypes(body.pieces, look)
        if body.mesh is not None:
            drawn = {body.kind: surface(body.mesh, look)}
        frame = rr.CoordinateFrame(layer.frame(body.name))
        for kind, forms in drawn.items():
            within = [] if len(drawn) == 1 else [kind]
            for form in forms:
                edges = ["edges"] if isinstance(form, rr.LineStrips3D) else []
                place = layer.path(BODIES, body.name, *within, *edges)
                with at_time(stream, begin):
                    stream.log(place, frame, form, static=stays)


def _draw_path(
    stream: rr.RecordingStream,
    trace: Trace,
    body: DrawnBody,
    colour: tuple[int, int, int],
    layer: Layer,
) -> None:
    """A thin line through the body's recorded positions: a still picture then tells its story."""
    path = trace.recorded_pose.pose[:, trace.bodies.index(body.name), :3]
    path = path[np.isfinite(path).all(axis=1)]
    if trace.config.scene.periodic is not None:
        return  # a line through places in the cell would cross it wherever the body leaves it
    if len(path) and np.ptp(path, axis=0).max() > 0:
        path = path[:: 1 + len(path) // PATH_POINTS]
        line = rr.LineStrips3D([path], colors=[(*colour, 120)], radii=rr.Radius.ui_points(1.0))
        place = layer.path("paths", body.name)
        stream.log(place, rr.CoordinateFrame(WORLD), line, static=True)


def _draw_cell(stream: rr.RecordingStream, trace: Trace, stage: Stage) -> None:
    """Lines along the edges of a periodic cell, which goes as far as the room where it is open."""
    edges = edges_of_cell(stage.room.low, stage.room.high, trace.config.scene.periodic)
    if len(edges):
        radius = rr.Radius.ui_points(1.0)
        lines = rr.LineStrips3D(list(edges), colors=[GRID_COLOUR], radii=radius)
        stream.log(stage.layer.path(CELL), rr.CoordinateFrame(WORLD), lines, static=True)


def _draw_plane(stream: rr.RecordingStream, plane: DrawnBody, stage: Stage, stays: bool) -> None:
    """A thin box whose upper face lies in the plane, below (or beside) the scene, with a grid.

    The viewer's own grid is endless and flickers where it coincides with a face. Of a plane that
    stands between the eye and the bodies there is the grid alone.
    """
    room, layer = stage.room, stage.layer
    thickness = 0.01 * room.diagonal
    spacing = grid_spacing(room)
    cells = math.ceil(0.7 * room.diagonal / spacing)
    across = cells * spacing
    foot = room.centre - (plane.normal @ room.centre - plane.offset) * plane.normal
    turn = shortest_turn(plane.normal)
    slab = rr.Boxes3D(
        half_sizes=[[across, across, thickness / 2]],
        centers=[foot - plane.normal * thickness / 2],
        quaternions=[rr.Quaternion(xyzw=turn[XYZW])],
        colors=[GROUND_COLOUR],
        fill_mode="Solid",
    )
    if not stage.camera.is_behind(plane):
        stream.log(entity(plane.name, layer), rr.CoordinateFrame(WORLD), slab, static=stays)

    ticks = np.linspace(-across, across, 2 * cells + 1)
    ends = np.array([-across, across])
    lift = 0.1 * thickness  # or the slab's face hides the lines
    along = [[(tick, end, lift) for end in ends] for tick in ticks]
    corners = np.array(along + [[(y, x, z) for x, y, z in line] for line in along])
    lines = foot + rotated(turn, corners)
    radius = rr.Radius.ui_points(0.5)
    grid = rr.LineStrips3D(list(lines), colors=[GRID_COLOUR], radii=radius)
    place = layer.path(GRIDS, plane.name)
    stream.log(place, rr.CoordinateFrame(WORLD), grid, static=stays)


def grid_spacing(room: Extent) -> float:
    """A power of ten [m] that gives a plane's grid some 10 to 100 lines."""
    return float(10.0 ** math.floor(math.log10(room.diagonal / 2)))
