"""What engines are judged by is right: depths, apexes, friction and impacts in closed form."""

from __future__ import annotations

from fractions import Fraction
from math import cos, pi, sqrt

import numpy as np
import pytest

from tests.benchmarks.peers import errors, scenes
from tests.benchmarks.peers.description import Body, Box, Plane, Scene, Sphere
from tests.benchmarks.peers.errors import Track
from tests.benchmarks.peers.geometry import box_box, deepest, matrices
from tests.benchmarks.peers.jacobi import body_rates
from tests.oracle.convex import Box as OracleBox
from tests.oracle.convex import box_box_separation, random_rotation

ROUNDING = 1e-14
UPRIGHT = (1.0, 0.0, 0.0, 0.0)
CUBE = Box((0.2, 0.2, 0.2))
FLOOR = Body(Plane((0.0, 0.0, 1.0), 0.0))


def two(first: Body, second: Body) -> tuple[Scene, np.ndarray]:
    scene = Scene((first, second), 1)
    return scene, np.array([[*b.position, *b.orientation] for b in (first, second)])


def test_overlap_of_stacked_cubes_is_what_they_were_pushed_together_by() -> None:
    scene, poses = two(Body(CUBE, 1.0), Body(CUBE, 1.0, (0.03, -0.02, 0.2 - 1e-5)))
    assert deepest(scene, poses) == pytest.approx(1e-5, abs=ROUNDING)


def test_cubes_that_touch_or_are_apart_do_not_overlap() -> None:
    for gap in (0.0, 1e-9, 1.0):
        scene, poses = two(Body(CUBE, 1.0), Body(CUBE, 1.0, (0.0, 0.0, 0.2 + gap)))
        assert deepest(scene, poses) <= ROUNDING


def test_crossed_edges_overlap_along_their_common_normal() -> None:
    """Two cubes stand on edges that cross at right angles: their half diagonals add."""
    turn_x = (cos(pi / 8), np.sin(pi / 8), 0.0, 0.0)
    turn_y = (cos(pi / 8), 0.0, np.sin(pi / 8), 0.0)
    height = 0.2 * sqrt(2.0) - 1e-4
    scene, poses = two(
        Body(CUBE, 1.0, orientation=turn_x), Body(CUBE, 1.0, (0.0, 0.0, height), turn_y)
    )
    assert deepest(scene, poses) == pytest.approx(1e-4, abs=ROUNDING)


def test_depth_of_boxes_agrees_with_another_algorithm() -> None:
    """On random poses, against the greatest gap of corners over the same set of directions."""
    rng = np.random.default_rng(11)
    for _ in range(200):
        half = rng.uniform(0.05, 0.5, (2, 3))
        turns = [random_rotation(rng), random_rotation(rng)]
        apart = rng.uniform(-0.5, 0.5, 3)
        a, b = (
            OracleBox(centre, turn, h)
            for centre, turn, h in zip((np.zeros(3), apart), turns, half, strict=True)
        )
        depth = box_box(apart[None], (turns[0][None], turns[1][None]), (half[:1], half[1:]))[0]
        assert depth == pytest.approx(-box_box_separation(a, b), abs=1e-13)


def test_spheres_planes_and_boxes_overlap_in_closed_form() -> None:
    ball, block = Body(Sphere(0.1), 1.0, (0.0, 0.0, 0.5)), Body(CUBE, 1.0, (0.0, 0.0, 0.79))
    scene = Scene((FLOOR, ball, block), 1)
    poses = np.array([[*b.position, *b.orientation] for b in scene.movable])
    assert deepest(scene, poses) == pytest.approx(0.0, abs=ROUNDING)
    poses[1, 2] = 0.695  # the block's lower face is at 0.595, the ball reaches to 0.6
    assert deepest(scene, poses) == pytest.approx(0.005, abs=ROUNDING)
    poses[0, 2] = 0.08  # the ball is 0.02 into the floor
    assert deepest(scene, poses) == pytest.approx(0.02, abs=ROUNDING)
    # A cube on its edge reaches sqrt(2) times as far down.
    poses[1] = [0.0, 0.0, 0.11, cos(pi / 8), np.sin(pi / 8), 0.0, 0.0]
    poses[0, :3] = (3.0, 0.0, 1.0)
    assert deepest(scene, poses) == pytest.approx(0.1 * sqrt(2.0) - 0.11, abs=ROUNDING)


