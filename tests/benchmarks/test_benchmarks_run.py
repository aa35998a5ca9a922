"""The benchmark works: it times every case and proves what it times. No time limits."""

from __future__ import annotations

import json
from pathlib import Path

from tests.benchmarks.as_process import benchmark


def test_the_engine_benchmark_writes_samples_and_its_proofs(tmp_path: Path) -> None:
    output = tmp_path / "engine.json"
    options = ["--repeats", "1", "--starts", "1"]
    done = benchmark("engine", *options, "--output", str(output))
    assert done.returncode == 0, done.stderr
    found = json.loads(output.read_text())
    rows = {row["name"]: row for row in found["cases"]}
    assert all(len(row["samples"]) == 1 and row["median"] > 0 for row in rows.values())
    assert {name for name, row in rows.items() if row["bar"]} == {"sphere drop", "six-block stack"}
    assert all(name in done.stdout for name in rows)
    # Both drops leave the ball in the same place: the hand-written kernel does no less mechanics.
    assert found["drop_difference_m"] < 1e-9
    # All corners of the six layers ask for a correction in every step that is timed.
    position = found["position_pass"]
    assert position["corrected_contacts"] == position["contacts"] == [24, 24]
    # Every timed step makes all its sweeps: least and greatest are the 22 asked for.
    assert (position["velocity_sweeps"], position["position_sweeps"]) == ([22, 22], [22, 22])
