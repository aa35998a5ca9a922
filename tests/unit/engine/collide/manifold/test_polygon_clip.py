"""Half planes and discs cut polygons and lines where they cross; names are the lines that meet."""

from __future__ import annotations

import convex
import numpy as np
import polygons
import pytest
from interpreted import interpreted, records
from scipy.spatial import ConvexHull
from single_bodies import scratch_of

from lavendersim.engine.collide.manifold import polygon_clip
from lavendersim.engine.collide.manifold.polygon_clip import OTHER, HalfPlane, TiltedDisc
from lavendersim.engine.collide.records import DISC, FACE_LOOP, Feature, Frame
from lavendersim.engine.records import POINT, TOUCHING, dtype
from lavendersim.engine.vectors import Vec3

cut_straight, cut_round, cut_line, cut_polygon, disc_roots, side_of, slope_of, disc_of = (
    interpreted(one)
    for one in (
        polygon_clip.cut_straight,
        polygon_clip.cut_round,
        polygon_clip.cut_line,
        polygon_clip.cut_polygon,
        polygon_clip.disc_roots,
        polygon_clip.side_of,
        polygon_clip.slope_of,
        polygon_clip.disc_of,
    )
)
ROOM = 32
LEVEL = Frame(Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0), Vec3(0.0, 0.0, 1.0))


def rows_of(corners: np.ndarray) -> np.ndarray:
    """Return rows of a polygon whose w rises with u and v, its lines named in order."""
    rows = np.zeros(2 * ROOM, dtype(POINT))
    count = len(corners)
    rows["x"][:count], rows["y"][:count] = corners.T
    rows["z"][:count] = corners @ [0.3, -0.2]
    rows["in_line"][:count] = (np.arange(count) - 1) % count
    rows["out_line"][:count] = np.arange(count)
    return rows


def random_polygon(rng, corners: int = 8) -> np.ndarray:
    points = rng.normal(size=(corners, 2))
    return points[ConvexHull(points).vertices]  # they turn left


def flat(rows: np.ndarray, start: int, count: int) -> np.ndarray:
    return np.column_stack([rows[axis][start : start + count] for axis in "xy"])


def area(loop: np.ndarray) -> float:
    following = np.roll(loop, -1, axis=0)
    return 0.5 * float(np.sum(loop[:, 0] * following[:, 1] - loop[:, 1] * following[:, 0]))


def test_a_half_plane_leaves_what_lies_within_and_adds_two_corners_on_its_line(rng) -> None:
    for start in (0, ROOM):
        for _ in range(40):
            polygon = random_polygon(rng)
            angle, limit = rng.uniform(0, 2 * np.pi), rng.uniform(-1.0, 1.5)
            side = HalfPlane(np.cos(angle), np.sin(angle), limit)
            rows = rows_of(polygon)
            rows[start : start + ROOM] = rows[:ROOM].copy()
            count = cut_straight(records(rows), start, len(polygon), side, OTHER + 5)
            found = rows[ROOM - start : ROOM - start + count]
            over = polygon @ [side.u, side.v] - limit
            kept = polygon[over <= 0.0]
            crossings = 2 if 0 < len(kept) < len(polygon) else 0
            assert count == len(kept) + crossings
            loop = np.column_stack([found["x"], found["y"]])
            np.testing.assert_allclose(found["z"], loop @ [0.3, -0.2], atol=1e-14)
            if not count:
                continue
            assert area(loop) > 0.0
            far = 100.0 * np.array([[0, -1], [0, 1], [-1, 1], [-1, -1]])  # u < 0, turned
            turn = np.array([[side.u, -side.v], [side.v, side.u]])
            half_plane = far @ turn.T + limit * np.array([side.u, side.v])
            assert polygons.are_same(loop, polygons.overlap(polygon, half_plane), 1e-9)
            for k in range(count):  # the line that leaves a corner enters the next
                assert found["out_line"][k] == found["in_line"][(k + 1) % count]
            on_side = np.isclose(loop @ [side.u, side.v], limit, atol=1e-12)
            assert (
                ((found["in_line"] == OTHER + 5) | (found["out_line"] == OTHER + 5)) == on_side
            ).all()


def test_where_there_is_no_room_cutting_stops_and_no_row_beyond_is_written(rng) -> None:
    rows = rows_of(np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float))[:6].copy()
    rows["x"][:3] = 0.0, 1.0, 1.0
    whole = HalfPlane(1.0, 0.0, 9.0)
    assert cut_straight(records(rows), 0, 3, whole, OTHER) == 2  # of a half of three rows