def test_among_many_spheres_the_deepest_pair_is_found() -> None:
    rng = np.random.default_rng(5)
    centres = rng.uniform(-1.0, 1.0, (60, 3))
    scene = Scene(tuple(Body(Sphere(0.2), 1.0, tuple(c)) for c in centres), 1)
    away = np.linalg.norm(centres[:, None] - centres, axis=2) + 9.0 * np.eye(60)
    poses = np.column_stack([centres, np.tile(UPRIGHT, (60, 1))])
    assert deepest(scene, poses) == pytest.approx(0.4 - away.min(), abs=ROUNDING)
    scene, poses = two(Body(Sphere(0.2), 1.0), Body(Sphere(0.2), 1.0, (0.399, 0.0, 0.0)))
    assert deepest(scene, poses) == pytest.approx(0.001, abs=ROUNDING)


def track(scene: Scene, positions: np.ndarray) -> Track:
    """One body's positions at every step, upright."""
    count = len(positions)
    poses = np.zeros((count, 1, 7))
    poses[:, 0, :3], poses[:, 0, 3] = positions, 1.0
    return Track(scene, np.arange(count), poses, np.zeros((count, 1, 6)))


def test_apex_of_a_sampled_parabola_is_its_vertex() -> None:
    """z = h e^2 - g t^2 / 2 sampled off its top."""
    scene = scenes.drop(0.8, Fraction(0))
    times = np.arange(-30, 30) / 240.0 + 0.3 / 240.0
    height = 0.64 - 0.5 * scenes.G * times**2 + scenes.RADIUS
    found = track(scene, np.column_stack([0 * height, 0 * height, height]))
    assert errors.apexes(found) == pytest.approx([0.64], abs=ROUNDING)
    assert errors.apex_error(found) < 1e-13


def test_friction_is_read_off_a_box_that_slides_uniformly_faster() -> None:
    scene = scenes.incline(1.2, pi / 5)
    mu, (gx, gy, gz) = 0.43, scene.gravity
    lean = np.array([gx, gy, 0.0])
    acceleration = np.linalg.norm(lean) + mu * gz
    times = np.arange(scene.steps + 1) / 240.0
    way = 0.01 + 0.5 * acceleration * (times - 0.1) ** 2
    found = track(scene, np.outer(way, lean / np.linalg.norm(lean)))
    assert errors.effective_friction(found) == pytest.approx(mu, abs=1e-12)


def test_creep_and_drift_count_from_half_a_second() -> None:
    scene = scenes.incline(0.98, 0.0)
    times = np.arange(scene.steps + 1) / 240.0
    way = np.where(times < 0.5, 1.0, 2e-7 * (times - 0.5))
    found = track(scene, np.outer(way, [0.6, 0.8, 0.0]))
    assert errors.creep(found) == pytest.approx(2e-7, rel=1e-9)
    assert errors.drift(found) == pytest.approx(2e-7 * (times[-1] - 0.5), rel=1e-9)


@pytest.mark.parametrize(
    ("move", "standing"),
    [((0.0, 0.0, -0.09), True), ((0.0, 0.0, -0.11), False), ((0.11, 0.0, 0.0), False)],
)
def test_a_box_stands_while_it_is_near_its_place(
    move: tuple[float, float, float], standing: bool
) -> None:
    """Half an edge of 0.2 m, in any direction."""
    scene = scenes.rest(scenes.CUBE)
    place = np.array([0.0, 0.0, 0.1])
    assert errors.stands(track(scene, np.array([place, place + move]))) is standing


