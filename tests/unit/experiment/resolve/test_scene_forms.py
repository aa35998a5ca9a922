"""Surfaces, kinematic bodies, drag, forces and events as they are resolved."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text

TEXT = """\
scene:
  {scene}
  surfaces: {{wood: {{friction: 0.5}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: wood}}
    ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 2.0, position: [0, 0, 1]{body}}}
    belt: {{shape: {{kind: box, size: [1, 1, 1]}}, kinematic: true, position: [3, 0, 0],
           velocity: [0.5, 0, 0], surface_velocity: [0, 1, 0]}}
duration: 2.0
{rest}
"""


def resolved(scene: str = "gravity: 9.81", body: str = "", rest: str = "") -> dict:
    text = TEXT.format(scene=scene, body=body, rest=rest)
    return load_experiment_text(text, "forms.yaml").cells()[0].config.as_dict()


def test_kinematic_body_has_no_mass_and_is_moved_by_nothing() -> None:
    belt = resolved()["scene"]["bodies"]["belt"]
    assert (belt["fixed"], belt["kinematic"]) == (True, True)
    assert (belt["mass"], belt["inertia"]) == (None, None)
    assert belt["velocity"] == [0.5, 0.0, 0.0]
    assert belt["surface_velocity"] == [0.0, 1.0, 0.0]


def test_specified_inertia_replaces_that_of_the_shape() -> None:
    ball = resolved(body=", inertia: [1, 2, 3]")["scene"]["bodies"]["ball"]
    assert ball["inertia"] == [1.0, 2.0, 3.0]
    # 2/5 m r^2
    plain = resolved()["scene"]["bodies"]["ball"]
    assert plain["inertia"] == pytest.approx([0.008] * 3, rel=1e-15)


def test_drag_that_is_not_specified_is_zero() -> None:
    zero = {"linear": 0.0, "quadratic": 0.0, "angular": 0.0}
    assert resolved()["scene"]["bodies"]["ball"]["drag"] == zero
    specified = resolved(body=", drag: {quadratic: 0.1}")["scene"]["bodies"]["ball"]["drag"]
    assert specified == {**zero, "quadratic": 0.1}


def test_force_lasts_for_the_run_where_no_time_is_specified() -> None:
    pushed = "{body: ball, force: [1, 0, 0]}"
    scene = f"forces: [{pushed}, {{body: ball, from: 1, to: 3/2, torque: [0, 0, 2]}}]"
    first, second = resolved(scene)["scene"]["forces"]
    assert first == {
        "body": "ball",
        "from": 0.0,
        "to": 2.0,
        "force": [1.0, 0.0, 0.0],
        "torque": [0.0, 0.0, 0.0],
        "factor": None,
        "point": [0.0, 0.0, 0.0],
        "frame": "world",
    }
    assert (second["from"], second["to"], second["torque"]) == (1.0, 1.5, [0.0, 0.0, 2.0])


def test_event_sets_velocities_of_movable_and_kinematic_bodies() -> None:
    rest = (
        "events:\n  - {at: 1, body: ball, velocity: [1, 2, 3], angular_velocity: [0, 0, 1]}\n"
        "  - {at: 1, body: belt, velocity: [0, 0, 0]}\n"
    )
    ball, belt = resolved(rest=rest)["events"]
    assert (ball["velocity"], ball["angular_velocity"]) == ([1.0, 2.0, 3.0], [0.0, 0.0, 1.0])
    assert (belt["velocity"], belt["angular_velocity"]) == ([0.0, 0.0, 0.0], None)
    assert ball["contact_cache"] == "keep"


def test_sweep_tilts_gravity_that_is_not_written() -> None:
    rest = "sweep:\n  slope: {path: scene.gravity.slope, values: [0, 1]}\n"
    text = TEXT.format(scene="forces: []", body="", rest=rest)
    cells = load_experiment_text(text, "forms.yaml").cells()
    assert cells[0].config.as_dict()["scene"]["gravity"] == [0.0, 0.0, -9.81]
    x, _, z = cells[1].config.as_dict()["scene"]["gravity"]
    assert x == pytest.approx(-z, rel=1e-15)
