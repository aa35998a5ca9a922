"""When a scene requires stops of joints: their pairs meet, as those of surfaces do."""

from __future__ import annotations

from lavendersim.engine.effects.joint_stop import EFFECT
from lavendersim.engine.row_terms import row_terms
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.facts import facts_of
from lavendersim.scene.plan import Plan, plan_of_cell

TEXT = """
scene:
  bodies:
    hook: {shape: {kind: sphere, radius: 0.01}, fixed: true, position: [0, 0, 1]}
    bob: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 0]}
  connections:
    arm: {kind: hinge, between: [hook, bob], at: [0, 0, 1], axis: [0, 1, 0]}
numerics: {timestep: 1/100}
duration: 0.1
"""
LIMITED = TEXT.replace("axis: [0, 1, 0]", "axis: [0, 1, 0], limits: [-1, 1]")


def planned(text: str) -> Plan:
    return plan_of_cell(load_experiment_text(text, "x.yaml").cells()[0])


def test_limits_require_it_and_what_meets_in_time() -> None:
    plan = planned(LIMITED)
    assert plan.decisions["joint_stop"].reason == "hook and bob: limits of a joint"
    assert row_terms(plan.spec).stopped
    # A stop is met: nothing else of the scene is.
    assert {"impact_order", "impact_time", "speculative"} <= {*plan.spec.effects}
    assert "overlooked_points" not in plan.spec.effects
    assert not row_terms(plan.spec).bounded


def test_a_joint_without_limits_has_none_of_it() -> None:
    plan = planned(TEXT)
    assert plan.decisions["joint_stop"].reason == "no joint has limits"
    assert not {"joint_stop", "impact_order", "speculative"} & {*plan.spec.effects}


def test_each_limit_is_a_pair_beside_those_of_the_joint() -> None:
    config = load_experiment_text(LIMITED, "x.yaml").cells()[0].config
    rows = {pair.shape_pair: pair.row_pairs for pair in facts_of(config).pairs}
    assert rows == {"joint": 5, "joint_stop": 2}
    assert EFFECT.contact_columns == ()
