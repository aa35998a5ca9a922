"""Results come back as they were written, to the byte; what are none are refused by a sentence."""

from __future__ import annotations

import dataclasses
import json
import math
import re
from pathlib import Path
from typing import Any

import pytest

from lavendersim.errors import TraceError
from lavendersim.measures.verdict import Verdict
from lavendersim.runner.run_results import CellResult, RunResults, read_results
from lavendersim.runner.run_tables import FORMER_NAMES

VERDICT = Verdict("low", "low at e=1", True, 0.5, "at most 1 m", "none", "", "a.mcap", False, 0.5)
WORST = {"worst_cone": math.inf, "worst_cone_contact": "a and b", "worst_dissipation": None}
CELLS = (
    CellResult(0, "e=0", "complete", 10, {"h": 1.5}, 2.0, 0.5, 0.1, 1e-9, 1e-10, 0, WORST),
    CellResult(1, "e=1", "diverged", 30, {"h": [1, math.nan]}, 4.0, 0.1, 0.0, None, math.nan, 2),
    CellResult(2, "e=2", "complete", 0, {"h": "no contact"}, 0.0, 0.0, 0.0, None, 0.0, 0),
)
RESULTS = RunResults("drop", False, None, CELLS, 0.1, (VERDICT,), True, {"rows": [], "x": math.nan})
ROW = {
    **{"index": 0, "label": "", "status": "complete", "steps": 1, "measures": {}},
    **{"physics_us_per_step": 1.0, "logging_us_per_step": 1.0, "compile_s": 0.0},
    **{"tolerance": None, "worst_residual": 0.0, "not_converged_steps": 0},
}
FORMER = {name: former for former, name in FORMER_NAMES.items()}
TABLE = {"experiment": "drop", "cells": [ROW], "checks": [], "passed": True}


def test_what_is_written_is_read_and_written_to_the_same_bytes(tmp_path: Path) -> None:
    RESULTS.write(tmp_path / "one.json")
    read = read_results(tmp_path / "one.json")
    read.write(tmp_path / "other.json")
    assert (tmp_path / "one.json").read_bytes() == (tmp_path / "other.json").read_bytes()
    # NaN is not equal to itself; all else of the first row is
    assert read.cells[0] == CELLS[0]
    assert math.isnan(read.cells[1].worst_residual)
    assert read.cells[1].measures["h"][0] == 1
    assert math.isnan(read.cells[1].measures["h"][1])
    assert read.cells[2].measures == {"h": "no contact"}
    assert read.checks[0].message == VERDICT.message


def test_the_file_has_a_text_for_a_number_that_json_does_not_have(tmp_path: Path) -> None:
    RESULTS.write(tmp_path / "one.json")
    table = json.loads((tmp_path / "one.json").read_text(), parse_constant=pytest.fail)
    assert table["cells"][0]["worst_cone"] == "inf"
    assert table["cells"][1]["measures"] == {"h": [1, "nan"]}
    assert table["overheads"]["x"] == "nan"
    assert list(table) == [
        *("experiment", "reduced", "solver", "cells", "compile_s", "checks", "passed", "overheads")
    ]


def test_by_key_results_are_the_plain_data_of_the_file(tmp_path: Path) -> None:
    RESULTS.write(tmp_path / "one.json")
    table = json.loads((tmp_path / "one.json").read_text())
    assert dict(RESULTS) == table
    assert RESULTS["cells"][1]["worst_residual"] == "nan"
    assert (len(RESULTS), RESULTS.get("nothing"), "passed" in RESULTS) == (8, None, True)


def test_what_took_all_its_iterations_is_a_column_only_then(tmp_path: Path) -> None:
    often = dataclasses.replace(CELLS[0], at_limit={"gjk_not_converged": 3})
    dataclasses.replace(RESULTS, cells=(often, CELLS[0])).write(tmp_path / "one.json")
    rows = json.loads((tmp_path / "one.json").read_text())["cells"]
    assert [row.get("gjk_not_converged") for row in rows] == [3, None]
    assert read_results(tmp_path / "one.json").cells == (often, CELLS[0])


