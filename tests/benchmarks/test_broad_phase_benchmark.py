"""The benchmark of the broad phase works, and its scenes are what it says. No time limits."""

from __future__ import annotations

import json
from pathlib import Path

from tests.benchmarks.as_process import benchmark


def test_the_broad_phase_benchmark_writes_samples_and_exponents(tmp_path: Path) -> None:
    output = tmp_path / "broad_phase.json"
    options = ["--repeats", "1", "--counts", "100", "400", "--output", str(output)]
    done = benchmark("broad_phase", *options)
    assert done.returncode == 0, done.stderr
    found = json.loads(output.read_text())
    assert {row["bodies"] for row in found["cases"]} == {100, 400}
    assert all(len(row["samples"]) == 1 and row["median_us"] > 0 for row in found["cases"])
    assert set(found["exponents"]) == {row["scene"] for row in found["cases"]}
    stirred = [row for row in found["cases"] if row["scene"] == "stirred, step"]
    # Neither always nor never: what is timed is the keeping and the making of lists.
    assert all(0.0 < row["rebuilds_per_step"] < 1.0 for row in stirred)
