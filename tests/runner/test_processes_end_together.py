"""Whatever ends a run, its processes end with it and write nothing more."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest
from small_configs import DROPS, write

CELLS = 40
SWEPT = DROPS.replace(
    "values: [0.2, 0.5, 0.8]", f"values: {[round(0.1 + i / 1000, 4) for i in range(CELLS)]}"
).replace("duration: 0.5", "duration: 20")
# Processes that are spawned import it, too: what it patches is patched in all of them.
SCRIPT = """
import sys
from pathlib import Path
import lavendersim
from lavendersim.runner import executor, forking, workers
executor.WORTH_PROCESSES = -1.0
forking.sys = workers.sys = type("system", (), {"platform": sys.argv[4]})
if __name__ == "__main__":
    lavendersim.run(Path(sys.argv[1]), root=Path(sys.argv[2]), jobs=int(sys.argv[3]))
"""
# [s]: a tenth of one, on a machine that has nothing else to do. Those that outlived a run slept on.
WITHIN = 20.0


def files_of(root: Path) -> dict[Path, int]:
    return {path: path.stat().st_size for path in root.rglob("*") if path.is_file()}


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize(
    ("name", "system"),
    [*((name, sys.platform) for name in ("SIGKILL", "SIGTERM", "SIGHUP")), ("SIGKILL", "another")],
)
def test_no_process_outlives_the_one_that_started_it(
    tmp_path: Path, name: str, system: str
) -> None:
    (tmp_path / "script.py").write_text(SCRIPT)
    root = tmp_path / "runs"
    arguments = [tmp_path / "script.py", write(tmp_path, SWEPT), root, 2, system]
    parent = psutil.Process(subprocess.Popen([sys.executable, *map(str, arguments)]).pid)
    children: list[psutil.Process] = []
    begin = time.monotonic()
    while len(list(root.rglob("*.mcap"))) < 3:
        assert time.monotonic() < begin + 60.0
        assert parent.is_running()
        time.sleep(0.02)
    children = parent.children(recursive=True)
    # two at work; where they are not forked, multiprocessing's resource tracker, too
    started = 2 + (system != "linux")
    assert len(children) == started
    parent.send_signal(getattr(signal, name))
    parent.wait(WITHIN)
    gone, alive = psutil.wait_procs(children, WITHIN)
    for left in alive:
        left.kill()
    assert (len(gone), alive) == (started, [])
    before = files_of(root)
    time.sleep(0.5)
    assert files_of(root) == before
