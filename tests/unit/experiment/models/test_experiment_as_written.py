"""The whole config as written: forms of its sections, and rules that reach over several."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text
from tests.marked_config import assert_refused, config, refusals


@pytest.mark.parametrize("solver", ["jacobi", "accelerated_projected_gradient"])
@pytest.mark.parametrize(
    ("key", "value", "idle"), [("over_relaxation", "1.5", "1"), ("order", "forward", "coloured")]
)
def test_a_solver_without_sweeps_has_no_order_and_no_relaxation(
    solver: str, key: str, value: str, idle: str
) -> None:
    text = config(numerics=f"{{solver: {solver}, {key}: §{value}}}")
    sentence = f"{key}: {solver} treats all contacts at once; expected {idle}"
    assert_refused(text, sentence)
    idle_text = config(numerics=f"{{solver: {solver}, {key}: {idle}}}")
    assert refusals(idle_text) == []


def test_a_text_has_no_folder_for_what_it_extends() -> None:
    text = config().replace("scene:", "§extends: base.yaml\nscene:", 1)
    assert_refused(text, "extends: a text has no folder to look in; merge it first")


def test_a_preset_is_a_name_or_the_base_of_values() -> None:
    for numerics in ("chapter", "{preset: chapter}"):
        cell = load_experiment_text(config(numerics=numerics), "a.yaml").cells()[0]
        assert cell.config.numerics.solver == "projected_gauss_seidel"
    assert_refused(
        config(numerics="§[chapter]"),
        "numerics: expected the name of a preset (chapter, default) or a mapping of values, "
        "found a list of 1",
    )


def test_effects_are_switched_by_on_and_off_and_by_no_truth_value() -> None:
    text = config(effects="{sleeping: on, force: true}")
    effects = load_experiment_text(text, "a.yaml").config.effects
    assert effects.switches == {"sleeping": "on"}
    assert effects.force
    assert_refused(
        config(effects="{sleeping: §true}"), "sleeping: expected on or off, found true; write on"
    )


def test_a_list_of_mappings_is_a_union_of_products() -> None:
    mass, length = "path: scene.bodies.ball.mass", "path: duration"
    union = f"[{{m: {{{mass}, values: [1, 2]}}, t: {{{length}, values: [1, 2, 3]}}}}, "
    union += f"{{m: {{{mass}, values: [5]}}}}]"
    assert len(load_experiment_text(config(sweep=union), "a.yaml").cells()) == 2 * 3 + 1