def tilted(rng) -> TiltedDisc:
    u, v = rng.normal(size=2)
    rise = rng.uniform(-0.3, 0.3, 2)
    return TiltedDisc(u, v, *rise, rng.uniform(0.3, 1.5))


def within(disc: TiltedDisc, x, y):
    """How far points of the disc's plane over (x, y) lie inside of its rim [m]."""
    x, y = np.asarray(x) - disc.u, np.asarray(y) - disc.v
    z = disc.rise_u * x + disc.rise_v * y
    return disc.radius - np.sqrt(x * x + y * y + z * z)


def test_a_line_enters_and_leaves_a_disc_at_its_rim(rng) -> None:
    seen = 0
    for _ in range(100):
        disc, ends = tilted(rng), rng.normal(size=(2, 2))
        rows = records(rows_of(ends))
        enters, leaves = disc_roots(rows[0], rows[1], disc)
        if enters >= leaves:
            share = np.linspace(-50.0, 50.0, 20001)
            on = ends[0] + share[:, None] * (ends[1] - ends[0])
            assert within(disc, *on.T).max() < 1e-3
            continue
        seen += 1
        for share in (enters, leaves):
            assert within(disc, *(ends[0] + share * (ends[1] - ends[0]))) == pytest.approx(
                0.0, abs=1e-12
            )
        assert within(disc, *(ends[0] + 0.5 * (enters + leaves) * (ends[1] - ends[0]))) > 0.0
    assert 30 < seen < 100


def test_a_line_without_length_is_inside_or_outside() -> None:
    disc = TiltedDisc(0.0, 0.0, 0.0, 0.0, 1.0)
    for x, inside in ((0.5, True), (1.5, False)):
        rows = records(rows_of(np.array([[x, 0.0], [x, 0.0]])))
        enters, leaves = disc_roots(rows[0], rows[1], disc)
        assert (enters < -1e9 and leaves > 1e9) is inside
        assert (enters > leaves) is not inside


def test_a_disc_leaves_corners_within_it_and_crossings_of_its_rim(rng) -> None:
    seen = 0
    for _ in range(60):
        polygon, disc = random_polygon(rng), tilted(rng)
        rows = rows_of(polygon)
        count = cut_round(records(rows), len(polygon), disc)
        found = rows[ROOM : ROOM + count]
        loop = np.column_stack([found["x"], found["y"]])
        expected = [p for p in polygon if within(disc, *p) >= 0.0]
        for k, p in enumerate(polygon):
            way = polygon[(k + 1) % len(polygon)] - p
            share = np.linspace(0.0, 1.0, 4001)
            depth = within(disc, *(p + share[:, None] * way).T)
            for i in np.flatnonzero(np.diff(np.sign(depth))):
                t = share[i] - depth[i] * (share[i + 1] - share[i]) / (depth[i + 1] - depth[i])
                expected.append(p + t * way)
        assert polygons.are_same(loop, np.array(expected).reshape(-1, 2), 1e-5)
        if not count:
            continue
        seen += 1
        np.testing.assert_allclose(found["z"], loop @ [0.3, -0.2], atol=1e-12)
        on_rim = np.abs(within(disc, *loop.T)) < 1e-9
        assert (((found["in_line"] == OTHER) | (found["out_line"] == OTHER)) == on_rim).all()
    assert seen > 20


def test_the_side_of_a_loop_is_its_inside_whichever_way_it_turns(rng) -> None:
    outline = scratch_of([]).outline_a
    for turn in (1.0, -1.0):
        polygon = random_polygon(rng, 6)
        polygon = polygon if turn > 0.0 else polygon[::-1]
        count, middle = min(len(polygon), 8), polygon.mean(axis=0)
        for k, p in enumerate(polygon):
            outline.corners[k].x, outline.corners[k].y, outline.corners[k].z = *p, rng.normal()
        for k in range(count):
            side = side_of(outline.corners, count, k, turn, LEVEL)
            n = np.array([side.u, side.v])
            assert np.linalg.norm(n) == pytest.approx(1.0, abs=1e-14)
            assert n @ polygon[k] - side.limit == pytest.approx(-TOUCHING, abs=1e-14)
            assert n @ polygon[(k + 1) % count] - side.limit == pytest.approx(-TOUCHING, abs=1e-14)
            assert n @ middle < side.limit


