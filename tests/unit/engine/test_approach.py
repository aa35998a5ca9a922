"""Approach speeds are those of rigid bodies' points, and bounds hold for all points of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import drawn, views
from interpreted import interpreted, records
from plain_facts import one_row, vector_fields

from lavendersim.engine import approach
from lavendersim.engine.records import MOTION, PLANE, SPHERE, dtype
from lavendersim.engine.spec import Spec

TURNS = Spec(effects=("friction", "impact_order", "rotation"))
STILL = Spec(effects=("impact_order",))


def vector(row: Any, prefix: str) -> np.ndarray:
    return np.array([row[f"{prefix}{axis}"] for axis in "xyz"])


def write(row: Any, prefix: str, values: Any) -> None:
    for axis, value in zip("xyz", values, strict=True):
        row[f"{prefix}{axis}"] = value


def scene_of(rng: np.random.Generator, spec: Spec = TURNS) -> Any:
    """Return rows of two bodies' motion, the bodies, and a contact between them."""
    scene = drawn(TURNS, rng, [(0, 1)], fixed=())
    motion = np.zeros(2, dtype(MOTION))
    for m, v in zip(motion, scene.velocities, strict=True):
        for prefix in ("v", "w"):
            write(m, prefix, vector(v, prefix))
        for prefix in ("dv", "ahead_"):
            write(m, prefix, rng.normal(size=3))
    scene.bodies["shape"] = SPHERE
    scene.bodies["bound"] = rng.uniform(0.5, 2.0, 2)
    bodies, _, contacts = views(scene)
    return scene, contacts[0], bodies, records(motion)


def test_the_gap_changes_at_the_speed_of_the_points_along_the_normal(rng) -> None:
    """The row of the Jacobian times the velocities; without rotation times their linear part."""
    scene, contact, bodies, motion = scene_of(rng)
    expected = scene.jacobian[0] @ scene.motion
    found = interpreted(approach.make_approach(TURNS))(contact, bodies, motion)
    assert found == pytest.approx(expected, abs=1e-14)
    straight = scene.motion * np.tile([1, 1, 1, 0, 0, 0], 2)
    found = interpreted(approach.make_approach(STILL))(contact, bodies, motion)
    assert found == pytest.approx(scene.jacobian[0] @ straight, abs=1e-14)


def test_forces_and_what_lies_ahead_change_it_by_their_part_along_the_normal(rng) -> None:
    _, contact, _, motion = scene_of(rng)
    n = vector(contact, "n")
    of_a, of_b = (n @ vector(m, "dv") for m in motion)
    found = interpreted(approach.make_forced(TURNS))(contact, motion)
    assert found == pytest.approx((of_b - of_a, abs(of_a) + abs(of_b)), abs=1e-15)
    of_a, of_b = (n @ vector(m, "ahead_") for m in motion)
    found = interpreted(approach.make_change_ahead(TURNS))(contact, motion)
    assert found == pytest.approx(of_b - of_a, abs=1e-15)


def points_of(body: Any, rng: np.random.Generator) -> np.ndarray:
    """Return arms to points within the bounding sphere, the farthest among them."""
    arms = rng.normal(size=(2000, 3))
    return arms / np.linalg.norm(arms, axis=1)[:, None] * body.bound


def test_bounds_hold_for_all_points_and_are_reached_by_some(rng) -> None:
    """v_B - v_A at any two points: no faster than the bound, and nowhere nearer along n."""
    speed = interpreted(approach.make_relative_speed(TURNS))
    nearest = interpreted(approach.make_nearest_rate(TURNS))
    turning = interpreted(approach.make_turning(TURNS))
    for _ in range(5):
        _, contact, bodies, motion = scene_of(rng)
        n, straight = vector(contact, "n"), vector(motion[1], "v") - vector(motion[0], "v")
        spins = [
            np.cross(vector(m, "w"), points_of(body, rng))
            for m, body in zip(motion, bodies, strict=True)
        ]
        fastest = [np.linalg.norm(spin, axis=1).max() for spin in spins]
        found = turning(contact, bodies, motion)
        # Of 2,000 points one is within some 3 degrees of the equator.
        assert sum(fastest) <= found <= sum(fastest) / 0.99
        relative = straight + spins[1] - spins[0]
        assert np.linalg.norm(relative, axis=1).max() <= speed(contact, bodies, motion)
        assert (relative @ n).min() >= nearest(contact, bodies, motion)
        limit = np.linalg.norm(straight) + found
        assert speed(contact, bodies, motion) == pytest.approx(limit, rel=1e-14)
        assert nearest(contact, bodies, motion) == pytest.approx(n @ straight - found, abs=1e-14)
        slow = interpreted(approach.make_slowest(TURNS))(contact, bodies, motion)
        assert slow == pytest.approx(1e-7 + 1e-9 * limit, rel=1e-12)


