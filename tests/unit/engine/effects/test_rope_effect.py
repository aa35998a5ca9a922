"""When a scene requires ropes, what a config may say of them, and where they touch nothing."""

from __future__ import annotations

from typing import Any

import pytest
from laboratory import planned, resolved, sphere

from lavendersim.engine.effects.rope import EFFECT, pulling, turned
from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

TEXT = """
scene:
  bodies:
    hook: {{shape: {{kind: sphere, radius: 0.01}}, fixed: true, position: [0, 0, 1]}}
    bob: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, position: [0, 0, 0]}}
  connections:
    line: {{{rope}}}
numerics: {{timestep: 1/100}}
duration: 0.1
"""


def scene(rope: dict[str, Any] | None, **fixed: bool) -> dict[str, Any]:
    bodies = {
        "one": sphere(0.1, (0.0, 0.0, 0.0), fixed=True),
        "other": sphere(0.1, (1.0, 0.0, 0.0), **fixed),
    }
    cell = resolved(bodies, (0.0, 0.0, 0.0))
    if rope is not None:
        cell["scene"]["connections"] = {"line": {"kind": "rope", "between": tuple(bodies), **rope}}
    return cell


def test_a_rope_between_bodies_of_which_one_moves_is_required_and_no_other() -> None:
    plan = planned(scene({}))
    assert plan.decisions["rope"].reason == "one and other: a rope"
    assert {"rope", "compound", "frictionless_contact"} <= {*plan.spec.effects}
    assert "contact_torque" not in plan.spec.effects, "it pulls along the line of the centres"
    for cell in (scene({}, fixed=True), scene(None)):
        assert not planned(cell).decisions["rope"].on


def test_a_rope_off_a_centre_of_what_moves_turns_it() -> None:
    off = planned(scene({"points": ((0.0, 0.0, 0.0), (0.0, 0.1, 0.0))}))
    assert {"contact_torque", "rotation"} <= {*off.spec.effects}
    on_the_hook = planned(scene({"points": ((0.0, 0.1, 0.0), (0.0, 0.0, 0.0))}))
    assert not {"contact_torque", "rotation"} & {*on_the_hook.spec.effects}


def test_names_of_ropes_are_those_that_pull_in_order() -> None:
    config = load_experiment_text(TEXT.format(rope="kind: rope, between: [hook, bob]"), "x.yaml")
    scene_of_it = config.cells()[0].config.scene
    assert list(pulling(scene_of_it)) == ["line"]
    assert not [*turned(scene_of_it)]


@pytest.mark.parametrize(
    ("rope", "sentence"),
    [
        ("kind: rope, between: [hook, bop]", 'no body is called "bop"'),
        ("kind: rope, between: [bob, bob]", 'between: "bob" twice; expected two bodies'),
        ("kind: rope, between: [bob]", "between"),
        ("kind: rope, between: [hook, bob], length: 0", "length"),
        ("kind: rope, between: [hook, bob], restitution: 1.5", "restitution"),
        ("kind: rode, between: [hook, bob]", "rope"),
        ("kind: rope, between: [hook, bob], lenght: 1", "length"),
    ],
)
def test_what_is_no_rope_is_refused_at_its_place(rope: str, sentence: str) -> None:
    with pytest.raises(ConfigError) as refused:
        load_experiment_text(TEXT.format(rope=rope), "x.yaml").cells()
    assert sentence in str(refused.value)
    assert "x.yaml:7:" in str(refused.value)


def test_it_declares_its_column_and_nothing_of_a_step() -> None:
    assert [column.name for column in EFFECT.contact_columns] == ["rope"]
    assert EFFECT.step_columns == ()
