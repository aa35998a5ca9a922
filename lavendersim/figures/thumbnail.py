"""The thumbnail of a cell: a small side view of where its bodies began and ended, as a PNG.

Outlines are the convex hulls of projected corners, so no renderer is needed. Up is against gravity;
sideways is the level direction in which the bodies spread most; what is farther is drawn first.
"""

from __future__ import annotations

import io
import math
from functools import lru_cache
from typing import Any, Final

import numpy as np

from lavendersim.cell import Bowl, Cavity, CellMesh, CellShape, Convex, Ellipsoid, Plane
from lavendersim.figures.style import DARK, GREY, LOOKS
from lavendersim.geometry.periodic_cell import faces_of_cell, in_cell
from lavendersim.geometry.rotations import rotation_matrices, rotation_matrix
from lavendersim.geometry.shapes import half_space, pieces
from lavendersim.measures.changes import removals

WIDTH, HEIGHT, DPI = 1.6, 1.1, 100  # inch, inch, dots per inch: 160 x 110 dots
MARGIN = 0.08  # of the picture, on every side
BEFORE, FIXED = "#e8e8e8", "#bbbbbb"  # where bodies began; what never moves
AROUND = "none"  # a cavity, which is around the bodies
MOST_TRIANGLES: Final = 1500  # of a mesh that are drawn one by one
AROUND_IT: Final = 48  # corners of its circles
NOTHING: Final = np.array([[-1.0, 0.0], [1.0, 1.0]])  # a picture without bodies
MOST_BODIES = 3000  # of a larger scene the first ones; more are less than a dot each


def thumbnail(trace: Any, dpi: int = DPI) -> bytes:
    """Return the picture [PNG] of the last state of a log whose numbers are all finite.

    dpi: dots per inch; the picture is WIDTH x HEIGHT inches.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.collections import PolyCollection
    from matplotlib.figure import Figure

    view = view_of(trace)
    outlines, colours, seen = _outlines(trace, *view)
    figure = Figure(figsize=(WIDTH, HEIGHT), dpi=dpi)
    FigureCanvasAgg(figure)  # without pyplot, nothing else gives the figure one
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    cell = cell_of(trace, *view)
    low, high = _bounds(seen, cell)
    size = max(float((high - low)[0]), float((high - low)[1]) * WIDTH / HEIGHT, 1e-9)
    middle, half = (low + high) / 2, size * (0.5 + MARGIN)
    axes.set_xlim(middle[0] - half, middle[0] + half)
    axes.set_ylim(middle[1] - half * HEIGHT / WIDTH, middle[1] + half * HEIGHT / WIDTH)
    lines = [(line, "-") for line in grounds_of(trace, *view)] + [(line, ":") for line in cell]
    for (start, along), style in lines:
        ends = (
            start + np.outer((-3 * half, 3 * half), along) + np.dot(middle - start, along) * along
        )
        axes.plot(ends[:, 0], ends[:, 1], style, color=GREY, linewidth=1.0)
    drawn = PolyCollection(outlines, facecolors=colours, edgecolors=DARK, linewidths=0.3)
    axes.add_collection(drawn)
    file = io.BytesIO()
    # no date and no version in the file: equal logs give equal pictures
    figure.savefig(file, format="png", dpi=dpi, metadata={"Software": None})
    return file.getvalue()


def view_of(trace: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return the directions of the picture's right and of its up."""
    bodies = trace.config.scene.bodies
    movable = [i for i, name in enumerate(trace.bodies) if not bodies[name].fixed]
    centres = trace.recorded_pose.pose[:1, movable, :3].reshape(-1, 3)  # none, where none is there
    gravity = np.asarray(trace.config.scene.gravity)
    pull = math.hypot(*gravity)
    up = -gravity / pull if pull > 0.0 else np.array([0.0, 0.0, 1.0])
    level = np.array([1.0, 0.0, 0.0]) - up[0] * up
    if math.hypot(*level) < 0.1:
        level = np.array([0.0, 1.0, 0.0]) - up[1] * up
    level /= math.hypot(*level)
    other = np.cross(up, level)
    spread = np.ptp(centres, axis=0) if len(centres) else np.zeros(3)
    # only where it is plainly more: a scene along x is seen from the side, as it is written
    wider = abs(spread @ np.abs(other)) > 1.5 * abs(spread @ np.abs(level))
    return (other if wider else level), up


def _outlines(
    trace: Any, right: np.ndarray, up: np.ndarray
) -> tuple[list[np.ndarray], list[str], np.ndarray]:
    """Return outlines, those of the start first, then the farthest, their colours, what is seen.

    What was removed is seen where it began, and not at the end.
    """
    rows, poses = trace.recorded_pose
    poses = in_cell(poses, trace.config.scene.periodic)
    whole = np.flatnonzero(np.isfinite(poses).all(axis=(1, 2)))
    bodies = [trace.config.scene.bodies[name] for name in trace.bodies]
    solid = [i for i, body in enumerate(bodies) if not isinstance(body.shape, Plane)][:MOST_BODIES]
    movable = {i for i in solid if not bodies[i].fixed}
    outlines: list[np.ndarray] = []
    colours: list[str] = []
    if len(whole) == 0:
        return outlines, colours, NOTHING
    start, end = poses[whole[0]], poses[whole[-1]]
    last = rows[whole[-1]]
    gone = {list(trace.bodies).index(n) for n, row in removals(trace).items() if row <= last}
    far = np.cross(up, right)
    for pose, is_end in ((start, False), (end, True)):
        turns = rotation_matrices(pose[:, 3:])
        for i in sorted(solid, key=lambda i: -float(pose[i, :3] @ far)):
            if (i in movable or is_end) and not (is_end and i in gone):
                own = LOOKS[i % len(LOOKS)].colour if is_end else BEFORE
                for part in parts_of(bodies[i].shape):
                    corners = pose[i, :3] + part @ turns[i].T
                    outlines.append(_hull(np.column_stack([corners @ right, corners @ up])))
                    colours.append(own if i in movable else colour_of(bodies[i].shape))
    return outlines, colours, np.concatenate(_seen(outlines, colours) or [NOTHING])


