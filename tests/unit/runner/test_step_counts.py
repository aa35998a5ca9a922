"""Contacts and iterations of a step, on average, of logs that have them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from lavendersim.runner.step_counts import StepCounts, counts_of, in_words


def cell(**columns: list[int]) -> Any:
    step = np.zeros(len(next(iter(columns.values()))), [(name, "i8") for name in columns])
    for name, values in columns.items():
        step[name] = values
    return SimpleNamespace(trace=lambda: SimpleNamespace(step=step), release=lambda: None)


def test_counts_are_of_every_step_of_every_cell_but_of_no_initial_state() -> None:
    one = cell(contact_count=[9, 4, 4], sweeps=[9, 1, 3])
    other = cell(contact_count=[9, 1], sweeps=[9, 5])
    assert counts_of([one, other]) == StepCounts(3.0, 3.0)  # (4 + 4 + 1) / 3, (1 + 3 + 5) / 3


def test_what_a_log_does_not_have_is_none_and_not_zero() -> None:
    assert counts_of([cell(contact_count=[0, 0])]) == StepCounts(0.0, None)
    assert counts_of([cell(sweeps=[0, 2]), cell(contact_count=[0, 2])]) == StepCounts()
    assert counts_of([cell(contact_count=[3])]) == StepCounts()  # it made no step


def test_counts_in_words_leave_out_what_is_not_reported() -> None:
    assert in_words(StepCounts(12.0, 3.456)) == "12 contacts, 3.46 iterations a step"
    assert in_words(StepCounts(12.0)) == "12 contacts a step"
    assert in_words(StepCounts()) == "nothing reported of a step's contacts"
