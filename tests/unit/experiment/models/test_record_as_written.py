"""`record` as written: all, every N, or a stretch of time that lies in the run."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text
from tests.marked_config import assert_refused, config, refusals


@pytest.mark.parametrize("steps", ["all", "every 1", "every 4", "{from: 0, to: 1}"])
def test_contacts_and_poses_take_the_same_forms(steps: str) -> None:
    assert refusals(config(record=f"{{contacts: {steps}, poses: {steps}}}")) == []


def test_a_window_is_kept_in_seconds_as_it_is_written() -> None:
    text = config(record="{contacts: {from: 1/4, to: 3/4}, residuals: all, velocities: true}")
    record = load_experiment_text(text, "record.yaml").cells()[0].config.record
    assert record.model_dump(by_alias=True)["contacts"] == {"from": 0.25, "to": 0.75}
    assert (record.poses, record.residuals, record.velocities) == ("all", "all", True)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (
            "contacts: {from: 0.5, to: §0.5}",
            "to: expected a time after from (0.5 s), found 0.5",
        ),
        (
            "residuals: {from: §1.5, to: 2}",
            "from: 1.5 s is after the end of the run, duration 1 s",
        ),
        (
            "poses: §4",
            "poses: expected all or every N with a whole number of steps N of 1 or more, found 4; "
            'did you mean "every 4"?',
        ),
        (
            "residuals: §every 2",
            'residuals: expected none or all, found the text "every 2"',
        ),
    ],
)
def test_other_forms_are_refused_where_they_stand(words: str, sentence: str) -> None:
    assert_refused(config(record=f"{{{words}}}"), sentence)


def test_a_window_may_end_after_the_run_but_not_begin_there() -> None:
    assert refusals(config(record="{poses: {from: 0.5, to: 2}}")) == []
