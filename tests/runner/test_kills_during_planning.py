"""Whatever ends a command while several processes plan its cells, nothing of it is left."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest
from small_configs import DROPS, write

CELLS = 6000  # built and planned in seconds: a signal comes before the first is run
SWEPT = DROPS.replace(
    "values: [0.2, 0.5, 0.8]", f"values: {[round(0.1 + i / 10000, 5) for i in range(CELLS)]}"
)
WITHIN = 30.0  # [s], of a machine that does much besides

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes are forked on Linux")


def planning(folder: Path) -> tuple[subprocess.Popen[str], list[psutil.Process]]:
    """Start a run; return it with the processes that plan its cells."""
    words = ["run", write(folder, SWEPT), "--jobs", 2, "--runs", folder / "runs", "--yes"]
    started = subprocess.Popen(
        [sys.executable, "-m", "lavender_cli.main", *map(str, words)],
        cwd=folder,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    children: list[psutil.Process] = []
    begin = time.monotonic()
    while len(children) < 2:
        assert time.monotonic() < begin + 2.0 * WITHIN
        assert started.poll() is None
        time.sleep(0.002)
        children = psutil.Process(started.pid).children(recursive=True)
    return started, children


@pytest.mark.parametrize(
    ("name", "code", "delay"),  # [s]: while processes start, and while they plan
    [
        ("SIGKILL", -9, 0.0),
        *(("SIGINT", 130, delay) for delay in (0.0, 0.1)),
        *(("SIGTERM", 130, delay) for delay in (0.0, 0.1)),
    ],
)
def test_what_ends_a_command_that_plans_leaves_nothing(
    tmp_path: Path, name: str, code: int, delay: float
) -> None:
    started, children = planning(tmp_path)
    time.sleep(delay)
    assert not (tmp_path / "runs").exists()
    started.send_signal(getattr(signal, name))
    out, err = started.communicate(timeout=WITHIN)
    gone, alive = psutil.wait_procs(children, WITHIN)
    for left in alive:
        left.kill()
    assert (len(gone), alive) == (2, [])
    assert started.returncode == code, err
    assert out == ""
    assert "Traceback" not in err
    assert [path.name for path in tmp_path.iterdir()] == [write(tmp_path, SWEPT).name]
