"""The benchmark of the first result works and would notice a slow one. No time limits."""

from __future__ import annotations

import json
from pathlib import Path

from tests.benchmarks.as_process import benchmark
from tests.benchmarks.first_result import COLD_BAR, WARM_BAR, over


def test_it_writes_samples_of_a_cold_and_a_warm_run(drop: Path, tmp_path: Path) -> None:
    output = tmp_path / "first.json"
    options = [str(drop), "--repeats", "1", "--output", str(output)]
    done = benchmark("first_result", *options)
    assert done.returncode == 0, done.stderr
    found = json.loads(output.read_text())
    row = found["medians"]["drop.yaml"]
    assert found["samples"]["drop.yaml"] == {kind: [value] for kind, value in row.items()}
    assert "drop.yaml" in done.stdout
    # The second run found the kernel: it was at its first step before the first had compiled.
    assert 0.0 < row["warm start"] < row["cold compile"]


def test_a_median_above_its_bar_is_named() -> None:
    medians = {
        "quick": {"imports": 9.0, "warm start": WARM_BAR, "cold compile": COLD_BAR},
        "slow": {"imports": 9.0, "warm start": 2 * WARM_BAR, "cold compile": 2 * COLD_BAR},
    }
    found = {"bars": {"warm start": WARM_BAR, "cold compile": COLD_BAR}, "medians": medians}
    assert [line.split(" ")[0] for line in over(found)] == ["slow:", "slow:"]
    assert over(found | {"medians": {"quick": medians["quick"]}}) == []
