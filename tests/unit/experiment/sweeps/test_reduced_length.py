"""`slow` and `reduced`: the same experiment, shorter where that is asked for and nowhere else."""

from __future__ import annotations

from lavendersim.experiment import load_experiment_text
from tests.drop_config import DROP

SLOW = DROP + "slow: true\nreduced: {duration: 0.25}\n"


def test_a_slow_experiment_has_both_its_lengths() -> None:
    full, short = (load_experiment_text(SLOW, "slow.yaml", reduced) for reduced in (False, True))
    assert (full.options.reduced, short.options.reduced) == (False, True)
    assert [one.cells()[0].config.duration for one in (full, short)] == [0.5, 0.25]
    assert [one.cells()[0].config.steps for one in (full, short)] == [120, 60]
    assert full.text == short.text


def test_only_the_length_differs() -> None:
    full, short = (load_experiment_text(SLOW, "slow.yaml", reduced) for reduced in (False, True))
    assert {**short.cells()[0].config.as_dict(), "duration": 0.5} == full.cells()[
        0
    ].config.as_dict()


def test_other_experiments_have_one_length() -> None:
    experiment = load_experiment_text(DROP, "drop.yaml", reduced=True)
    assert not experiment.options.reduced
    assert experiment.cells()[0].config.duration == 0.5
