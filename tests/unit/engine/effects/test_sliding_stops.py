"""When a slip vanishes; and which scenes look for it."""

from __future__ import annotations

import math

import pytest
from laboratory import box, plane, planned, resolved, sphere

from lavendersim.engine.approach import NEVER
from lavendersim.engine.effects.sliding_stops import LEFT_OVER, make_vanishes
from lavendersim.engine.spec import Spec
from lavendersim.engine.vectors import Vec3

LEAST, LEFT, SHORTEST = 1e-7, 0.01, 1e-8  # [m/s], [s], [s]


@pytest.fixture(scope="module")
def vanishes():
    kernel = make_vanishes(Spec())

    def when(s: tuple[float, ...], a: tuple[float, ...]) -> float:
        return kernel(Vec3(*s), Vec3(*a), LEAST, LEFT, SHORTEST)

    return when


def test_a_slip_that_its_rate_opposes_vanishes_at_their_ratio(vanishes) -> None:
    assert vanishes((0.03, -0.04, 0.0), (-6.0, 8.0, 0.0)) == pytest.approx(0.005, rel=1e-15)


@pytest.mark.parametrize(
    ("s", "a"),
    [
        ((0.05, 0.0, 0.0), (10.0, 0.0, 0.0)),  # it grows
        ((0.05, 0.0, 0.0), (0.0, 10.0, 0.0)),  # it turns aside
        ((0.05, 0.0, 0.0), (0.0, 0.0, 0.0)),  # it stays
        ((0.05, 0.0, 0.0), (-4.9, 0.0, 0.0)),  # it lasts longer than what is left of the step
        ((0.5 * LEAST, 0.0, 0.0), (-1e-4, 0.0, 0.0)),  # what a solve leaves is none
        ((2.0 * LEAST, 0.0, 0.0), (-100.0, 0.0, 0.0)),  # a part as short tells no rate
    ],
)
def test_what_does_not_vanish_in_the_step_has_no_stop(vanishes, s, a) -> None:
    assert vanishes(s, a) == NEVER


@pytest.mark.parametrize(("share", "stops"), [(0.5, True), (2.0, False)])
def test_a_slip_that_passes_0_at_a_distance_has_no_stop(vanishes, share, stops) -> None:
    """The angle between s and -a: what is least of |s + a t| is |s| sin(angle)."""
    angle = math.asin(share * LEFT_OVER)
    when = vanishes((0.05, 0.0, 0.0), (-10.0 * math.cos(angle), 10.0 * math.sin(angle), 0.0))
    assert (when < NEVER) == stops


def effects(friction: float, **numerics) -> tuple[str, ...]:
    """Return the effects of a box on a floor by the default numerics, but for `numerics`."""
    bodies = {
        "floor": plane(friction=friction),
        "box": box((0.2, 0.2, 0.2), (0.0, 0.0, 0.1), friction=friction),
    }
    default = {"impacts": "in_order", "integrator": "midpoint_contact"}
    return planned(resolved(bodies, (0.0, 0.0, -9.81), **(default | numerics))).spec.effects


def test_it_is_there_where_something_slides_and_a_step_has_parts() -> None:
    assert "sliding_stops" in effects(0.5)
    assert "sliding_stops" not in effects(0.0)
    assert "sliding_stops" not in effects(0.5, impacts="at_surface")
    assert "sliding_stops" not in effects(0.5, integrator="midpoint")


@pytest.mark.parametrize(
    ("gravity", "friction", "parts"),
    [
        ((0.0, 0.0, -9.81), 0.5, False),  # nothing drives the ball along the floor
        ((3.0, 0.0, -9.0), 0.5, True),
        ((3.0, 0.0, -9.0), 0.0, False),  # nothing changes where it turns round
    ],
)
def test_one_ball_on_one_plane_has_parts_where_it_may_slide_back(gravity, friction, parts) -> None:
    bodies = {
        "floor": plane(friction=friction),
        "ball": sphere(0.1, (0.0, 0.0, 0.1), friction=friction),
    }
    numerics = {"impacts": "in_order", "integrator": "midpoint_contact"}
    found = planned(resolved(bodies, gravity, **numerics)).spec.effects
    assert ("impact_order" in found, "sliding_stops" in found) == (parts, parts)


def test_gravity_along_the_normal_of_a_tilted_plane_drives_nothing() -> None:
    n = (math.sin(0.3), 0.0, math.cos(0.3))
    bodies = {"floor": plane(n, friction=0.5), "ball": sphere(0.1, (0.0, 0.0, 1.0), friction=0.5)}
    numerics = {"impacts": "in_order", "integrator": "midpoint_contact"}
    gravity = tuple(-9.81 * part for part in n)
    assert "impact_order" not in planned(resolved(bodies, gravity, **numerics)).spec.effects
