"""Pairs of boxes that meet: those of comparing all with all, by either way, each once."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from lavendersim.geometry import meeting_boxes as module
from lavendersim.geometry.meeting_boxes import meeting_boxes


def all_with_all(low: np.ndarray, high: np.ndarray) -> set[tuple[int, int]]:
    meet = np.all((low[:, None] <= high[None]) & (low[None] <= high[:, None]), axis=2)
    return set(zip(*(rows.tolist() for rows in np.nonzero(np.triu(meet, 1))), strict=True))


def found(pairs: tuple[np.ndarray, np.ndarray]) -> set[tuple[int, int]]:
    one = [(min(a, b), max(a, b)) for a, b in zip(*(rows.tolist() for rows in pairs), strict=True)]
    assert len(set(one)) == len(one)
    return set(one)


def boxes(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Boxes dense or sparse, some huge, some without end; of every third scene all just touch."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 120))
    centre = rng.uniform(0, 10.0 ** rng.uniform(-1, 1.2), (count, 3))
    half = rng.uniform(0.1, 1, (count, 3))
    half *= np.where(rng.random((count, 1)) < 0.05, rng.choice([5, 50, np.inf]), 1)
    if seed % 3 == 0:
        centre, half = np.floor(centre), np.full((count, 3), 0.5)
    return centre - half, centre + half


@pytest.mark.parametrize("most", [0, 10**9])  # candidates a box: always by cells, always swept
@pytest.mark.parametrize("seed", range(40))
def test_as_all_with_all(monkeypatch: pytest.MonkeyPatch, seed: int, most: int) -> None:
    monkeypatch.setattr(module, "MOST_SWEPT", most)
    low, high = boxes(seed)
    assert found(meeting_boxes(low, high)) == all_with_all(low, high)


def test_none_and_one_make_no_pair() -> None:
    for count in (0, 1):
        assert found(meeting_boxes(np.zeros((count, 3)), np.ones((count, 3)))) == set()


def test_far_from_the_origin_of_a_small_grid_boxes_are_swept() -> None:
    """Cells of 1e-6 m over 1e9 m cannot be distinguished: 2^50 of them."""
    rng = np.random.default_rng(1)
    low = np.concatenate([rng.uniform(0, 1e-6, (50, 3)), [[1e9, 0, 0]]])
    assert found(meeting_boxes(low, low + 1e-6)) == all_with_all(low, low + 1e-6)


def test_memory_grows_as_the_heap_and_not_as_its_layers() -> None:
    """Of n^3 touching boxes 13 n^3 pairs meet; sweeping one axis looks at some n^5."""

    def peak(count: int) -> float:
        axis = np.arange(count, dtype=float)
        low = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)
        tracemalloc.start()
        meeting_boxes(low, low + 1.0)
        used = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return used / len(low)

    # As many bytes a box at either size, but for the surface: the larger has more pairs inside.
    assert peak(24) <= 1.5 * peak(12)
