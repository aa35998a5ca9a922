"""Fast bodies meet what is on their way, when they do and with the normal there, and nothing else.

Gaps at the meeting are between 0 and TOUCHING; a time is right to TOUCHING over the speed at which
the surfaces close, and round-off of lengths of some metres.
"""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted
from plain_facts import one_row, vector_fields
from sweeps import DT, Pair

from lavendersim.engine.collide.swept import make_is_apart
from lavendersim.engine.records import PLANE, SPHERE, TOUCHING
from lavendersim.engine.spec import Spec
from lavendersim.engine.vectors import Vec3

SPEED, RADIUS = 100.0, 0.05  # [m/s], [m]
WALL = (0.01, 1.0, 1.0)  # half edges [m]: 20 mm thick
ROUND_OFF = 1e-13  # of lengths of some metres [m]
ANY = 100.0  # margin [m]: whatever comes however near


def thrown(start, velocity, pair: str = "sphere_box", half=(RADIUS,), **turns) -> Pair:
    """A sphere of 5 cm, or a box, that starts at `start` on its way to the wall at the origin."""
    return Pair(pair, WALL, half, start, **turns).moves(1, velocity)


@pytest.mark.parametrize("phase", np.arange(64) / 64)
def test_a_sphere_at_100_m_per_s_meets_a_thin_wall_at_every_phase(phase):
    """It moves 1.67 m a step, 83 times the wall. phi = 0 after `time`, and a row that asks for
    v_n >= -phi/dt stops it at the surface."""
    gap = phase * SPEED * DT
    found = thrown((-0.01 - RADIUS - gap, 0.2, -0.3), (SPEED, 0.0, 0.0)).sweep()
    assert found.fast
    np.testing.assert_array_equal(found.normal, (-1.0, 0.0, 0.0))
    assert found.v_n == -SPEED
    assert found.phi == pytest.approx([gap], abs=ROUND_OFF)
    assert found.time == pytest.approx(gap / SPEED, abs=TOUCHING / SPEED)
    # A's surface is at p - n phi/2.
    surface = found.points[0] - 0.5 * found.phi[0] * found.normal
    np.testing.assert_allclose(surface, (-0.01, 0.2, -0.3), rtol=0, atol=ROUND_OFF)


def test_only_balls_that_no_displacement_brings_together_are_apart() -> None:
    """Of 0.2 and 0.3 m, moving by a margin: |x_B - x_A| > 0.2 + 0.3 + 2 x 0.1 m."""
    is_apart = interpreted(make_is_apart(Spec(("fast_bodies",), ("sphere_plane", "sphere_sphere"))))

    def ball(x, bound, shape=SPHERE):
        return one_row(shape=shape, bound=bound, **vector_fields("", (x, 0.0, 0.0)))

    for distance, apart in ((0.6999, False), (0.7001, True)):
        near, far = Vec3(0.0, 0.1, 0.0), Vec3(0.0, 0.1001, 0.0)
        assert is_apart(ball(0.0, 0.2), ball(distance, 0.3), near, 0.1) == apart
        assert is_apart(ball(distance, 0.2), ball(0.0, 0.3), near, 0.1) == apart
        assert not is_apart(ball(0.0, 0.2), ball(distance, 0.3), far, 0.1)
    assert not is_apart(ball(0.0, 0.0, PLANE), ball(9.0, 0.3), near, 0.1)


@pytest.mark.parametrize("angle", np.radians([10.0, 45.0, 80.0]))
def test_an_oblique_sphere_meets_the_wall_where_it_gets_to_it(angle):
    """Both levers are those of the meeting: on A where it lies then, on B the radius along -n."""
    way = SPEED * np.array([np.cos(angle), np.sin(angle), 0.0])
    hit = np.array([-0.01 - RADIUS, 0.3, 0.1])  # centre
    share = 0.6
    pair = thrown(hit - share * DT * way, way)
    found = pair.sweep()
    time_error = TOUCHING / -found.v_n + 1e-16
    assert found.time == pytest.approx(share * DT, abs=time_error)
    assert found.phi[0] == pytest.approx(share * DT * way[0], abs=ROUND_OFF)
    half = 0.5 * found.phi[0] * found.normal
    place_error = SPEED * time_error + TOUCHING
    lever_a = found.points[0] - half
    np.testing.assert_allclose(lever_a, (-0.01, 0.3, 0.1), rtol=0, atol=place_error)
    b, s = np.array([pair.bodies[1][axis] for axis in "xyz"]), pair.relative * found.time
    lever_b = found.points[0] + half - b - (s - found.normal * (found.normal @ s))
    np.testing.assert_allclose(lever_b, -RADIUS * found.normal, rtol=0, atol=place_error)


