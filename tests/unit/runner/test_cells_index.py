"""The index of a run comes back as it was written; what is no index is refused by a sentence."""

from __future__ import annotations

import dataclasses
import json
import re
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from lavendersim.config_options import ConfigOptions
from lavendersim.errors import TraceError
from lavendersim.runner.cells_index import (
    CellsIndex,
    IndexRow,
    read_index,
    swept_values,
    with_ended,
    write_index,
)
from lavendersim.runner.run_index import ENDED
from lavendersim.trace import LogDigest

DIGEST = LogDigest(12, 0x00AB, "f" * 64)
ROWS = (
    IndexRow(0, "e=0.5", "cells/a.mcap", "complete", "c" * 64, DIGEST, {"e": 0.5}),
    IndexRow(1, "e=1", "cells/b.mcap", config="d" * 64, coordinates={"e": 1}),
)
OPTIONS = ConfigOptions(reduced=True, solver="jacobi", overrides=("a=1",), divisor=2)
ROW = {"index": 0, "label": "", "file": "cells/a.mcap", "status": "pending"}


@pytest.mark.parametrize("options", [ConfigOptions(), OPTIONS])
def test_an_index_comes_back_as_it_was_written(tmp_path: Path, options: ConfigOptions) -> None:
    index = CellsIndex("drop", "how high?", options, ROWS)
    write_index(tmp_path / "cells.json", index)
    assert read_index(tmp_path / "cells.json") == index


def test_a_row_cannot_be_changed() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        ROWS[1].status = "complete"  # type: ignore[misc]


def test_a_cell_that_ended_meanwhile_has_its_status_and_digest(tmp_path: Path) -> None:
    log = {"bytes": 12, "crc32": "000000ab", "sha256": "f" * 64}
    line = json.dumps({"file": "b.mcap", "status": "complete", "log": log})
    (tmp_path / ENDED).write_text(line + "\n")
    first, second = with_ended(ROWS, tmp_path)
    assert first == ROWS[0]
    assert (second.status, second.expected.digest) == ("complete", DIGEST)
    assert second.expected.config == "d" * 64


def test_an_index_of_an_older_version_says_nothing_of_its_logs(tmp_path: Path) -> None:
    path = tmp_path / "cells.json"
    path.write_text(json.dumps({"experiment": "drop", "cells": [ROW]}))
    index = read_index(path)
    (row,) = index.cells
    assert (index.has_digests, index.question, index.options) == (False, "", ConfigOptions())
    assert (row.expected.config, row.expected.digest) == ("", None)


@pytest.mark.parametrize(
    ("table", "why"),
    [
        ({"cells": [ROW]}, "it has no 'experiment'"),
        ({"experiment": "drop", "cells": [{"index": 0}]}, "it has no table 'cells'"),
        ({"experiment": "drop", "cells": [ROW | {"log": {"bytes": 1}}]}, "it has no 'crc32'"),
        ({"experiment": "drop", "cells": [ROW | {"file": 3}]}, "file of a cell is no text: 3"),
        ({"experiment": "drop", "overrides": 3, "cells": [ROW]}, "'int' object is not iterable"),
    ],
)
def test_what_is_no_index_is_refused(tmp_path: Path, table: dict[str, Any], why: str) -> None:
    path = tmp_path / "cells.json"
    path.write_text(json.dumps(table))
    with pytest.raises(TraceError, match=re.escape(f"{path}: damaged: {why}")):
        read_index(path)


def test_coordinates_that_an_older_index_lacks_stand_in_its_labels(tmp_path: Path) -> None:
    row = ROW | {"label": "e=0.5, timestep=1/480, solver=jacobi"}
    (tmp_path / "cells.json").write_text(json.dumps({"experiment": "a", "cells": [row]}))
    (read,) = read_index(tmp_path / "cells.json").cells
    assert read.coordinates == {"e": 0.5, "timestep": "1/480", "solver": "jacobi"}
    assert swept_values(read.coordinates)["timestep"] == Fraction(1, 480)
    assert swept_values({"a": "1/0", "b": "x/2"}) == {"a": "1/0", "b": "x/2"}
