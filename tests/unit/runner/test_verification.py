"""A run compared with its logs: every table that says something else is named with both."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.errors import TraceError
from lavendersim.measures.own_file import NoSourceError
from lavendersim.measures.verdict import Verdict
from lavendersim.runner import verification
from lavendersim.runner.judge_again import JudgedAgain
from lavendersim.runner.measured import Measured
from lavendersim.runner.run_results import CellResult, RunResults
from lavendersim.runner.verification import problems_of


def verdict(measured: float = 1.0, passed: bool = True, path: str = "here") -> Verdict:
    return Verdict("n", "n at e=1", passed, measured, "at most 2", "none", f"{path} said", path)


def cell(index: int = 0, status: str = "complete", damage: str = "") -> Any:
    return SimpleNamespace(
        index=index,
        label=f"e={index}",
        status=status,
        damage=lambda: damage,
        config=None,
        release=lambda: None,
    )


def row(measures: dict[str, Any], status: str = "complete") -> CellResult:
    return CellResult(0, "e=0", status, 1, measures, 0.0, 0.0, 0.0, None, 0.0, 0)


@pytest.fixture
def judged(monkeypatch: pytest.MonkeyPatch) -> Any:
    def give(again: JudgedAgain | Exception, tables: list[str] = []) -> None:  # noqa: B006
        def judge(run: Any) -> JudgedAgain:
            if isinstance(again, Exception):
                raise again
            return again

        monkeypatch.setattr(verification, "judge_again", judge)
        monkeypatch.setattr(verification, "_tables", lambda run: iter(tables))
        monkeypatch.setattr(verification, "list_runs", lambda path: [])

    return give


def run(results: RunResults | None) -> Any:
    known: dict[str, Any] = {"path": Path("run"), "not_understood": ""}
    return SimpleNamespace(finished=results is not None, results=lambda: results, **known)


def results(cells: list[CellResult], *checks: Verdict, passed: bool = True) -> RunResults:
    return RunResults("a", False, None, cells, None, checks, passed)


def again(values: dict[str, Any], *checks: Verdict, cells: list[Any] | None = None, damaged: list[str] | None = None) -> JudgedAgain:  # noqa: E501  # fmt: skip
    return JudgedAgain(cells or [cell()], [Measured(values, {})], list(checks), [], damaged or [])


def test_a_run_that_is_as_it_was_has_no_problem_wherever_it_lies(judged: Any) -> None:
    judged(again({"m": 1.5, "nan": float("nan")}, verdict(path="there")))
    kept = results([row({"m": 1.5, "nan": float("nan")})], verdict(path="here"))
    assert list(problems_of(run(kept))) == []


@pytest.mark.parametrize(
    ("kept", "said"),
    [
        (row({"m": 2.5}), "cell 0 (e=0): m is 2.5, its log gives 1.5"),
        (row({}), "cell 0 (e=0): m is 'nothing', its log gives 1.5"),
        (row({"m": 1.5}, "diverged"), "cell 0 (e=0): 'diverged', its log says 'complete'"),
    ],
)
def test_a_table_that_says_something_else_is_named(
    judged: Any, kept: CellResult, said: str
) -> None:
    judged(again({"m": 1.5}, verdict()))
    (found,) = problems_of(run(results([kept], verdict())))
    assert found == f"{Path('run') / 'results.json'}: {said}"


@pytest.mark.parametrize(
    ("checks", "passed", "words"),
    [
        ((verdict(measured=3.0),), True, "n at e=1: judged again it is another verdict"),
        ((), True, "judged again the run has another verdict"),
        ((verdict(),), False, "judged again the run has another verdict"),
    ],
)
def test_other_verdicts_are_named(judged: Any, checks: Any, passed: bool, words: str) -> None:
    judged(again({"m": 1.5}, verdict()))
    found = list(problems_of(run(results([row({"m": 1.5})], *checks, passed=passed))))
    assert [line.split(": ", 1)[1] for line in found] == [words]


def test_of_a_damaged_log_only_that_is_said(judged: Any) -> None:
    judged(again({"m": 9.0}, verdict(passed=False), cells=[cell(damage="cut")], damaged=["a.mcap: cut"]))  # noqa: E501  # fmt: skip
    assert list(problems_of(run(results([row({"m": 1.5})], verdict())))) == ["a.mcap: cut"]


def test_a_run_that_did_not_finish_says_how_far_it_came(judged: Any) -> None:
    judged(again({}, cells=[cell(0), cell(1, damage="cut")], damaged=["1.mcap: cut"]))
    assert list(problems_of(run(None))) == [
        "1.mcap: cut",
        "run: did not finish: 1 of 2 logs are whole",
    ]


def test_tables_that_fail_their_digest_are_all_that_is_looked_at(judged: Any) -> None:
    judged(TraceError("never asked"), tables=["results.json: changed"])
    assert list(problems_of(run(None))) == ["results.json: changed"]


def test_what_cannot_be_judged_is_a_problem_but_a_measure_nobody_named_is_none_of_the_run(
    judged: Any,
) -> None:
    judged(TraceError("no log at all"))
    assert list(problems_of(run(None))) == ["no log at all"]
    judged(NoSourceError("measures.py"))
    with pytest.raises(NoSourceError):
        list(problems_of(run(None)))
