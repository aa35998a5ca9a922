"""Numbers over the whole range of doubles are refused at their place, or run to an end with a name.

A sample of `python -m tests.property.extreme_numbers`, which takes thousands; and the numbers that
once ended in a traceback, each in a config that is good otherwise.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text
from lavendersim.measures.registration import FUNCTIONS
from tests.drop_config import DROP
from tests.many_measures_config import MANY_MEASURES
from tests.property.extreme_numbers import NAME, WidePlans, counted, outcome, texts

MASS = "mass: 1.0"
RADIUS = "radius: 0.1"
DURATION = "duration: 0.5"
MEASURED = WidePlans()


@pytest.mark.parametrize("name", texts())
def test_every_config_is_good_before_its_numbers_are_replaced(name: str) -> None:
    assert load_experiment_text(texts()[name], NAME).cells()


def test_numbers_of_any_size_are_refused_or_planned() -> None:
    counts, defects = counted(200, seed=0, steps=False)
    assert not defects
    assert counts["refused"] > 20
    assert counts["complete"] > 20


def test_numbers_of_any_size_are_refused_or_run() -> None:
    counts, defects = counted(60, seed=0, only=("chapter/warm_start",))
    assert not defects
    assert counts["refused"] > 5
    assert counts["complete"] + counts["ended early"] > 5


def test_numbers_of_any_size_are_measured() -> None:
    counts, defects = counted(20, seed=3, only=("many measures",))
    assert not defects
    assert counts["complete"] > 5


def test_nearly_all_kinds_of_measures_are_asked_for() -> None:
    asked = load_experiment_text(MANY_MEASURES, NAME).measures.values()
    connections = {"Tension", "JointForce", "JointTorque"}  # a ball has none
    kinds = {kind.__name__ for kind in FUNCTIONS if kind.__module__.startswith("lavendersim.")}
    assert kinds - {type(one).__name__ for one in asked} == {*connections, "FromFile"}


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("angular_velocity: [0.01, 5", "angular_velocity: [0.01, 1e308"),
        ("inertia: [0.003, 0.004, 0.005]", "inertia: [3e49, 4e49, 5e49]"),
        ("      inertia: [0.003, 0.004, 0.005]\n", ""),
        ("radius: 0.1", "radius: 1e50"),
        ("velocity: [0, 0, -0.1]", "velocity: [0, 0, 1e20]"),  # it touches nothing
        ("gravity: 9.81", "gravity: [0, 0, 9.81]"),
        ("release: {above: floor, clearance: 0.001}", "position: [0, 0, 0.05]"),
    ],
)
def test_what_no_formula_is_made_for_is_measured(before: str, after: str, tmp_path: Path) -> None:
    text = MANY_MEASURES.replace(before, after)
    assert text != MANY_MEASURES
    end = outcome(text, tmp_path, MEASURED.of("many measures"))
    assert end.kind in ("complete", "ended early"), end


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (RADIUS, "radius: 1e200"),
        (RADIUS, "radius: 5e-324"),
        (MASS, "mass: 5e-324"),
        (MASS, "mass: 1e51"),
        (DURATION, "duration: 1e300"),
    ],
)
def test_what_cannot_be_simulated_is_refused_with_the_range(before: str, after: str) -> None:
    with pytest.raises(ConfigError) as caught:
        load_experiment_text(DROP.replace(before, after), NAME)
    defect = caught.value.defects[0]
    begin = DROP.index(before)
    number = begin + len(before.split(" ")[0]) + 1
    place = (DROP[:begin].count("\n") + 1, number - DROP.rfind("\n", 0, begin))
    assert (defect.line, defect.column) == place
    assert "expected a number from" in defect.message
    assert "others cannot be simulated in numbers of 64 bits" in defect.message


def test_a_speed_of_any_size_has_a_plan() -> None:
    sliding = texts()["effects/static_friction"]
    fast = sliding.replace("velocity: [1, 0, 0]", "velocity: [1, 1e300, 0]")
    assert fast != sliding
    assert outcome(fast, Path("unused"), None).kind == "complete"


@pytest.mark.parametrize(
    "key",
    ["velocity: [1e200, 0, 0]", "angular_velocity: [0, 1e200, 0]", "velocity: [0, 0, 5e-324]"],
)
def test_a_speed_of_any_size_runs_to_an_end(key: str, tmp_path: Path) -> None:
    text = DROP.replace(f"{MASS}\n", f"{MASS}\n      {key}\n")
    end = outcome(text, tmp_path, WidePlans().of("drop"))
    assert end.kind in ("complete", "ended early")


@pytest.mark.parametrize("phase", ["1e60", "1e300", "1.7976931348623157e308"])
def test_a_start_that_is_too_far_is_refused_with_its_place(phase: str) -> None:
    text = DROP.replace("clearance: 0.1}", f"clearance: 0.1, phase: {phase}}}")
    with pytest.raises(ConfigError) as caught:
        load_experiment_text(text, NAME).cells()
    (defect,) = caught.value.defects
    begin = text.index(phase)
    place = (text[:begin].count("\n") + 1, begin - text.rfind("\n", 0, begin))
    assert (defect.line, defect.column) == place
    assert "expected a shift of 1e+50 m or less" in defect.message
