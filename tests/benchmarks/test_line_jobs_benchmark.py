"""The benchmark of several processes takes ratios of pairs, and says which case is slower."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tests.benchmarks import line_jobs
from tests.benchmarks.line_commands import Cost
from tests.benchmarks.line_jobs import ALLOWED, Pair

# Seconds of one and of two processes. The second pair met a machine that was four times as slow.
PAIRS = [
    Pair(Cost(1.0, 0.9), Cost(0.6, 1.0), 0.1),
    Pair(Cost(4.0, 0.9), Cost(3.2, 1.0), 6.0),
    Pair(Cost(1.0, 0.9), Cost(0.5, 1.0), 0.2),
]


def test_a_ratio_is_the_median_of_those_of_each_pair() -> None:
    found = line_jobs.case_data(PAIRS)
    assert found["wall"] == {"one": 1.0, "several": 0.6, "ratio": 0.6}
    assert found["processor"]["ratio"] == pytest.approx(1.0 / 0.9)
    assert found["load"] == 0.2
    assert found["pairs"][1] == {
        "one": {"wall": 4.0, "processor": 0.9},
        "several": {"wall": 3.2, "processor": 1.0},
        "load": 6.0,
    }


@pytest.mark.parametrize(("ratio", "is_slower"), [(ALLOWED - 0.01, False), (ALLOWED + 0.01, True)])
def test_a_case_is_slower_above_what_runs_differ_by_and_fails_the_check(
    ratio: float,
    is_slower: bool,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def pairs_of(case: object, count: int, jobs: int) -> Sequence[Pair]:
        return [Pair(Cost(1.0, 1.0), Cost(ratio, 2.0), 0.0)] * count

    monkeypatch.setattr(line_jobs, "pairs_of", pairs_of)
    monkeypatch.setattr("sys.argv", ["line_jobs", "--check", "--cases", "drops"])
    assert line_jobs.main() == int(is_slower)
    assert ("slower with 2 jobs: drops" in capsys.readouterr().out) == is_slower
    monkeypatch.setattr("sys.argv", ["line_jobs", "--cases", "drops"])
    assert line_jobs.main() == 0


def test_each_kind_comes_first_in_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[int] = []

    def run(case: object, arguments: object, jobs: int) -> Cost:
        made.append(jobs)
        return Cost(float(jobs), float(jobs))

    monkeypatch.setattr(line_jobs, "run", run)
    pairs = line_jobs.pairs_of(line_jobs.CASES["one cell"], 2, 2)
    assert made == [1, 1, 2, 2, 1]  # the first leaves kernels on disk
    assert [(pair.one.wall, pair.several.wall) for pair in pairs] == [(1.0, 2.0)] * 2
