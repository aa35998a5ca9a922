"""Measures of a cell: a number, a row, or a sentence that says why there is none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from lavendersim.errors import LavenderError
from lavendersim.runner import measured
from lavendersim.runner.measured import measure_cell


class Taken:
    """Values of measures by their names; a text is a reason why there is none."""

    def __init__(self, measures: Any) -> None:
        self.measures = measures

    def row(self, name: str, cell: Any) -> np.ndarray:
        """Return the row of a measure."""
        found = self.measures[name]
        if isinstance(found, str):
            raise LavenderError(found)
        return np.atleast_1d(np.asarray(found, float))


class Cell:
    coordinates: Any = {}  # noqa: RUF012 - of a cell without a sweep
    status = "complete"


@pytest.fixture(autouse=True)
def taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(measured, "Values", Taken)
    monkeypatch.setattr(measured, "applies", lambda spec, coordinates: spec is not None)


def test_one_number_a_row_and_a_reason() -> None:
    specs: Any = {"one": 2.0, "row": [1.0, 2.0], "none": "no contact", "elsewhere": None}
    found = measure_cell(Cell(), specs, None)  # type: ignore[arg-type]
    assert found.values == {"one": 2.0, "row": [1.0, 2.0], "none": "no contact"}
    assert found.always == {}


def test_checks_are_those_of_the_worst_states() -> None:
    class Worst:
        def outcomes(self, status: str, cell: Any) -> dict[str, str]:
            return {"energy": status}

    found = measure_cell(Cell(), {}, Worst())  # type: ignore[arg-type]
    assert found.always == {"energy": "complete"}
