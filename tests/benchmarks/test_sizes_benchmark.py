"""The benchmark of sizes works at a fraction of them, and judging takes no more of a longer log."""

from __future__ import annotations

import json
from pathlib import Path

from tests.benchmarks.as_process import benchmark
from tests.benchmarks.sizes import Case, cases, missed


def test_every_case_is_measured_and_memory_does_not_grow_with_the_log(tmp_path: Path) -> None:
    output = tmp_path / "sizes.json"
    options = ["--share", "0.05", "--repeats", "1", "--output", str(output)]
    done = benchmark("sizes", *options)
    assert done.returncode == 0, done.stderr
    samples = json.loads(output.read_text())["samples"]
    assert list(samples) == [case.name for case in cases(0.05)]
    assert all(seconds > 0.0 and megabytes > 10.0 for ((seconds, megabytes),) in samples.values())
    # 10,000 and 100,000 steps: one part of the log is in memory at a time, of the shorter log all
    # of it is half a part. Before there were parts it was 400 bytes a step, 36 MB more.
    few, many = (samples[f"{steps} steps judged"][0][1] for steps in ("200,000", "2,000,000"))
    assert many - few <= 15.0


def test_a_median_above_its_bar_is_reported() -> None:
    case = Case("plan", "", (), seconds=2.0, megabytes=100.0)
    assert missed(case, [(1.0, 50.0), (2.0, 100.0), (9.0, 900.0)]) == []
    assert missed(case, [(2.5, 150.0)]) == ["plan: 2.5 s, at most 2", "plan: 150.0 MB, at most 100"]
    assert missed(case._replace(seconds=None, megabytes=None), [(9.0, 900.0)]) == []