def test_results_cannot_be_changed() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        CELLS[0].steps = 3  # type: ignore[misc]
    with pytest.raises(dataclasses.FrozenInstanceError):
        RESULTS.passed = False  # type: ignore[misc]


def test_a_cost_of_a_step_is_the_mean_over_all_steps() -> None:
    assert RESULTS.mean_per_step("physics_us_per_step") == (10 * 2.0 + 30 * 4.0) / 40
    without = dataclasses.replace(RESULTS, cells=CELLS[2:])
    assert math.isnan(without.mean_per_step("physics_us_per_step"))


def test_results_of_an_older_version_have_former_names_and_fewer_columns(tmp_path: Path) -> None:
    row = {key: value for key, value in ROW.items() if key != "not_converged_steps"}
    check = {"name": "low", "node": "low", "passed": True, "measured": "nan", "expected": "1"}
    check |= {"tolerance": "none", "message": "low: passed"}
    table = TABLE | {"cells": [row | {FORMER["not_converged_steps"]: 3}], "checks": [check]}
    (tmp_path / "results.json").write_text(json.dumps(table))
    read = read_results(tmp_path / "results.json")
    assert (read.cells[0].not_converged_steps, read.cells[0].violations) == (3, {})
    assert (read.checks[0].message, read.checks[0].follows) == ("low: passed", False)
    assert math.isnan(read.checks[0].margin)
    assert (read.reduced, read.solver, read.compile_s, read.overheads) == (False, None, None, None)


def test_what_versions_before_residuals_did_not_record_is_unknown_and_not_zero(
    tmp_path: Path,
) -> None:
    accuracy = ("tolerance", "worst_residual", "not_converged_steps")
    row = {key: value for key, value in ROW.items() if key not in accuracy}
    (tmp_path / "results.json").write_text(json.dumps(TABLE | {"cells": [row]}))
    (read,) = read_results(tmp_path / "results.json").cells
    assert (read.tolerance, read.not_converged_steps) == (None, None)
    assert math.isnan(read.worst_residual)
    assert (read.status, read.steps, read.physics_us_per_step) == ("complete", 1, 1.0)


@pytest.mark.parametrize(
    ("table", "why"),
    [
        ({"cells": []}, "it has no 'passed'"),
        (TABLE | {"passed": "yes"}, "passed is no yes or no: 'yes'"),
        ({"cells": [{"index": 0}], "passed": True}, "it has no table 'cells'"),
        (TABLE | {"cells": [ROW | {"measures": 3}]}, "'int' object has no attribute 'items'"),
        (TABLE | {"cells": [ROW | {"steps": "few"}]}, "invalid literal for int()"),
        (TABLE | {"cells": [{k: ROW[k] for k in ROW if k != "steps"}]}, "it has no 'steps'"),
        (TABLE | {"checks": 3}, "'int' object is not iterable"),
        (TABLE | {"cells": [ROW | {"status": 3}]}, "status is no text: '3'"),
        (TABLE | {"cells": [ROW | {"index": True}]}, "index is no count: 'True'"),
        (TABLE | {"checks": [VERDICT.row | {"follows": "no"}]}, "follows is no yes or no: 'no'"),
        (TABLE | {"checks": [VERDICT.row | {"passed": 1}]}, "passed is no yes or no: '1'"),
        (TABLE | {"checks": [VERDICT.row | {"node": ["n"]}]}, "node is no text: "),
    ],
)
def test_what_are_no_results_is_refused(tmp_path: Path, table: dict[str, Any], why: str) -> None:
    path = tmp_path / "results.json"
    path.write_text(json.dumps(table))
    with pytest.raises(TraceError, match=re.escape(f"{path}: damaged: {why}")):
        read_results(path)
