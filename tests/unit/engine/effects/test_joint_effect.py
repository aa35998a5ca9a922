"""When a scene requires joints, what a config may say of them, and what their rows may be with."""

from __future__ import annotations

from typing import Any

import pytest
from laboratory import planned, resolved, sphere

from lavendersim.engine.effects import holding, pulling, turned_by_joints
from lavendersim.engine.effects.joint import EFFECT
from lavendersim.engine.row_terms import row_terms
from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

TEXT = """
scene:
  bodies:
    hook: {{shape: {{kind: sphere, radius: 0.01}}, fixed: true, position: [0, 0, 1]}}
    bob: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, position: [0, 0, 0]}}
  connections:
    arm: {{{joint}}}
numerics: {{timestep: 1/100}}
duration: 0.1
"""


def scene(at: tuple[float, ...] | None, **fixed: bool) -> dict[str, Any]:
    bodies = {
        "one": sphere(0.1, (0.0, 0.0, 0.0), fixed=True),
        "other": sphere(0.1, (1.0, 0.0, 0.0), **fixed),
    }
    cell = resolved(bodies, (0.0, 0.0, 0.0))
    if at is not None:
        joint = {"kind": "ball", "between": tuple(bodies), "at": at}
        cell["scene"]["connections"] = {"arm": joint}
    return cell


def test_a_joint_between_bodies_of_which_one_moves_is_required_and_no_other() -> None:
    plan = planned(scene((0.0, 0.0, 0.0)))
    assert plan.decisions["joint"].reason == "one and other: a joint"
    assert {"joint", "compound", "frictionless_contact", "rotation"} <= {*plan.spec.effects}
    assert row_terms(plan.spec).bilateral
    # The two touch no more, so that nothing can meet.
    assert plan.spec.shape_pairs == ()
    assert not {"impact_order", "speculative", "fast_bodies"} & {*plan.spec.effects}
    for cell in (scene((0.0, 0.0, 0.0), fixed=True), scene(None)):
        assert not planned(cell).decisions["joint"].on


def test_a_joint_at_the_centre_of_what_moves_turns_nothing() -> None:
    plan = planned(scene((1.0, 0.0, 0.0)))
    assert not {"contact_torque", "rotation"} & {*plan.spec.effects}


@pytest.mark.parametrize(
    ("kind", "free"), [("ball", 3), ("hinge, axis: [0, 0, 2]", 1), ("fixed", 0)]
)
def test_rows_are_six_less_what_the_joint_leaves_free(kind: str, free: int) -> None:
    text = TEXT.format(joint=f"kind: {kind}, between: [hook, bob], at: [0, 0, 0]")
    found = load_experiment_text(text, "x.yaml").cells()[0].config.scene
    assert len(holding(found)["arm"].rows) == 6 - free
    # At its centre a ball joint turns nothing; any other turns what it holds with the other body.
    assert list(turned_by_joints(found)) == ([] if free == 3 else ["bob"])


def test_names_of_joints_are_those_that_hold_and_are_no_ropes() -> None:
    text = TEXT.format(joint="kind: ball, between: [hook, bob], at: [0, 0, 1]")
    found = load_experiment_text(text, "x.yaml").cells()[0].config.scene
    assert list(holding(found)) == ["arm"]
    assert list(turned_by_joints(found)) == ["bob"]
    assert not pulling(found)


@pytest.mark.parametrize(
    ("joint", "sentence"),
    [
        ("kind: ball, between: [hook, bop], at: [0, 0, 1]", 'no body is called "bop"'),
        ("kind: ball, between: [bob, bob], at: [0, 0, 1]", 'between: "bob" twice'),
        ("kind: ball, between: [hook, bob], at: [0, 0]", "at"),
        ("kind: hinge, between: [hook, bob], at: [0, 0, 1]", 'missing key "axis"'),
        ("kind: slider, between: [hook, bob], at: [0, 0, 1], axis: [0, 0, 0]", "only zeros"),
        ("kind: fixed, between: [hook, bob], at: [0, 0, 1], axis: [0, 0, 1]", 'unknown key "axis"'),
        ("kind: hing, between: [hook, bob], at: [0, 0, 1]", 'did you mean "hinge"?'),
        ("kind: bal, between: [hook, bob], at: [0, 0, 1]", "ball"),
        ("kind: ball, between: [hook, bob], at: [0, 0, 1], colide: true", "collide"),
    ],
)
def test_what_is_no_joint_is_refused_at_its_place(joint: str, sentence: str) -> None:
    with pytest.raises(ConfigError) as refused:
        load_experiment_text(TEXT.format(joint=joint), "x.yaml").cells()
    assert sentence in str(refused.value)
    assert "x.yaml:7:" in str(refused.value)


def test_it_declares_its_column_and_nothing_of_a_step() -> None:
    assert [column.name for column in EFFECT.contact_columns] == ["joint"]
    assert EFFECT.step_columns == ()
