"""The benchmark of sweeps times what it says, keeps every sample and holds its bars. No limits."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.benchmarks import contact_sweep
from tests.benchmarks.as_process import benchmark

SOLVERS = ("block_gauss_seidel",)  # one, since each has engines of its own to compile


def test_the_benchmark_of_sweeps_writes_samples_of_every_solver_and_scene(tmp_path: Path) -> None:
    output = tmp_path / "sweeps.json"
    size = ["--base", "3", "--layers", "1", "--growth", "3", "--repeats", "2", "--sweeps", "3"]
    done = benchmark("contact_sweep", *size, "--solvers", *SOLVERS, "--output", str(output))
    assert done.returncode == 0, done.stderr
    found = json.loads(output.read_text())
    rows = {(row["scene"], row["solver"]): row for row in found["cases"]}
    assert set(rows) == {(s, k) for s in ("pyramid of 6", "pile of 40") for k in SOLVERS}
    for row in rows.values():
        assert len(row["samples"]) == len(row["once_samples"]) == 2
        assert row["once_median"] > 0
        assert row["contacts"] > 0
        assert row["bar"] == contact_sweep.BARS.get(row["solver"])
        assert f"{row['scene']}, {row['solver']}" in done.stdout
    # three boxes on the floor and three on two each, four corners a pair
    assert rows["pyramid of 6", "block_gauss_seidel"]["contacts"] == 4 * (3 + 6)
    assert [row["solver"] for row in found["growth"]] == list(SOLVERS)
    for text in ("3 sweeps", "PhysX 8-11", found["environment"]["processor"]):
        assert text in done.stdout


def test_every_bar_is_of_a_solver_and_every_solver_is_timed() -> None:
    assert set(contact_sweep.BARS) <= set(contact_sweep.EVERY_SOLVER)
    assert set(SOLVERS) <= set(contact_sweep.EVERY_SOLVER)


@pytest.mark.parametrize(("cost", "exit_code"), [(25.1, 1), (24.9, 0)])
def test_a_cost_above_its_bar_fails_the_check(
    cost: float, exit_code: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    row = {"scene": "pile", "solver": "block_gauss_seidel", "contacts": 8, "bar": 25.0}
    row |= {"median": cost, "samples": [cost], "once_median": 1.0, "compile_s": 0.0}
    found = {"cases": [row], "growth": [], "repeats": 1, "sweeps": 1, "clock": "a clock"}
    found["environment"] = {"processor": "a processor", "cores": 1}
    monkeypatch.setattr(contact_sweep, "measure", lambda *sizes: found)
    monkeypatch.setattr("sys.argv", ["contact_sweep", "--check"])
    assert contact_sweep.main() == exit_code
    monkeypatch.setattr("sys.argv", ["contact_sweep"])
    assert contact_sweep.main() == 0
    assert "pile, block_gauss_seidel" in capsys.readouterr().out


class Slow:
    """Stands for a solver that takes 7 ns a contact, and 5 ns a contact and sweep."""

    name, count, sweeps = "slow", 10, 0

    def run(self, sweeps, now=None):
        self.sweeps = sweeps
        return self.count * (7 + 5 * sweeps)


def test_a_sample_tells_sweeps_from_what_a_solve_costs_once() -> None:
    timed = contact_sweep.Timed("scene", Slow(), [], [])  # type: ignore[arg-type]
    timed.sample(30)
    assert (timed.sweep, timed.once) == ([5.0], [7.0])