@pytest.mark.parametrize("scale", [1e-10, 1e-8, 2e-8, 1e-7, 1.0])
def test_of_what_is_still_no_two_points_move_as_fast_as_counts(rng, scale) -> None:
    """Speeds of points add up to 2 sqrt(2) of the speed up to which a body is still, a quarter."""
    is_still = interpreted(approach.make_is_still(TURNS))
    speed = interpreted(approach.make_relative_speed(TURNS))
    for _ in range(40):
        _, contact, bodies, motion = scene_of(rng)
        for m in motion:
            for prefix in ("v", "w"):
                write(m, prefix, scale * vector(m, prefix))
        still = is_still(bodies, motion)
        assert not still or speed(contact, bodies, motion) <= approach.CREEP
        assert still or scale > 1e-9
        assert not still or scale < 1e-7


def test_a_plane_that_turns_is_not_still() -> None:
    is_still = interpreted(approach.make_is_still(TURNS))
    plane = one_row(shape=PLANE, bound=0.0)
    for spin in (0.0, 1e-12):
        motion = one_row(**vector_fields("v", (0, 0, 0)), **vector_fields("w", (0, spin, 0)))
        assert is_still([plane], np.array([motion])) == (spin == 0.0)


def test_a_plane_has_no_size_but_an_arm(rng) -> None:
    _, contact, bodies, motion = scene_of(rng)
    write(motion[1], "w", (0.0, 0.0, 0.0))
    bodies[0].shape = PLANE
    arm = np.linalg.norm(vector(contact, "") - vector(bodies[0], ""))
    expected = arm * np.linalg.norm(vector(motion[0], "w"))
    found = interpreted(approach.make_turning(TURNS))(contact, bodies, motion)
    assert found == pytest.approx(expected, rel=1e-14)
    assert interpreted(approach.make_turning(STILL))(contact, bodies, motion) == 0.0


def test_the_gap_of_two_balls_bends_no_faster_than_the_bound() -> None:
    """Two balls pass by: d = |c + v t| - 2 r, d'' = v^2/|c| at the nearest, centres 2 r apart."""
    gap_acceleration = interpreted(approach.make_gap_acceleration(STILL))
    radius, speed = 0.5, 3.0
    bodies = [one_row(shape=SPHERE, bound=radius)] * 2
    zero = {**vector_fields("w", (0, 0, 0))}
    motion = [one_row(**vector_fields("v", v), **zero) for v in ((0, 0, 0), (speed, 0, 0))]
    contact = one_row(a=0, b=1)
    found = gap_acceleration(contact, bodies, motion)
    assert found == pytest.approx(speed**2 / radius, rel=1e-15)
    h, c = 1e-4, np.array([0.0, 2.0 * radius])
    gaps = [np.linalg.norm(c + np.array([speed * t, 0.0])) for t in (-h, 0.0, h)]
    assert (gaps[0] - 2.0 * gaps[1] + gaps[2]) / h**2 <= found
    # Past a plane: its normal stays, and without a spin nothing bends.
    plane = one_row(shape=PLANE, bound=0.0, **vector_fields("", (0, 0, 0)))
    bodies, contact = [plane, bodies[0]], one_row(a=0, b=1, **vector_fields("", (0.0, 0.0, 0.0)))
    assert gap_acceleration(contact, bodies, motion) == 0.0
    motion[1] = one_row(**vector_fields("v", (speed, 0, 0)), **vector_fields("w", (0, 2.0, 0)))
    turned = interpreted(approach.make_gap_acceleration(TURNS))(contact, bodies, motion)
    assert turned == pytest.approx(2.0 * (speed + 2.0 * radius), rel=1e-15)