@pytest.mark.parametrize("shift", [-0.02, -0.001, -1e-6, 1e-6, 0.001, 0.02])
@pytest.mark.parametrize("phase", [0.1, 0.5, 0.9])
def test_a_sphere_beside_the_edge_meets_it_or_passes(shift, phase):
    """Its centre passes r + shift above the wall's top edge (y = 1), which is a line at x = -0.01:
    they meet when |centre - edge| = r, or never."""
    start = np.array([-0.01 - phase * SPEED * DT, 1.0 + RADIUS + shift, 0.0])
    pair = thrown(start, (SPEED, 0.0, 0.0))
    found = pair.sweep()
    if shift > 0.0:
        assert len(found.phi) == 0
        # With a margin it is there, the gap is what it passes by, and it stops nothing.
        near = pair.sweep(ANY)
        assert near.phi[0] == pytest.approx(shift, abs=1e-5)
        assert near.phi[0] + near.v_n * DT >= 0.0
        return
    ahead = np.sqrt(RADIUS**2 - (RADIUS + shift) ** 2)
    closing = -SPEED * ahead / RADIUS
    assert found.time == pytest.approx(phase * DT - ahead / SPEED, abs=TOUCHING / abs(closing))
    # The edge is known to TOUCHING, the way across n to TOUCHING/sin(angle to the edge's tangent).
    error = 2.0 * TOUCHING * SPEED / abs(closing)
    expected = np.array([-ahead, RADIUS + shift, 0.0]) / RADIUS
    np.testing.assert_allclose(found.normal, expected, rtol=0, atol=error / RADIUS)
    assert 0.0 <= found.phi[0] + found.v_n * found.time <= TOUCHING + ROUND_OFF


def test_a_near_miss_has_no_contact_where_the_closest_point_at_the_start_says_hit():
    """The ghost this is for: from 1.5 m away the nearest point of the wall is its edge, and the row
    made there would stop a sphere that passes above by 1 mm."""
    pair = thrown((-1.5, 1.0 + RADIUS + 0.001, 0.0), (SPEED, 0.0, 0.0))
    start = np.array([-1.5 + 0.01, RADIUS + 0.001, 0.0])
    gap, normal = np.linalg.norm(start) - RADIUS, start / np.linalg.norm(start)
    assert gap + pair.relative @ normal * DT < -0.1
    assert len(pair.sweep().phi) == 0


@pytest.mark.parametrize("offset", [0.0, 0.03, 0.0999])
def test_two_fast_spheres_meet_where_the_quadratic_says(offset):
    """|c + v t| = 2 r for centres c apart and relative velocity v."""
    centre = np.array([1.0, offset, 0.0])
    pair = Pair("sphere_sphere", (RADIUS,), (RADIUS,), centre)
    pair.moves(0, (60.0, 5.0, 0.0)).moves(1, (-40.0, 5.0, 0.0))
    found, v = pair.sweep(), pair.relative
    assert found.fast
    along = -centre @ v
    root = np.sqrt(along**2 - (v @ v) * (centre @ centre - 4.0 * RADIUS**2))
    time = (along - root) / (v @ v)
    normal = (centre + v * time) / (2.0 * RADIUS)
    closing = abs(v @ normal)
    assert found.time == pytest.approx(time, abs=TOUCHING / closing)
    # Along the way by TOUCHING/sin of the angle to the normal.
    error = 2.0 * TOUCHING * 100.0 / closing
    np.testing.assert_allclose(found.normal, normal, rtol=0, atol=error / RADIUS)
    assert 0.0 <= found.phi[0] + found.v_n * found.time <= TOUCHING + ROUND_OFF
    half = 0.5 * found.phi[0] * found.normal
    np.testing.assert_allclose(found.points[0] - half, RADIUS * found.normal, rtol=0, atol=TOUCHING)
    s = v * found.time
    lever_b = found.points[0] + half - centre - (s - found.normal * (found.normal @ s))
    np.testing.assert_allclose(lever_b, -RADIUS * found.normal, rtol=0, atol=2.0 * TOUCHING)


def test_two_spheres_that_fly_side_by_side_make_no_contact():
    pair = Pair("sphere_sphere", (RADIUS,), (RADIUS,), (0.0, 0.2, 0.0))
    pair.moves(0, (SPEED, 0.0, 0.0)).moves(1, (SPEED, 0.0, 0.0))
    assert not pair.sweep().fast
    assert len(pair.sweep().phi) == 0


@pytest.mark.parametrize("phase", np.arange(1, 8) / 8)
def test_a_fast_box_meets_a_thin_wall_with_its_whole_face(phase):
    half, gap = (0.1, 0.2, 0.05), phase * SPEED * DT
    start = (-0.01 - 0.1 - gap, 0.3, 0.2)
    found = thrown(start, (SPEED, 0.0, 0.0), "box_box", half).sweep(0.01)
    assert found.fast
    assert len(found.phi) == 4
    np.testing.assert_allclose(found.normal, (-1.0, 0.0, 0.0), rtol=0, atol=1e-15)
    np.testing.assert_allclose(found.phi, gap, rtol=0, atol=2.0 * TOUCHING)
    assert found.time == pytest.approx(gap / SPEED, abs=TOUCHING / SPEED)


