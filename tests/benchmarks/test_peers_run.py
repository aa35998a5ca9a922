"""The harness runs without any peer: lavender alone, on a twentieth of a second."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.benchmarks.as_process import benchmark
from tests.benchmarks.peers.measure import Cost, Timing, read_steps
from tests.benchmarks.peers.scenes import tower
from tests.benchmarks.peers.table import as_markdown, spoken

ROOT = Path(__file__).parents[2]


def test_lavender_alone_is_measured_and_a_missing_engine_is_said(tmp_path: Path) -> None:
    output = tmp_path / "peers.json"
    done = benchmark(
        "peers",
        *("--engines", "lavender", "nosuch", "--scenes", "tiny"),
        *("--repeats", "2", "--output", str(output)),
    )
    assert done.returncode == 0, done.stderr
    assert "nosuch does not run here: no adapter" in done.stdout
    found = json.loads(output.read_text())
    cell = found["scenes"]["tiny"]["lavender"]
    assert not cell["failure"]
    # 12 steps of 1/240 s at rest: nothing moves and nothing sinks.
    assert max(cell["errors"].values()) < 1e-9
    runs = cell["blocks_steps_wall_ns_processor_ns"]
    assert len(runs) == 2
    assert [sum(row[0] for row in run) for run in runs] == [12, 12]
    assert cell["us_per_step"] > 0.0
    assert as_markdown(found).count("\n| tiny | lavender |") == 1


def test_without_any_engine_the_harness_says_so() -> None:
    done = benchmark("peers", "--engines", "nosuch")
    assert done.returncode == 2
    assert done.stderr.count("does not run here") == 1


def test_one_disturbed_run_of_three_does_not_show() -> None:
    quiet = np.array([[24, 24_000, 24_000], [24, 48_000, 48_000]])
    disturbed = quiet.copy()
    disturbed[1, 1] = 9_000_000
    cost = Cost.of([Timing(quiet), Timing(disturbed), Timing(quiet)])
    assert cost == pytest.approx((1.5, 1.5, 2.0))  # [us]


def test_every_state_of_the_last_second_is_read() -> None:
    steps = read_steps(tower(2, 3.0), every_step=False)
    assert set(range(480, 721)) <= set(steps)
    assert {0, 120} <= set(steps)  # the start, and where drift counts from
    assert len(steps) < 300


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("overlap_m", 1.62e-5, "overlap 16.2 um"),
        ("creep_m_s", 3e-7, "creep 0.3 um/s"),
        ("drift_m", 0.00153, "drift 1.53 mm"),
        ("rod_m_s", 3.37, "rod 3.37 m/s"),
        ("stands", True, "stands"),
        ("stands", False, "FALLEN (stands: no)"),
        ("apex_e0.5_240Hz", 0.007, "apex e0.5 240Hz 0.7 %"),
        ("tunnelled_of_64", 12, "tunnelled of 64 12"),
    ],
)
def test_a_measure_is_said_with_its_unit(name: str, value: float, said: str) -> None:
    assert spoken(name, value) == said
