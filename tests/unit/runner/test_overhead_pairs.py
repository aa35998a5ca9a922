"""Pairs of engines that differ in one effect; where there is none, the reason."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.runner.overhead_pairs import ALL, names_of_effects, pairs_of
from lavendersim.scene.laws import needs
from lavendersim.scene.plan import plan_of
from tests.drop_config import LOW

BALL = f"{LOW}duration: 0.5\n"


# What comes and goes with an effect and has no numerics of its own that choose it.
TIMED_WITH = {"step_log": ("pose_log",), "impact_order": ("overlooked_points",)}


@pytest.mark.parametrize("numerics", ["chapter", "default"])
def test_both_engines_of_a_pair_can_be_and_differ_in_the_effect(numerics: str) -> None:
    text = BALL.replace("numerics: chapter", f"numerics: {numerics}")
    config = load_experiment_text(text, "ball.yaml").cells()[0].config
    silent = plan_of(config, record=False).spec
    for pair in pairs_of(config):
        assert (pair.off is None) == (pair.on is None) == bool(pair.why_not)
        if pair.off is None or pair.on is None:
            continue
        for spec in (pair.off, pair.on):
            assert all(spec.has(need) for name in spec.effects for need in needs(name))
        extra = set(pair.on.effects) - set(pair.off.effects)
        if pair.effect == ALL:
            assert pair.off == silent
            laws = {"impact_time", "midpoint", "speculative", "newton", "fast_bodies"}
            laws |= {"impact_energy"}
            assert bool(laws <= set(pair.on.effects)) == (numerics == "default")
            assert not laws & set(pair.on.effects) or numerics == "default"
        elif pair.effect in names_of_effects():
            assert extra == {pair.effect, *TIMED_WITH.get(pair.effect, ())}


def test_what_other_effects_of_the_plan_need_cannot_be_left_out_alone() -> None:
    rolling = BALL.replace("restitution: 0.5", "friction: 0.5, rolling_friction: 0.01")
    config = load_experiment_text(rolling, "ball.yaml").cells()[0].config
    found = {pair.effect: pair for pair in pairs_of(config, ("friction", "rolling_friction"))}
    assert "rolling_friction" in found["friction"].why_not
    assert found["friction"].why_not.endswith(("needs it", "need it"))
    assert found["rolling_friction"].off is not None
