"""Every case by every solver: one case's end is not the others', and what is put to them."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from lavendersim.errors import UsageError
from lavendersim.experiment import load_experiment_text
from lavendersim.runner.matrix_entry import Entry
from lavendersim.runner.solver_matrix import (
    Case,
    CaseAndSolver,
    cases_of,
    chosen,
    entries,
    make_entry,
)

SCENE = """\
scene: {bodies: {ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 1]}}}
"""


def case(name: str, path: Path = Path("none.yaml")) -> Case:
    return Case(name, path, False, "")


def dies_of_two(pair: CaseAndSolver) -> Entry:
    """Stand in for `make_entry`: the second case kills its process, as memory that is full may."""
    if pair.case.name == "two":
        os._exit(3)
    if pair.case.name == "one":
        time.sleep(1.0)  # still at work beside the second when that dies
    return Entry(pair.case.name, pair.solver, "passes")


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_case_whose_process_dies_loses_no_other(jobs: int) -> None:
    cases = [case(name) for name in ("one", "two", "three", "four")]
    made = list(entries(cases, ["jacobi"], jobs=jobs, make=dies_of_two))
    assert len(made) == 4
    assert {one.case: one.verdict for one in made} == {
        **{"one": "passes", "two": "died", "three": "passes", "four": "passes"}
    }


def test_a_case_that_a_solver_cannot_take_is_refused_with_the_reason(tmp_path: Path) -> None:
    config = tmp_path / "relaxed.yaml"
    config.write_text(f"{SCENE}duration: 0.1\nalways: {{}}\nnumerics: {{over_relaxation: 1.5}}\n")
    one = make_entry(CaseAndSolver(case("relaxed", config), "jacobi", tmp_path / "runs"))
    assert (one.verdict, one.run, one.fine) == ("refused", None, False)
    assert one.why == "over_relaxation: jacobi treats all contacts at once; expected 1"
    assert not (tmp_path / "runs").exists()


def test_solvers_are_named_once_each_and_all_begins_with_the_default() -> None:
    everyone = chosen(["all"])
    assert everyone[0] == "adaptive"
    assert len(set(everyone)) == len(everyone) > 5
    assert chosen(["jacobi, adaptive", "jacobi"]) == ("jacobi", "adaptive")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("jacoby", 'no solver is called "jacoby"; did you mean "jacobi"?'),
        ("gauss", 'no solver is called "gauss"; did you mean'),
        ("", 'no solver is called ""; valid here: adaptive,'),
    ],
)
def test_an_unknown_solver_is_reported_with_the_nearest(name: str, said: str) -> None:
    with pytest.raises(UsageError) as error:
        chosen([name])
    assert str(error.value).startswith(said)
    assert error.value.exit_code == 2


def test_a_case_is_called_by_its_folder_and_its_file() -> None:
    text = f"{SCENE}duration: 0.1\n"
    judged = load_experiment_text(text + "always: {}\n", "tall/tower.yaml")
    silent = load_experiment_text(text, "maps/height.yaml")
    cases, left_out = cases_of([judged, silent])
    assert [one.name for one in cases] == ["tall/tower"]
    assert left_out == {"maps/height": "judges nothing"}
