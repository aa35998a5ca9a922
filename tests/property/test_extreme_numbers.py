"""Numbers over the whole range of doubles are refused at their place, or run to an end with a name.

A sample of `python -m tests.property.extreme_numbers`, which takes thousands; and the numbers that
once ended in a traceback, each in a config that is good otherwise.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text
from tests.drop_config import DROP
from tests.property.extreme_numbers import NAME, WidePlans, counted, outcome, texts

MASS = "mass: 1.0"
RADIUS = "radius: 0.1"
DURATION = "duration: 0.5"


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
