"""Fat bounds hold a body for as long as `is_valid` says so, and are no fatter than documented."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from broad_phase_scenes import BODY_RECORD, half_extents
from interpreted import interpreted, records

from lavendersim.engine.collide.broad.fat_bounds import (
    FAT_BOUNDS,
    SHARE,
    STEPS,
    make_is_valid,
    make_place_bounds,
)
from lavendersim.engine.record_layout import allocate_parameters
from lavendersim.engine.records import (
    ANGULAR_VELOCITY,
    BOX,
    COMPOUND,
    PLANE,
    SPHERE,
    TOUCHING,
    VELOCITY,
    dtype,
)
from lavendersim.engine.spec import Spec

DT = 0.01  # [s]
SHAPES = ("box_plane", "sphere_plane")


class Bodies:
    """Boxes of half edges 0.3, 0.2, 0.1 m, turned, at rest and without gravity."""

    def __init__(self, count: int, *effects: str) -> None:
        spec = Spec(tuple(sorted(("rotation", *effects))), SHAPES)
        self.place, self.valid = (
            interpreted(make(spec)) for make in (make_place_bounds, make_is_valid)
        )
        self.rows, self.fat = np.zeros(count, BODY_RECORD), np.zeros(count, dtype(FAT_BOUNDS))
        self.velocities = np.zeros(count, dtype(VELOCITY, ANGULAR_VELOCITY))
        self.parameters = allocate_parameters()
        self.parameters["dt"], self.rows["inv_m"] = DT, 1.0
        rng = np.random.default_rng(11)
        for i, row in enumerate(self.rows):
            row["shape"], row["owner"], row["bound"] = BOX, i, np.sqrt(0.14)
            row["hx"], row["hy"], row["hz"] = 0.3, 0.2, 0.1
            row["x"], row["y"], row["z"] = rng.normal(size=3)
            for k, value in enumerate(convex.random_rotation(rng).ravel()):
                row[f"r{k // 3}{k % 3}"] = value

    def _arguments(self):
        return *map(records, (self.rows, self.velocities)), records(self.parameters)[0]

    def bounds(self):
        self.place(*self._arguments(), records(self.fat))
        return self

    def is_valid(self) -> bool:
        return self.valid(*self._arguments(), records(self.fat))

    def centre(self, i: int, fat: bool = False) -> np.ndarray:
        return np.array([(self.fat if fat else self.rows)[i][axis] for axis in "xyz"])

    def half(self, i: int) -> np.ndarray:
        return np.array([self.fat[i][name] for name in ("ex", "ey", "ez")])


@pytest.mark.parametrize("speed", [0.1, 3.0])
def test_bounds_are_the_shape_grown_by_reach_and_slack(speed: float) -> None:
    """slack = min(R/4, 8 reach): one term for each speed. All are as fast, so none is followed."""
    bodies = Bodies(3)
    bodies.velocities["vy"] = speed
    bodies.bounds()
    reach, bound = speed * DT, np.sqrt(0.14)
    grown = reach + TOUCHING + min(SHARE * bound, STEPS * reach)
    for i in range(3):
        np.testing.assert_array_equal(bodies.centre(i, fat=True), bodies.centre(i))
        expected = half_extents(bodies.rows[i]) + grown
        np.testing.assert_allclose(bodies.half(i), expected, rtol=1e-14)
        assert bodies.fat["radius"][i] == pytest.approx(grown, rel=1e-14)


def test_one_fast_body_of_many_is_followed_along_its_velocity() -> None:
    """One of 64 flies 0.3 m a step: the bounds lie around half of its next eight steps."""
    bodies = Bodies(64)
    velocity = np.array([20.0, -20.0, 10.0])  # 30 m/s
    for axis, value in zip("xyz", velocity, strict=True):
        bodies.velocities[f"v{axis}"][5] = value
    bodies.bounds()
    half_way, grown = 0.5 * STEPS * DT * velocity, 30 * DT + TOUCHING + SHARE * np.sqrt(0.14)
    np.testing.assert_allclose(bodies.centre(5, fat=True), bodies.centre(5) + half_way, rtol=1e-14)
    expected = half_extents(bodies.rows[5]) + grown + np.abs(half_way)
    np.testing.assert_allclose(bodies.half(5), expected, rtol=1e-14)
    radius = grown + np.linalg.norm(half_way)
    assert bodies.fat["radius"][5] == pytest.approx(radius, rel=1e-14)
    start = bodies.centre(5)
    for step in range(int(STEPS) + 1):  # and it stays in them for so many steps
        for axis, value in zip("xyz", start + step * DT * velocity, strict=True):
            bodies.rows[axis][5] = value
        assert bodies.is_valid()


def test_two_fast_bodies_of_64_are_not_followed() -> None:
    bodies = Bodies(64)
    bodies.velocities["vx"][:2] = 30.0
    bodies.bounds()
    for i in range(2):
        np.testing.assert_array_equal(bodies.centre(i, fat=True), bodies.centre(i))


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_body_may_use_up_its_slack_and_no_more(axis: int, side: float) -> None:
    """At 0.1 m/s slack is 8 mm; along one axis the box and the sphere end there alike."""
    bodies = Bodies(1)
    bodies.velocities["vz"] = 0.1
    bodies.bounds()
    slack, start = STEPS * 0.1 * DT, bodies.rows["xyz"[axis]][0]
    for share, valid in ((0.999, True), (1.001, False)):
        bodies.rows["xyz"[axis]] = start + side * share * slack
        assert bodies.is_valid() is valid


def test_a_diagonal_way_ends_at_the_sphere_before_the_box() -> None:
    bodies = Bodies(1)
    bodies.velocities["vz"] = 0.1
    bodies.bounds()
    slack, start = STEPS * 0.1 * DT, bodies.centre(0)
    for share, valid in ((0.999, True), (1.001, False)):
        for axis, value in zip("xyz", start + share * slack / np.sqrt(3.0), strict=True):
            bodies.rows[axis] = value
        assert bodies.is_valid() is valid


@pytest.mark.parametrize("towards", range(3))
def test_a_body_turned_about_its_centre_leaves_its_box_along_one_axis(towards: int) -> None:
    """Slack is 0.8 mm. The longest edge, 0.1 m longer than the next, takes its place."""
    bodies, other = Bodies(1), (towards + 1) % 3
    bodies.velocities["vz"] = 0.01

    def lay(long: int, middle: int) -> None:
        for axis, along in enumerate((long, middle, 3 - long - middle)):
            for k in range(3):
                bodies.rows[f"r{k}{axis}"] = float(k == along)

    lay(other, towards)
    assert bodies.bounds().is_valid()
    lay(towards, other)
    assert not bodies.is_valid()


def test_a_throw_a_spin_and_what_is_no_number_end_the_list() -> None:
    def thrown(bodies):
        bodies.velocities["vx"][0] = 1.0

    def spun(bodies):
        bodies.velocities["wy"][0] = 3.0

    def lost(bodies):
        bodies.rows["y"][0] = np.nan

    for change in (thrown, spun, lost):
        bodies = Bodies(2)
        bodies.velocities["vz"] = 0.01
        assert bodies.bounds().is_valid()
        change(bodies)
        assert not bodies.is_valid(), change.__name__


def test_planes_and_compounds_have_no_bounds_and_parts_move_with_their_owner() -> None:
    bodies = Bodies(3, "compound")
    bodies.rows["shape"][:2] = PLANE, COMPOUND
    bodies.rows["shape"][2], bodies.rows["owner"][2] = SPHERE, 1
    bodies.rows["bound"][2] = bodies.rows["hx"][2]
    bodies.velocities["vx"][1] = 0.1  # of the compound; what stands at its part's is unused
    bodies.velocities["vx"][2] = 77.0
    bodies.bounds()
    assert not bodies.fat["ex"][:2].any()
    reach = 0.1 * DT
    np.testing.assert_allclose(bodies.half(2), 0.3 + TOUCHING + reach * (1 + STEPS), rtol=1e-14)
    bodies.rows["x"][:2] = 1e9
    assert bodies.is_valid()
