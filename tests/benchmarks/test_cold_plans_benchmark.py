"""The benchmark of compilation tells what was compiled from what was there."""

from __future__ import annotations

import json
from pathlib import Path

from tests.benchmarks.as_process import benchmark


def test_a_second_plan_takes_over_what_it_shares(tmp_path: Path) -> None:
    """Free rotation has the logs and the poses of a drop without a contact, and a spin."""
    configs = [
        f"configs/{name}.yaml" for name in ("scenes/free_rotation", "chapter/normal_impulse")
    ]
    output = tmp_path / "plans.json"
    done = benchmark("cold_plans", *configs, "--json", str(output))
    assert done.returncode == 0, done.stderr
    first, second = json.loads(output.read_text())
    for row in (first, second):
        assert row["config"] in done.stdout
        # Alone nothing was there: whatever is in memory was made.
        assert (row["alone"]["found"], row["alone"]["loaded"]) == (0, 0)
        made, found = row["after"]["made"], row["after"]["found"]
        assert made + found == row["alone"]["made"]
    assert first["after"]["found"] == 0
    assert second["after"]["found"] > 0
