"""Reasons name the bodies and pairs of surfaces that an effect is for, and the others too."""

from __future__ import annotations

from lavendersim.engine.effects import Decision
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.plan import plan_of_cell

SCENE = """\
scene:
  bodies:
    floor: {shape: {kind: plane}, surface: {friction: 0.5}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1
      position: [0, 0, 1]
      surface: {friction: 0.5}
    slick: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [2, 0, 1]}
    sleek: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [4, 0, 1]}
duration: 1
"""
BOX = "    box: {shape: {kind: box, size: [1, 1, 1]}, mass: 1, position: [8, 0, 1]}\nduration: 1\n"


def decision(name: str, text: str = SCENE) -> Decision:
    (cell,) = load_experiment_text(text, "t.yaml").cells()
    return plan_of_cell(cell).decisions[name]


def test_rotation_tells_who_can_turn_and_who_cannot() -> None:
    """Those that are alike share a pair, and its reason."""
    assert decision("rotation", SCENE.replace("duration: 1\n", BOX)).reason == (
        "ball: friction exerts a torque; box: a contact off the centre of mass exerts a torque; "
        "slick, sleek cannot turn: no contact of them can exert a torque"
    )


def test_rotation_is_off_with_the_same_words() -> None:
    found = decision("rotation", SCENE.replace("friction: 0.5", "friction: 0"))
    assert found == Decision(
        False, "ball, slick, sleek cannot turn: no contact of them can exert a torque"
    )


def test_friction_tells_each_pair() -> None:
    # floor and slick, ball and slick, slick and sleek have none
    assert decision("friction").reason == "floor and ball: sliding 0.5; 3 other pairs: none"
    two = SCENE.replace("    sleek:", "    # sleek:").replace(
        "position: [2, 0, 1]", "position: [2, 0, 1], surface: {friction: 0.08}"
    )
    assert decision("friction", two).reason == (
        "floor and ball: sliding 0.5; floor and slick: sliding 0.2; ball and slick: sliding 0.2"
    )


BOUNCES = SCENE.replace("surface: {friction: 0.5}", "surface: {restitution: 0.5}") + (
    "numerics: {timestep: 1/2000, impacts: at_surface}\n"
)


def test_bounces_at_the_surface_leave_a_bound_on_speeds() -> None:
    found = decision("fast_bodies", BOUNCES)
    assert not found.on
    assert found.reason.startswith("the energy there is moves no body")


def test_bounces_from_where_a_step_begins_leave_no_bound_on_speeds() -> None:
    """A step that begins d above the floor gives m g d, at every bounce: `measures.balance`."""
    found = decision("fast_bodies", BOUNCES.replace("at_surface", "captured"))
    assert found == Decision(
        True,
        "floor and ball bounce from where a step begins, above the surface: no bound on how fast "
        "ball may become",
    )


def test_captured_impacts_without_restitution_leave_a_bound_on_speeds() -> None:
    text = BOUNCES.replace("at_surface", "captured").replace("restitution: 0.5", "restitution: 0")
    assert not decision("fast_bodies", text).on