def test_a_plane_rises_and_a_cap_is_seen_along_any_frame(rng) -> None:
    for _ in range(20):
        outline, matrix = scratch_of([]).outline_a, convex.random_rotation(rng)
        frame = Frame(*(Vec3(*axis) for axis in matrix))
        normal, centre, plane = rng.normal(size=3), rng.normal(size=3), outline.plane[0]
        normal /= np.linalg.norm(normal)
        plane.nx, plane.ny, plane.nz = normal
        plane.x, plane.y, plane.z = centre
        plane.radius = 0.7
        rise = slope_of(plane, frame)
        for u, v in rng.normal(size=(3, 2)):
            on = np.array([u, v, rise[0] * u + rise[1] * v]) @ matrix
            assert on @ normal == pytest.approx(0.0, abs=1e-12 * (1 + np.abs(rise).max()))
        disc = disc_of(outline, frame)
        np.testing.assert_allclose((disc.u, disc.v), (matrix @ centre)[:2], atol=1e-14)
        assert (disc.rise_u, disc.rise_v) == rise
        assert disc.radius == pytest.approx(0.7 + TOUCHING, abs=1e-16)


def loop_in(outline, polygon) -> Feature:
    for k, p in enumerate(polygon):
        outline.corners[k].x, outline.corners[k].y, outline.corners[k].z = *p, 0.0
    return Feature(FACE_LOOP, len(polygon), 0)


def cap_in(outline, disc: TiltedDisc) -> Feature:
    n = np.array([-disc.rise_u, -disc.rise_v, 1.0])
    n /= np.linalg.norm(n)
    plane = outline.plane[0]
    plane.nx, plane.ny, plane.nz = n
    plane.x, plane.y, plane.z, plane.radius = disc.u, disc.v, 0.0, disc.radius
    return Feature(DISC, 8, 0)


def test_a_polygon_is_cut_by_every_side_of_a_loop(rng) -> None:
    for _ in range(30):
        outline, one, other = scratch_of([]).outline_a, random_polygon(rng), random_polygon(rng, 5)
        rows = rows_of(one)
        start, count = cut_polygon(
            records(rows), len(one), outline, loop_in(outline, other), 1.0, LEVEL
        )
        # Cut TOUCHING outside of the sides: where they meet at a sharp angle a few times as far.
        assert polygons.are_same(flat(rows, start, count), polygons.overlap(one, other), 1e-7)


def test_a_line_keeps_the_piece_over_the_outline(rng) -> None:
    """Shares of the line, tried one by one: the first and the last that lie over the outline."""
    seen = 0
    for trial in range(60):
        outline, ends = scratch_of([]).outline_a, 1.5 * rng.normal(size=(2, 2))
        share = np.linspace(0.0, 1.0, 2001)
        on = ends[0] + share[:, None] * (ends[1] - ends[0])
        if trial % 2:
            disc = tilted(rng)
            feature, over = cap_in(outline, disc), within(disc, *on.T) >= 0.0
        else:
            polygon = random_polygon(rng, 6)
            feature, over = (
                loop_in(outline, polygon),
                np.array([polygons.inside(p, polygon) for p in on]),
            )
        rows = rows_of(ends)
        count = cut_line(records(rows), outline, feature, 1.0, LEVEL)
        if not count:
            assert over.sum() <= 1
            continue
        seen += 1
        length = np.linalg.norm(ends[1] - ends[0])
        found = flat(rows, ROOM, 2)
        low, high = np.flatnonzero(over)[[0, -1]] if over.any() else (0, 0)
        if over.any():
            np.testing.assert_allclose(found, on[[low, high]], atol=length / 1900)
        np.testing.assert_allclose(rows["z"][ROOM : ROOM + 2], found @ [0.3, -0.2], atol=1e-12)
        names = rows["in_line"][ROOM : ROOM + 2]
        assert (names[0] == 0) == (low == 0)
        assert (names[1] == 1) == (high == 2000)
        if feature.kind == FACE_LOOP:
            for point, name in zip(found, names, strict=True):
                if name >= OTHER:  # on the side it is named after
                    p, q = polygon[name - OTHER], polygon[(name - OTHER + 1) % len(polygon)]
                    d, to = (q - p) / np.linalg.norm(q - p), point - p
                    assert abs(d[0] * to[1] - d[1] * to[0]) < 2 * TOUCHING
    assert seen > 15
