"""The benchmark of pruning times what it says: the plan, all effects, and the drop by hand."""

from __future__ import annotations

import pytest

from lavendersim.engine.effects import EFFECTS
from lavendersim.runner.overhead_pairs import names_of_effects
from tests.benchmarks import effects

# Laws that the chapter's numerics exclude, and what needs them.
OTHER_LAWS = {
    *("midpoint", "contact_midpoint", "contact_spring", "impact_time", "impact_order"),
    *(
        "speculative",
        *("hertz_contact", "tangential_compliance"),
        "newton",
        "least_norm",
        "fast_bodies",
        "impact_energy",
        "sliding_stops",
        "overlooked_points",
        "supernodes",
    ),
}
# Nor does the default choose these.
ASKED_FOR = {"error_control", "pairwise_impacts", "triggers"}
MISTAKES = {effect.name for effect in EFFECTS if effect.study_only}
LOGS = {"step_log", "pose_log", "velocity_log", "contact_log", "residual_log", "problem_log"}


def test_full_engines_have_every_effect_whose_law_the_numerics_have() -> None:
    found = {name: set(case.plan.spec.effects) for name, case in effects.cases().items()}
    every = set(names_of_effects()) - LOGS - MISTAKES - ASKED_FOR
    assert found["drop, full"] == found["stack, full"] == every - OTHER_LAWS
    assert found["drop of the default, full"] == every
    for name in ("drop", "drop of the default", "stack"):
        assert found[f"{name}, pruned"] < found[f"{name}, full"]
        assert not found[f"{name}, pruned"] & LOGS
    assert not {"friction", "rotation"} & found["drop, pruned"]


def test_every_bar_is_of_something_that_is_timed() -> None:
    timed = {*effects.cases(), "drop of 20 s, by hand", "drop of 20 s, registers"}
    assert set(effects.BARS) <= timed
    assert {name for ratio in effects.RATIOS for name in (ratio.of, ratio.to)} <= timed


def test_a_number_above_its_bar_fails_the_check(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    ratio = {"of": "drop, pruned", "to": "drop, full", "bar": 0.5, "samples": [0.6], "median": 0.6}
    found = {"cases": [], "ratios": [ratio]}
    monkeypatch.setattr(effects, "measure", lambda repeats: found)
    monkeypatch.setattr("sys.argv", ["effects", "--check"])
    assert effects.main() == 1
    ratio["median"] = 0.4
    assert effects.main() == 0
    assert "drop, pruned / drop, full" in capsys.readouterr().out