def colour_of(shape: CellShape) -> str:
    """Return the colour of a body that nothing moves."""
    around = isinstance(shape, CellMesh) and len(shape.triangles) > MOST_TRIANGLES
    return AROUND if around or isinstance(shape, Cavity) else FIXED


def _seen(outlines: list[np.ndarray], colours: list[str]) -> list[np.ndarray]:
    """Return what must lie in the picture: all that can move, where it began and where it ended.

    And what is around it.
    """
    return [one for one, colour in zip(outlines, colours, strict=True) if colour != FIXED]


def grounds_of(
    trace: Any, right: np.ndarray, up: np.ndarray
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return a point and a direction of every plane that is seen edge on."""
    found = []
    for name in trace.bodies:
        shape = trace.config.scene.bodies[name].shape
        if not isinstance(shape, Plane):
            continue
        found += _edge_on(*half_space(shape), right, up)
    return found


def cell_of(trace: Any, right: np.ndarray, up: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return a point and a direction of every face of a periodic cell that is seen edge on."""
    faces = faces_of_cell(trace.config.scene.periodic)
    return [line for normal, offset in faces for line in _edge_on(normal, offset, right, up)]


def _edge_on(
    normal: np.ndarray, offset: float, right: np.ndarray, up: np.ndarray
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the line as which a plane is seen, if it is seen edge on."""
    flat = np.array([normal @ right, normal @ up])
    return [(flat * offset, np.array([-flat[1], flat[0]]))] if math.hypot(*flat) > 0.99 else []


def _bounds(
    seen: np.ndarray, lines: list[tuple[np.ndarray, np.ndarray]]
) -> tuple[np.ndarray, np.ndarray]:
    """Return the bounds of what is seen and of lines, each where it is nearest to its middle."""
    middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
    near = [start + np.dot(middle - start, along) * along for start, along in lines]
    points = np.concatenate([seen, np.reshape(near, (-1, 2))])
    return points.min(axis=0), points.max(axis=0)


def parts_of(shape: CellShape) -> list[np.ndarray]:
    """Return points (n, 3) in the body's frame [m] whose convex hulls are what is drawn.

    Of a mesh its triangles, of one of very many their hull.
    """
    if not isinstance(shape, CellMesh) or len(shape.triangles) > MOST_TRIANGLES:
        return [corners_of(shape)]
    return list(np.array(shape.vertices)[np.array(shape.triangles)])


@lru_cache(maxsize=256)
def corners_of(shape: CellShape) -> np.ndarray:
    """Return points (n, 3) in the body's frame [m] whose convex hull is the shape, or nearly.

    Of a cavity what it is around, of a drum as much as it is wide.
    """
    if isinstance(shape, Cavity):
        return _inside(shape)
    if isinstance(shape, CellMesh):
        return np.array(shape.vertices)[np.unique(shape.triangles)]
    placed = [
        piece.position + _round_or_not(piece.shape) @ rotation_matrix(piece.orientation).T
        for piece in pieces(shape)
    ]
    return np.concatenate(placed)


def _inside(cavity: Cavity) -> np.ndarray:
    """Return points (n, 3) of circles so fine that what lies at the wall does not cross it [m]."""
    turn = np.linspace(0.0, 2.0 * np.pi, AROUND_IT, endpoint=False)
    circle = np.column_stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)])
    up = np.array([0.0, 0.0, 1.0])
    if isinstance(cavity, Bowl):
        tilts = np.linspace(-0.5 * np.pi, 0.5 * np.pi, AROUND_IT // 2 + 1)
        circles = [np.cos(tilt) * circle + np.sin(tilt) * up for tilt in tilts]
    else:
        circles = [circle - up, circle + up]
    return np.concatenate(circles) * cavity.radius


def _round_or_not(shape: Convex) -> np.ndarray:
    """Return points (n, 3) of a solid [m]; many of an ellipsoid, whose ends are sharply curved."""
    if not isinstance(shape, Ellipsoid):
        return np.asarray(shape.corners())
    turn = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)
    circle = np.column_stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)])
    return np.concatenate([np.roll(circle, k, axis=1) for k in range(3)]) * shape.semi_axes


def _hull(points: np.ndarray) -> np.ndarray:
    """Return the corners of the convex hull of points in a plane, in order (monotone chain)."""
    ordered = points[np.lexsort((points[:, 1], points[:, 0]))]

    def chain(rows: np.ndarray) -> list[np.ndarray]:
        kept: list[np.ndarray] = []
        for row in rows:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], row) <= 0.0:
                kept.pop()
            kept.append(row)
        return kept[:-1]

    return np.array(chain(ordered) + chain(ordered[::-1]) or ordered[:1])


def _turn(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
