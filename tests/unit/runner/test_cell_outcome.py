"""How a cell ended comes back from its line as it was, NaN and infinities included."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from lavendersim.errors import TraceError
from lavendersim.measures.verdict import Outcome
from lavendersim.runner.accuracy import Accuracy, Worst
from lavendersim.runner.cell_outcome import (
    CellOutcome,
    EndedCell,
    ended_cells,
    note_closed,
    note_measured,
)
from lavendersim.runner.measured import Measured
from lavendersim.runner.run_index import ENDED, note_ended
from lavendersim.trace import LogDigest

LOG = LogDigest(10, 7, "f" * 64)
ACCURACY = Accuracy(1e-3, None, 2, {"cone": Worst(0.1 + 0.2, "floor and ball")})
OUTCOME = CellOutcome(3, "diverged: ball", 17, 1, 2, 3, ACCURACY, LOG)


def test_an_ended_cell_comes_back_to_the_last_bit(tmp_path: Path) -> None:
    outcome = Outcome(False, math.inf, "at most 1", "exact", "first in step 3", True, -0.0)
    values = {"rebound": 0.1, "rows": [1e-300, math.inf], "none": "a text says why"}
    ended = EndedCell(OUTCOME, {3: Measured(values, {"energy": outcome}), 5: Measured({}, {})})
    note_measured(tmp_path / "cells" / "a.mcap", ended)
    assert ended_cells(tmp_path) == {"a.mcap": ended}


def test_a_nan_stays_one(tmp_path: Path) -> None:
    ended = EndedCell(OUTCOME, {0: Measured({"speed": math.nan}, {})})
    note_measured(tmp_path / "cells" / "a.mcap", ended)
    assert math.isnan(ended_cells(tmp_path)["a.mcap"].measured[0].values["speed"])


def test_a_cell_whose_log_was_closed_has_ended_and_is_not_measured(tmp_path: Path) -> None:
    note_closed(tmp_path / "cells" / "a.mcap", OUTCOME)
    assert ended_cells(tmp_path) == {"a.mcap": EndedCell(OUTCOME, {})}


def test_a_line_of_an_older_version_does_not_say_how_a_cell_ended(tmp_path: Path) -> None:
    note_ended(tmp_path / "cells" / "a.mcap", "complete", LOG)
    assert ended_cells(tmp_path) == {}


@pytest.mark.parametrize("line", ["{}", '{"file": "a", "measured": {}}', "[]", "no JSON"])
def test_a_damaged_line_is_reported(tmp_path: Path, line: str) -> None:
    (tmp_path / ENDED).write_text(line + "\n")
    with pytest.raises(TraceError, match=r"ended\.jsonl: damaged"):
        ended_cells(tmp_path)
