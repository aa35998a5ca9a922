"""Closed forms against numbers worked out by hand, and against the recurrence they solve."""

from __future__ import annotations

import math
from typing import Any

import pytest
from synthetic import ball_and_floor

from lavendersim.errors import UsageError
from lavendersim.measures import closed_forms
from lavendersim.measures.specs.base import ClosedForm
from tests.oracle.cells import cell

ROUND_OFF = 1e-14  # a handful of float64 operations


def evaluate_form(form: ClosedForm, said: dict[str, Any]) -> float:
    return closed_forms.evaluate_form(form, cell(said))


def form(name: str, *bodies: str) -> ClosedForm:
    return ClosedForm(form=name, bodies=bodies)


@pytest.mark.parametrize(
    ("name", "bodies", "expected"),
    [
        ("release_height", ("ball", "floor"), 1.0),
        ("rebound_height", ("ball", "floor"), 0.25),
        ("impact_speed", ("ball", "floor"), math.sqrt(19.62)),
        ("drop_impulse", ("ball", "floor"), 3.0 * math.sqrt(19.62)),
        ("weight", ("ball",), 19.62),
        ("slop", (), 0.001),
        ("steady_penetration_above_slop", ("ball", "floor"), 1e-5 * 19.62 / 0.27),
    ],
)
def test_drop_and_rest(name: str, bodies: tuple[str, ...], expected: float) -> None:
    assert evaluate_form(form(name, *bodies), ball_and_floor()) == pytest.approx(
        expected, rel=ROUND_OFF
    )


@pytest.mark.parametrize(("velocity", "impulse", "after"), [(-3.0, 9.0, 1.5), (2.0, 0.0, 2.0)])
def test_newton_on_a_fixed_floor(velocity: float, impulse: float, after: float) -> None:
    config = ball_and_floor(position=[0.0, 0.0, 0.1], velocity=[0.5, 0.0, velocity])
    assert evaluate_form(form("newton_impulse", "floor", "ball"), config) == impulse
    assert evaluate_form(form("newton_impulse", "ball", "floor"), config) == impulse
    assert evaluate_form(form("newton_separation_velocity", "floor", "ball"), config) == after


def two_balls() -> dict[str, Any]:
    config = ball_and_floor()
    ball = config["scene"]["bodies"]["ball"]
    config["scene"]["bodies"] = {
        "left": ball | {"position": [0.0, 0.0, 0.0], "velocity": [1.0, 0.0, 0.0]},
        "right": ball | {"position": [0.2, 0.0, 0.0], "velocity": [-3.0, 5.0, 0.0], "mass": 6.0},
    }
    return config


def test_two_movable_masses_share_the_impulse() -> None:
    # 1.5 * 4 m/s / (1/2 + 1/6) 1/kg = 9 N s
    assert evaluate_form(form("newton_impulse", "left", "right"), two_balls()) == pytest.approx(
        9.0, rel=ROUND_OFF
    )


def test_the_larger_restitution_decides_the_bounce() -> None:
    config = two_balls()
    config["scene"]["bodies"]["right"]["surface"] = {"restitution": 1.0}
    # 2 * 4 / (2/3) = 12 N s
    assert evaluate_form(form("newton_impulse", "left", "right"), config) == pytest.approx(
        12.0, rel=ROUND_OFF
    )


@pytest.mark.parametrize("offset", [0.0, 0.1, -0.2])
@pytest.mark.parametrize("turned", [0.0, 90.0])
def test_inverse_effective_mass_of_a_box_beside_its_centre(offset: float, turned: float) -> None:
    # 1/m + x^2/I about y, I = m/12 (sx^2 + sz^2); the pin lies below the box
    size = [0.5, 0.3, 0.2]
    half = math.radians(turned) / 2.0
    box = {
        "shape": {"kind": "box", "size": [0.3, 0.5, 0.2] if turned else size},
        "mass": 2.0,
        "orientation": [math.cos(half), 0.0, 0.0, math.sin(half)],  # about z: the same solid
        "position": [0.0, 0.0, 0.0],
    }
    pin = {
        "shape": {"kind": "sphere", "radius": 0.02},
        "fixed": True,
        "position": [offset, 0.0, -0.12],
    }
    config = ball_and_floor()
    config["scene"]["bodies"] = {"pin": pin, "box": box}
    inertia = 2.0 / 12.0 * (size[0] ** 2 + size[2] ** 2)
    measured = evaluate_form(form("inverse_effective_mass", "pin", "box"), config)
    assert measured == pytest.approx(0.5 + offset**2 / inertia, rel=ROUND_OFF)


@pytest.mark.parametrize("projection", [0.0, 0.2, 0.7, 1.0])
@pytest.mark.parametrize("gain", [0.02, 0.5])
def test_steady_penetration_is_the_fixed_point_of_the_step(projection: float, gain: float) -> None:
    config = ball_and_floor()
    config["numerics"] |= {"projection": projection, "stabilisation_gain": gain}
    load, compliance = 19.62, 1e-5
    beyond = 0.0
    for _ in range(2000):  # contracts by at least 0.98 a step: 0.98^2000 = 3e-18
        beyond = (1.0 - projection) * ((1.0 - gain) * beyond + compliance * load)
    measured = evaluate_form(form("steady_penetration_above_slop", "ball", "floor"), config)
    assert measured == pytest.approx(beyond, rel=1e-13, abs=1e-300)


@pytest.mark.parametrize("name", ["impact_speed", "drop_impulse"])
def test_a_drop_from_within_the_plane_or_away_from_it_has_no_form(name: str) -> None:
    inside = ball_and_floor(position=[0.0, 0.0, 0.05])
    lifted = ball_and_floor()
    lifted["scene"]["gravity"] = [0.0, 0.0, 9.81]
    inside_and_lifted = inside | {"scene": inside["scene"] | {"gravity": [0.0, 0.0, 9.81]}}
    for config in (inside, lifted, inside_and_lifted):
        assert math.isnan(evaluate_form(form(name, "ball", "floor"), config))


@pytest.mark.parametrize("surface", [{"compliance": 1e-5}, {"hertz_stiffness": 1e5}])
def test_nothing_rests_where_gravity_pulls_away(surface: dict[str, float]) -> None:
    config = ball_and_floor(surface=surface)
    config["scene"]["gravity"] = [0.0, 0.0, 9.81]
    measured = evaluate_form(form("steady_penetration_above_slop", "ball", "floor"), config)
    assert math.isnan(measured)


def test_what_nothing_lifts_sinks_for_ever() -> None:
    config = ball_and_floor()
    config["numerics"] |= {"projection": 0.0, "stabilisation_gain": 0.0}
    config["numerics"]["compliance_law"] = "regularised"
    measured = evaluate_form(form("steady_penetration_above_slop", "ball", "floor"), config)
    assert math.isnan(measured)


def test_bodies_without_closed_geometry_are_refused_in_a_sentence() -> None:
    config = ball_and_floor(shape={"kind": "capsule", "radius": 0.1, "length": 0.2})
    config["scene"]["bodies"]["floor"]["shape"] = {"kind": "box", "size": [1.0, 1.0, 1.0]}
    with pytest.raises(UsageError, match="no closed contact geometry for capsule and box"):
        evaluate_form(form("newton_impulse", "ball", "floor"), config)
