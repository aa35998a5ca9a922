"""Velocities after an impact: closed forms against balances, known cases, and synthetic logs."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.lib.recfunctions as recfunctions
import pytest
from synthetic import GRAVITY, log_of, scene_of

from lavendersim.geometry.bodies import extent_along, inverse_inertia, lowest_point
from lavendersim.measures import evaluate
from lavendersim.measures.impact_forms import velocities_after
from lavendersim.measures.specs import spinning as specs
from tests.oracle.cells import cell

RADIUS, MASS = 0.1, 2.0
FLAT = [0.0, 0.0, 0.0]


def sphere_scene(gravity: float = 0.0, friction: float = 0.3, **changes: Any) -> dict[str, Any]:
    surface = {"restitution": 0.5, "friction": friction}
    ball = {
        "shape": {"kind": "sphere", "radius": RADIUS},
        "mass": MASS,
        "position": [0.0, 0.0, 0.15],
        "velocity": [3.0, 0.0, -2.0],
        "angular_velocity": FLAT,
        "surface": surface,
    } | changes
    floor = {"shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}}
    scene = {"floor": floor | {"surface": surface}, "ball": ball}
    return scene_of(scene, gravity=[0.0, 0.0, -gravity])


def after(scene: dict[str, Any], time: float = 0.1) -> Any:
    return velocities_after(cell(scene), "ball", "floor", time)


def test_a_sphere_that_slips_loses_mu_times_its_normal_impulse() -> None:
    # j/m = 1.5 * 2 m/s; friction mu j/m = 0.6 m/s, to stick takes 2/7 * 3 m/s;
    # torque r mu j, I = 2/5 m r^2: omega = 5/2 mu j/(m r)
    velocity, omega = after(sphere_scene(friction=0.2))
    np.testing.assert_allclose(velocity, [2.4, 0.0, 1.0], atol=1e-15)
    np.testing.assert_allclose(omega, [0.0, 2.5 * 0.6 / RADIUS, 0.0], atol=1e-14)


def test_a_sphere_that_sticks_rolls_away() -> None:
    # without spin the slip of 3 m/s takes 2/7 of itself from v, and ends rolling: v = omega r
    velocity, omega = after(sphere_scene(friction=2.0))
    np.testing.assert_allclose(velocity, [3.0 * 5.0 / 7.0, 0.0, 1.0], atol=1e-15)
    np.testing.assert_allclose(omega, [0.0, 3.0 * 5.0 / 7.0 / RADIUS, 0.0], atol=1e-13)


def test_spin_alone_throws_a_sphere_aside() -> None:
    # backspin of 40 rad/s: the slip is r omega = -4 m/s along x; mu j/m = 0.9 m/s pushes along it
    spin = sphere_scene(velocity=[0.0, 0.0, -2.0], angular_velocity=[0.0, 40.0, 7.0])
    velocity, omega = after(spin)
    np.testing.assert_allclose(velocity, [0.9, 0.0, 1.0], atol=1e-15)
    np.testing.assert_allclose(omega, [0.0, 40.0 - 2.5 * 9.0, 7.0], atol=1e-13)


def test_gravity_quickens_the_fall_and_slows_the_rise() -> None:
    velocity, _ = after(sphere_scene(gravity=GRAVITY, friction=0.0), 0.1)
    hit = math.sqrt(4.0 + 2.0 * GRAVITY * 0.05)
    arrival = (hit - 2.0) / GRAVITY
    expected = 0.5 * hit - GRAVITY * (0.1 - arrival)
    np.testing.assert_allclose(velocity, [3.0, 0.0, expected], atol=1e-15)


@pytest.mark.parametrize("time", [0.02, 0.3])
def test_before_the_impact_and_after_a_second_one_there_is_no_form(time: float) -> None:
    # first impact after 0.0229 s at 2.23 m/s, the second 0.227 s later
    assert after(sphere_scene(gravity=GRAVITY), time) is None


def test_a_sphere_that_flies_away_never_hits() -> None:
    assert after(sphere_scene(velocity=[0.0, 0.0, 2.0])) is None
    risen = after(sphere_scene(gravity=GRAVITY, friction=0.0, velocity=[0.0, 0.0, 1.0]), 0.3)
    assert risen is not None  # but gravity brings it back: up 1/g, down again at sqrt(1 + 2 g h)
    hit = math.sqrt(1.0 + 2.0 * GRAVITY * 0.05)
    arrival = (1.0 + hit) / GRAVITY
    assert risen[0][2] == pytest.approx(0.5 * hit - GRAVITY * (0.3 - arrival), rel=1e-14)


@pytest.mark.parametrize("degrees", [20.0, 45.0, 70.0])
@pytest.mark.parametrize(
    "shape",
    [
        {"kind": "capsule", "radius": 0.03, "length": 0.5},
        {"kind": "cylinder", "radius": 0.03, "length": 0.5},
        {"kind": "box", "size": [0.04, 0.06, 0.5]},
    ],
)
def test_a_rod_end_leaves_with_minus_e_times_its_speed_and_every_balance_holds(
    shape: dict[str, Any], degrees: float
) -> None:
    half = math.radians(degrees) / 2.0
    scene = sphere_scene(
        friction=0.0,
        shape=shape,
        inertia=[0.05, 0.04, 0.003],
        position=[0.0, 0.0, 0.35],
        orientation=[math.cos(half), 0.0, math.sin(half), 0.0],
    )
    found = after(scene, 1.0)
    assert found is not None
    velocity, omega = found
    rod, up = cell(scene).scene.bodies["ball"], np.array([0.0, 0.0, 1.0])
    low = lowest_point(rod, up)
    lever = low - rod.position
    assert rod.position[2] - low[2] == pytest.approx(extent_along(rod, up))
    # Newton's law at the point, no impulse along the floor, and the impulse's own torque
    assert (velocity + np.cross(omega, lever))[2] == pytest.approx(0.5 * 2.0, rel=1e-14)
    np.testing.assert_allclose(velocity[:2], [3.0, 0.0], atol=1e-15)
    impulse = MASS * (velocity - [3.0, 0.0, -2.0])
    inertia = np.linalg.inv(inverse_inertia(rod))
    np.testing.assert_allclose(inertia @ omega, np.cross(lever, impulse), atol=1e-14)


def test_a_frictional_rod_and_a_turning_one_have_no_form() -> None:
    rod = {"shape": {"kind": "capsule", "radius": 0.03, "length": 0.2}, "inertia": [1.0, 1.0, 1.0]}
    assert after(sphere_scene(friction=0.1, **rod)) is None
    assert after(sphere_scene(friction=0.0, angular_velocity=[0.0, 1.0, 0.0], **rod)) is None


def flown(scene: dict[str, Any], velocity: Any, omega: Any) -> Any:
    """A log whose last state has these velocities; the centre is off the origin."""
    log = log_of(scene, np.tile([[0.0, 0.0, 0.0], [0.4, -0.2, 0.3]], (11, 1, 1)))
    momentum = MASS * np.asarray(velocity)
    inertia = np.linalg.inv(inverse_inertia(cell(scene).scene.bodies["ball"]))
    turning = np.cross([0.4, -0.2, 0.3], momentum) + inertia @ omega
    names = [f"angular_momentum_{axis}" for axis in "xyz"]
    log.step = recfunctions.append_fields(
        log.step, names, [np.full(11, one) for one in turning], usemask=False
    )
    for axis, value in zip("xyz", momentum, strict=True):
        log.step[f"momentum_{axis}"][-1] = value
    return log


VELOCITY = specs.VelocityError(kind="velocity_error", body="ball", other="floor")


def test_the_closed_forms_own_log_has_no_error() -> None:
    scene = sphere_scene()
    assert evaluate(VELOCITY, flown(scene, *after(scene))) < 1e-14


def test_an_error_of_spin_counts_at_the_surface() -> None:
    scene = sphere_scene()
    velocity, omega = after(scene)
    wrong = flown(scene, velocity, omega + np.array([0.0, 0.0, 0.5]))
    assert evaluate(VELOCITY, wrong) == pytest.approx(0.5 * RADIUS, rel=1e-12)
    wrong = flown(scene, velocity + np.array([0.0, 0.25, 0.0]), omega)
    assert evaluate(VELOCITY, wrong) == pytest.approx(0.25, rel=1e-12)


def test_without_a_closed_form_there_is_no_error() -> None:
    scene = sphere_scene(velocity=[0.0, 0.0, 2.0])
    assert math.isnan(evaluate(VELOCITY, flown(scene, [0.0, 0.0, 2.0], np.zeros(3))))


def test_an_impact_with_a_fixed_box_has_no_form() -> None:
    scene = sphere_scene()
    scene["scene"]["bodies"]["floor"]["shape"] = {"kind": "box", "size": [1.0, 1.0, 0.1]}
    assert after(scene) is None
