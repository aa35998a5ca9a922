"""Measures are taken once a cell, from what is known of it where there is that."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lavendersim.errors import LavenderError
from lavendersim.measures import values as module
from lavendersim.measures.values import Values


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Note every measure that is taken; each is its number twice that of the log."""
    noted: list[Any] = []

    def evaluate(spec: Any, trace: Any) -> float:
        noted.append((spec, trace))
        return 2.0 * float(trace)

    monkeypatch.setattr(module, "evaluate", evaluate)
    return noted


def cell(index: int) -> Any:
    """Return a cell whose log is its index."""
    return SimpleNamespace(index=index, trace=lambda: index)


def test_a_measure_is_taken_once_a_cell(asked: list[Any]) -> None:
    values, cells = Values({"m": "spec"}), [cell(3), cell(4)]  # type: ignore[dict-item]
    rows = [values.row("m", one).tolist() for one in (*cells, *cells)]
    assert rows == [[6.0], [8.0], [6.0], [8.0]]
    assert asked == [("spec", 3), ("spec", 4)]
    assert values.of("m")(cells[0]).tolist() == [6.0]


def test_what_is_known_is_not_taken_again(asked: list[Any]) -> None:
    values = Values({"m": "spec"}, {3: {"m": [1.0, 2.0]}})  # type: ignore[dict-item]
    assert values.row("m", cell(3)).tolist() == [1.0, 2.0]
    assert asked == []
    assert np.ndim(values.row("m", cell(4))) == 1
    assert len(asked) == 1


def test_a_text_says_why_there_is_no_number(asked: list[Any]) -> None:
    values = Values({"m": "spec"}, {3: {"m": "no contact"}})  # type: ignore[dict-item]
    with pytest.raises(LavenderError, match="no contact"):
        values.row("m", cell(3))
    assert asked == []
