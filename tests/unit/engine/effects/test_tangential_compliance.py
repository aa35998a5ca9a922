"""Tangential compliance: when it is required, how it mixes, what it refuses."""

from __future__ import annotations

import pytest
from plain_facts import facts, pair_facts

from lavendersim.engine.effects import SURFACE_KEYS
from lavendersim.engine.effects.tangential_compliance import EFFECT
from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.cell import Cell

SOFT = {"compliance": 1e-6, "friction": 0.5, "tangential_stiffness": 0.8}


def test_it_is_on_where_a_pair_has_friction_and_gives_way_across_and_along() -> None:
    asked = facts(pairs=(pair_facts("floor", "ball", **SOFT),))
    decision = EFFECT.decide(asked)
    assert decision.on
    assert decision.reason == "floor and ball: 0.8 times as stiff along the surface as across it"
    hertz = {**SOFT, "compliance": 0.0, "hertz_stiffness": 1e6}
    assert EFFECT.decide(facts(pairs=(pair_facts("floor", "ball", **hertz),))).on


@pytest.mark.parametrize("key", SOFT)
def test_without_one_of_the_three_it_is_off(key: str) -> None:
    pair = pair_facts("floor", "ball", **{**SOFT, key: 0.0})
    assert not EFFECT.decide(facts(pairs=(pair,))).on


def test_a_pair_takes_the_larger() -> None:
    (mix,) = (key.mix for key in SURFACE_KEYS if key.name == "tangential_stiffness")
    assert mix(0.0, 0.8) == mix(0.8, 0.3) == 0.8


def experiment(
    surface: str, numerics: str = "", ball: str = "", scene: str = "", more: str = ""
) -> list[Cell]:
    return load_experiment_text(
        f"question: q\nexpected: e\nscene:\n{scene}  bodies:\n"
        "    floor: {shape: {kind: plane}, surface: {friction: 0.5}}\n"
        "    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1], "
        f"surface: {{{surface}}}{ball}}}\n"
        f"numerics: {{timestep: 1/240{numerics}}}\nduration: 0.1\n{more}",
        "along.yaml",
    ).cells()


GIVES = "friction: 0.5, tangential_stiffness: 0.8"
YIELDS = f"{GIVES}, compliance: 1e-6"
SPRING = "  springs: [{a: floor, b: ball, stiffness: 1}]\n"


@pytest.mark.parametrize(
    ("surface", "numerics", "ball", "scene", "why"),
    [
        (GIVES, "", "", "", "all are rigid"),
        ("compliance: 1e-6, tangential_stiffness: 0.8", "", "", "", "needs friction above 0"),
        (f"{YIELDS[:-4]}-1", "", "", "", "a number of 0 or more"),
        (YIELDS, ", compliance_law: regularised", "", "", "is regularised"),
        (YIELDS, ", stabilisation_gain: 0.1", "", "", "pushes in place"),
        (YIELDS, ", warm_start: false", "", "", "kept with the impulses"),
        (YIELDS, "", "", SPRING, "an energy without its own"),
        (f"{YIELDS}, static_friction: 0.7", "", "", "", "which is no slip"),
        (f"{YIELDS}, across_grain: 2", "", ", grain: [1, 0, 0]", "", "expected no grain"),
    ],
)
def test_what_cannot_be_is_refused(
    surface: str, numerics: str, ball: str, scene: str, why: str
) -> None:
    with pytest.raises(ConfigError, match=rf"along\.yaml:\d+:\d+.*{why}"):
        experiment(surface, numerics, ball, scene)


def test_an_event_may_not_bring_what_is_refused() -> None:
    event = "{at: 0.05, body: ball, surface: {friction: 0.5, static_friction: 0.9}}"
    with pytest.raises(ConfigError, match="which is no slip"):
        experiment(YIELDS, more=f"events: [{event}]\n")


def test_what_can_be_is_not() -> None:
    experiment(YIELDS)
    experiment(f"{GIVES}, hertz_stiffness: 1e6")
    experiment("friction: 0.5, tangential_stiffness: 0", ", warm_start: false", "", SPRING)