def test_a_fast_box_meets_a_thin_wall_with_its_corner():
    """Turned so that a diagonal lies along x: the corner is sqrt(3) h ahead of the centre."""
    u = np.ones(3) / np.sqrt(3.0)
    v = np.array([1.0, -1.0, 0.0]) / np.sqrt(2.0)
    turn = np.stack([u, v, np.cross(u, v)])  # takes the diagonal to x
    h, gap = 0.1, 0.7
    start = (-0.01 - np.sqrt(3.0) * h - gap, 0.0, 0.0)
    found = thrown(start, (SPEED, 0.0, 0.0), "box_box", (h,) * 3, turn_b=turn).sweep(0.001)
    assert found.phi == pytest.approx([gap], abs=2.0 * TOUCHING)
    assert found.time == pytest.approx(gap / SPEED, abs=TOUCHING / SPEED)


def rod_over_the_edge(end, velocity) -> tuple[Pair, np.ndarray]:
    """A rod along (1, 1, 0), one of its long edges towards the upper left edge of a cube.

    The edge's lower end lies at the cube's edge plus `end`; the rod starts half a step before that.
    Returns the pair and the normal of the two edges.
    """
    along, n = np.array([1.0, 1.0, 0.0]) / np.sqrt(2.0), np.array([-1.0, 1.0, 0.0]) / np.sqrt(2.0)
    side = np.array([0.0, 0.0, 1.0])
    turn = np.column_stack([along, (n + side) / np.sqrt(2.0), (side - n) / np.sqrt(2.0)])
    half = np.array([1.0, 0.2, 0.2])
    centre = np.array([-0.5, 0.5, 0.0]) + end + half[0] * along + np.sqrt(2.0) * half[1] * n
    velocity = np.array(velocity)
    pair = Pair("box_box", (0.5,) * 3, half, centre - 0.5 * DT * velocity, turn_b=turn)
    return pair.moves(1, velocity), n


def test_edges_that_meet_have_the_normal_of_edges_where_a_face_is_near():
    """The rod's end is 0.9 mm below the cube's top: a resting manifold looks for points on the top,
    which would not stop a way along it."""
    pair, normal = rod_over_the_edge((-0.0009, -0.0009, 0.0), (SPEED, 0.0, 0.0))
    found = pair.sweep()
    np.testing.assert_allclose(found.normal, normal, rtol=0, atol=1e-6)
    assert found.phi[0] + found.v_n * found.time == pytest.approx(0.0, abs=2.0 * TOUCHING)
    assert found.time == pytest.approx(0.5 * DT, abs=2.0 * TOUCHING / SPEED)


@pytest.mark.parametrize("sine", [0.8, -0.8])
def test_a_manifold_whose_normal_is_not_how_bodies_meet_is_overruled(sine):
    found = thrown((-0.31, 0.0, 0.0), (SPEED, 0.0, 0.0), "box_box", (0.1,) * 3).sweep(sine=sine)
    np.testing.assert_allclose(found.normal, (-1.0, 0.0, 0.0), rtol=0, atol=1e-12)
    assert found.phi == pytest.approx([0.2], abs=2.0 * TOUCHING)


@pytest.mark.parametrize("sine", [0.02, -0.02, 0.8, -0.8])
def test_a_normal_that_is_a_little_askew_does_not_stop_what_passes(sine):
    """A box passes 1 mm above the wall. With the normal 1.1 degrees askew its way of 1.67 m would
    lead 33 mm along it."""
    pair = thrown((-0.5, 1.101, 0.0), (SPEED, 0.0, 0.0), "box_box", (0.1,) * 3)
    found = pair.sweep(0.01, sine=sine)
    assert len(found.phi) == 1
    assert found.phi[0] + found.v_n * DT >= 0.0
    assert found.phi[0] > 0.0


def test_bodies_that_touch_at_the_start_have_the_contact_they_have():
    pair = thrown((-0.01 - RADIUS + 1e-4, 0.0, 0.0), (0.0, SPEED, 0.0))
    found = pair.sweep()
    assert found.time == 0.0
    assert found.phi == pytest.approx([-1e-4], abs=ROUND_OFF)


def test_a_sphere_that_leaves_has_its_contact_within_the_margin_only():
    pair = thrown((-0.01 - RADIUS - 0.1, 0.0, 0.0), (-SPEED, 0.0, 0.0))
    assert len(pair.sweep().phi) == 0
    kept = pair.sweep(0.2)
    assert kept.time == 0.0
    assert kept.phi == pytest.approx([0.1], abs=ROUND_OFF)
