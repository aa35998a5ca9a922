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