@pytest.mark.parametrize(
    ("phi", "rate", "held"), [(0.0, 0.0, True), (0.01, 0.0, False), (0.0, -0.1, False)]
)
def test_what_touches_is_expected_to_accelerate_as_before(phi, rate, held, rng) -> None:
    """What is held by its contacts gets a dt of the last part, all else what forces give."""
    scene, contact, bodies, motion = scene_of(rng)
    contact.phi, contact.rate = phi, rate
    for body in bodies:
        write(body, "a", rng.normal(size=3))
    bodies[0].inv_m = 0.0
    left = 0.02
    expect = interpreted(approach.make_expect(TURNS))
    expect(records(scene.contacts), 1, bodies, motion, left)
    np.testing.assert_array_equal(vector(motion[0], "ahead_"), vector(motion[0], "dv"))
    expected = vector(bodies[1], "a") * left if held else vector(motion[1], "dv")
    np.testing.assert_array_equal(vector(motion[1], "ahead_"), expected)


def test_an_acceleration_is_noted_of_parts_of_some_length(rng) -> None:
    scene, _, bodies, motion = scene_of(rng)
    note = interpreted(approach.make_note_acceleration(TURNS))
    _, velocities, _ = views(scene)
    for v in velocities:
        write(v, "v", rng.normal(size=3))
    note(bodies, velocities, motion, one_row(dt=1e-9, timestep=0.01))
    assert not scene.bodies["ax"].any()
    note(bodies, velocities, motion, one_row(dt=0.005, timestep=0.01))
    for body, v, m in zip(bodies, velocities, motion, strict=True):
        change = vector(v, "v") - vector(m, "v")
        np.testing.assert_allclose(vector(body, "a"), change / 0.005, rtol=1e-14)


def test_ends_of_a_rope_that_pass_each_other_go_apart(rng) -> None:
    """phi = L - |d| of bodies that move and turn freely: differenced twice, to h^2 and 1e-16/h^2.

    A turn by w t of an arm goes by Rodrigues' formula.
    """

    def turned(arm: np.ndarray, w: np.ndarray, t: float) -> np.ndarray:
        angle, axis = np.linalg.norm(w) * t, w / np.linalg.norm(w)
        across = np.cross(axis, arm)
        cosine = np.cos(angle)
        return cosine * arm + np.sin(angle) * across + (1.0 - cosine) * axis * (axis @ arm)

    place, arm, v, w = rng.normal(size=(4, 2, 3))

    def size(t: float) -> float:
        ends = [place[i] + v[i] * t + turned(arm[i], w[i], t) for i in (0, 1)]
        return float(np.linalg.norm(ends[1] - ends[0]))

    h = 1e-4
    expected = -(size(h) - 2.0 * size(0.0) + size(-h)) / h**2
    ends = [one_row(owner=i, **vector_fields("", place[i] + arm[i])) for i in (0, 1)]
    bodies = [one_row(**vector_fields("", place[i])) for i in (0, 1)]
    motion = [one_row(**vector_fields("v", v[i]), **vector_fields("w", w[i])) for i in (0, 1)]
    kernel = interpreted(approach.make_gap_acceleration_of_rope(TURNS))
    assert kernel(*ends, bodies, motion) == pytest.approx(expected, rel=1e-5)


def test_an_edge_is_as_deep_as_the_projection_leaves_what_the_mean_velocity_cuts_short(rng) -> None:
    """A point at arm r goes r (a - a^3/8) along its chord by the mean, which has r (a - a^3/24).

    Of r a^3/12 a step the projection takes a fifth of the depth, by default: 5/12 r a^3 is left.
    """
    _, contact, bodies, motion = scene_of(rng)
    depth = interpreted(approach.make_depth(TURNS))
    spin = np.linalg.norm(vector(motion[contact.b], "w") - vector(motion[contact.a], "w"))
    least = min(bodies[k].bound for k in (contact.a, contact.b))
    dt = 0.3 / spin
    found = depth(contact, bodies, motion, one_row(timestep=dt))
    assert 5.0 / 12.0 * least * 0.3**3 < found < 0.6 * least * 0.3**3
    bodies[contact.a].shape = PLANE
    found = depth(contact, bodies, motion, one_row(timestep=dt))
    assert found == pytest.approx(approach.CUT_SHORT * bodies[contact.b].bound * 0.3**3, rel=1e-12)
    assert depth(contact, bodies, motion, one_row(timestep=1e-3 * dt)) == approach.OVERLAP
    still = interpreted(approach.make_depth(STILL))
    assert still(contact, bodies, motion, one_row(timestep=dt)) == approach.OVERLAP
