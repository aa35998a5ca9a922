"""Rows of each step of a block: where they begin, and blocks that contradict themselves."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.trace.blocks import Block, counted, cumulative


def rows(*steps: int) -> np.ndarray:
    """Return rows of these steps."""
    made = np.zeros(len(steps), [("step", "i8")])
    made["step"] = steps
    return made


def block(contacts: tuple[int, ...], residuals: tuple[int, ...] = ()) -> Block:
    """Return a block of the steps 4, 5, 7 with rows of these steps."""
    return Block(rows(4, 5, 7), rows(*contacts), np.zeros((3, 0, 7)), rows(*residuals))


ALL = np.ones(3, bool)


def test_rows_begin_where_those_of_the_steps_before_end() -> None:
    found = counted(block((4, 4, 7), (5,)), ALL, ALL)
    assert found.contact_start.tolist() == [0, 2, 2, 3]
    assert found.residual_start.tolist() == [0, 0, 1, 1]
    assert counted(block(()), ALL, ALL).contact_start.tolist() == [0, 0, 0, 0]


@pytest.mark.parametrize("contacts", [(5, 4), (3,), (6,), (8,), (4, 6, 7), (7, 4, 4, 7)])
def test_rows_out_of_order_or_of_no_step_are_refused(contacts: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="contacts of a block are not grouped by its steps"):
        counted(block(contacts), ALL, ALL)


def test_sizes_add_up() -> None:
    assert cumulative(np.array([3, 0, 2])).tolist() == [0, 3, 3, 5]
    assert cumulative(np.array([], int)).tolist() == [0]
