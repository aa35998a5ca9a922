"""Positions after steps that are asked for, as poses come in parts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from lavendersim.trace.positions import Positions

PARTS = ([0, 1, 2], [4, 6], [7, 8, 9])


def poses(steps: list[int]) -> np.ndarray:
    """Return poses of two bodies that say their step in every number."""
    return np.broadcast_to(np.array(steps, float)[:, None, None], (len(steps), 2, 7)).copy()


def parts(taken: list[int]) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield parts, noting how many were taken."""
    for steps in PARTS:
        taken.append(len(taken))
        yield np.array(steps), poses(steps)


@pytest.mark.parametrize("asked", [[0], [1, 2, 4], [0, 9], [2, 4, 6, 7], [9]])
def test_each_step_has_its_own_place(asked: list[int]) -> None:
    found = Positions(parts([]))(np.array(asked))
    assert found.shape == (len(asked), 2, 3)
    assert found[:, 1, 2].tolist() == asked


def test_no_part_is_read_before_it_is_asked_for_and_calls_go_on() -> None:
    taken: list[int] = []
    positions = Positions(parts(taken))
    assert taken == []
    positions(np.array([1]))
    assert len(taken) == 1
    assert positions(np.array([1, 4]))[:, 0, 0].tolist() == [1, 4]
    assert len(taken) == 2
    assert positions(np.array([6, 8]))[:, 0, 0].tolist() == [6, 8]


@pytest.mark.parametrize(("asked", "missing"), [([3], 3), ([2, 5], 5), ([9, 10], 10), ([20], 20)])
def test_a_step_without_poses_is_named(asked: list[int], missing: int) -> None:
    with pytest.raises(ValueError, match=f"no poses of step {missing},"):
        Positions(parts([]))(np.array(asked))