def test_exact_rotation_solves_eulers_equations() -> None:
    """Against Runge-Kutta of order 4 at h = 0.2 ms: its error at 1 rad is below (5 h)^4."""
    moments, spin = np.array(scenes.INERTIA), np.array([0.5, 2.0, 1.5])

    def slope(w: np.ndarray) -> np.ndarray:
        return np.cross(moments * w, w) / moments

    w, h, seen = spin, 2e-4, [spin]
    for step in range(1, 10_001):
        k1 = slope(w)
        k2 = slope(w + 0.5 * h * k1)
        k3 = slope(w + 0.5 * h * k2)
        w = w + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + slope(w + h * k3))
        if step % 1000 == 0:
            seen.append(w)
    exact = body_rates(moments, spin, np.arange(11) * 0.2)
    assert np.abs(exact - seen).max() < 1e-11


def test_exact_rotation_conserves_energy_and_momentum_near_the_separatrix() -> None:
    moments, spin = np.array(scenes.INERTIA), np.array(scenes.SPIN)
    exact = body_rates(moments, spin, np.linspace(0.0, 60.0, 3601))
    for power in (1, 2):
        invariant = (moments**power * exact**2).sum(axis=1)
        assert np.abs(invariant / (moments**power * spin**2).sum() - 1.0).max() < 1e-12
    assert exact[0] == pytest.approx(spin, abs=1e-9)
    assert exact[:, 1].min() < -4.9  # it flips


@pytest.mark.parametrize(
    ("velocity", "spin", "sticks"),
    [((6.0, 0.0, -3.0), (0.0, 0.0, 0.0), False), ((1.0, 0.5, -3.0), (5.0, -10.0, 0.0), True)],
)
def test_oblique_impact_obeys_newton_and_coulomb(
    velocity: tuple[float, float, float], spin: tuple[float, float, float], sticks: bool
) -> None:
    scene = scenes.thrown(velocity, spin)
    after = errors.after_oblique_impact(scene)
    arm = np.array([0.0, 0.0, -scenes.RADIUS])
    slip_before = (np.array(velocity) + np.cross(spin, arm))[:2]
    slip = (after[:3] + np.cross(after[3:], arm))[:2]
    assert after[2] == pytest.approx(-scenes.THROW_E * velocity[2])
    if sticks:
        assert slip == pytest.approx([0.0, 0.0], abs=ROUNDING)
    else:
        change = after[:2] - velocity[:2]
        assert np.linalg.norm(change) == pytest.approx(scenes.THROW_MU * (after[2] + 3.0))
        assert change @ slip_before == pytest.approx(
            -np.linalg.norm(change) * np.linalg.norm(slip_before)
        )
        assert slip @ slip_before > 0.0


def test_rod_end_leaves_the_floor_with_e_times_its_speed() -> None:
    scene = scenes.rod_end()
    rod = scene.movable[0]
    after = errors.after_end_impact(scene, scenes.ROD_LEAN)
    turn = matrices(np.array([rod.orientation]))[0]
    corners = (
        (np.array([[1, 0, 1], [1, 0, -1], [-1, 0, 1], [-1, 0, -1]]) * 0.5)
        @ np.diag(np.array(rod.shape.size))
        @ turn.T
    )
    lowest = corners[np.argmin(corners[:, 2])]
    assert lowest[2] + rod.position[2] == pytest.approx(4.5 * 3.0 / 240.0)
    up = after[2] + np.cross(after[3:], lowest)[2]
    assert up == pytest.approx(scenes.THROW_E * 3.0, rel=1e-13)
    # The angular impulse is the arm times the linear one.
    assert rod.inertia[1] * after[4] == pytest.approx(-lowest[0] * (after[2] + 3.0), rel=1e-13)


def test_scenes_are_those_of_the_table() -> None:
    pyramid = scenes.pyramid(20)
    assert len(pyramid.movable) == 210
    assert len(scenes.pile(1000).movable) == 1000
    for scene in (pyramid, scenes.pile(1000), scenes.tower(30, 1.0), scenes.heavy_on_light(100.0)):
        poses = np.array([[*b.position, *b.orientation] for b in scene.movable])
        assert deepest(scene, poses) <= 1e-15 * len(scene.movable)
