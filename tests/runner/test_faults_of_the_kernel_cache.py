"""Runs end well, to the same bits, whatever happens to compiled kernels and leftovers meanwhile.

four at once     four runs of one config in one folder, with a cold cache
cleaned          `lavender doctor --clean` again and again, from a cold cache to the end
vanished         the cache is taken away while the run compiles, and a file put in its place
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from small_configs import RUN, write

from lavendersim.runner.run_directory import open_run
from tests.kept_kernels import of_scenes

RUNS = 4
LIMIT = 300.0  # [s] of a run; one compiles in 10 s of a processor that four share
# Machine code that LLVM has not optimised, in a third of the time: speed is not what is asked.
PLAIN = {"NUMBA_OPT": "0"}


def started(config: Path, root: Path, kernels: Path) -> subprocess.Popen[str]:
    """Begin a run in a new process."""
    return subprocess.Popen(
        [sys.executable, "-P", "-c", RUN, str(config), str(root)],
        env=os.environ | PLAIN | {"LAVENDER_CACHE_DIR": str(kernels)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def ended(process: subprocess.Popen[str]) -> dict[str, Any]:
    """Return what a run says at its end."""
    out, said = process.communicate(timeout=LIMIT)
    assert process.returncode == 0, said
    found: dict[str, Any] = json.loads(out.splitlines()[-1])
    return found


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("four")


@pytest.fixture(scope="module")
def four(folder: Path) -> list[dict[str, Any]]:
    """Run one config four times at once, in one folder, with one cold cache."""
    config = write(folder)
    processes = [started(config, folder / "runs", folder / "kernels") for _ in range(RUNS)]
    return [ended(process) for process in processes]


def test_four_cold_runs_in_one_folder_give_the_same_logs(four: list[dict[str, Any]]) -> None:
    assert [found["logs"] for found in four] == [four[0]["logs"]] * RUNS
    assert len({found["run"] for found in four}) == RUNS


def test_four_cold_runs_leave_one_kernel_four_runs_and_nothing_half(
    four: list[dict[str, Any]], folder: Path
) -> None:
    assert len(of_scenes(folder / "kernels")) == 1
    assert not [*folder.rglob("*unfinished*"), *folder.glob("runs/.latest*")]
    assert all(open_run(found["run"]).finished for found in four)
    latest = open_run(None, folder / "runs")
    assert latest.path.name in {Path(found["run"]).name for found in four}


def meanwhile(process: subprocess.Popen[str], act: Callable[[], None]) -> int:
    """Do something again and again while a run goes on; returns how often."""
    count, begin = 0, time.monotonic()
    while process.poll() is None and time.monotonic() - begin < LIMIT:
        act()
        count += 1
        time.sleep(0.05)
    return count


def test_a_run_under_which_all_is_cleaned_gives_the_same_logs(
    four: list[dict[str, Any]], folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from lavendersim.engine import kernel_store
    from lavendersim.runner.environment import delete_kernels
    from lavendersim.runner.leftovers import clean

    kernels = tmp_path / "kernels"
    kernels.mkdir(mode=0o700)
    monkeypatch.setattr(kernel_store, "directory", lambda: (kernels, ""))
    deleted = 0

    def cleaned() -> None:
        nonlocal deleted
        for current in (True, False):
            found = delete_kernels(current)
            deleted += found.kernels.files
            assert found.why == ""
        clean(tmp_path / "runs")

    process = started(folder / "drops.yaml", tmp_path / "runs", kernels)
    assert meanwhile(process, cleaned) > 8
    assert ended(process)["logs"] == four[0]["logs"]
    assert deleted > 0
    assert open_run(None, tmp_path / "runs").finished


def test_a_run_whose_cache_vanishes_gives_the_same_logs(
    four: list[dict[str, Any]], folder: Path, tmp_path: Path
) -> None:
    kernels = tmp_path / "kernels"
    process = started(folder / "drops.yaml", tmp_path / "runs", kernels)
    gone: list[float] = []

    def taken_away() -> None:
        if not gone and len([*kernels.glob("*.part")]) > 8:
            kernels.rename(tmp_path / "elsewhere")
            kernels.write_text("no directory")
            gone.append(time.monotonic())

    meanwhile(process, taken_away)
    assert ended(process)["logs"] == four[0]["logs"]
    assert gone
    assert kernels.read_text() == "no directory"
    shutil.rmtree(tmp_path / "elsewhere")
