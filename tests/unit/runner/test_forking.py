"""Processes are forked where nobody else's thread runs, and write the logs of this one."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

import lavendersim
from lavendersim.errors import UsageError
from lavendersim.runner import forking, workers
from lavendersim.runner.forking import OWN, may_fork
from lavendersim.runner.run_lock import run_lock
from lavendersim.trace import file_digest, writer
from lavendersim.trace.encode import Streams
from tests.runner.small_configs import write

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes are forked on Linux")

# Shows a run on a terminal or in lines, and says whether a process could be forked meanwhile.
SHOWN = """
import sys
from pathlib import Path
import lavendersim
from lavender_cli import progress
from lavendersim.runner.forking import may_fork
from lavendersim.trace import writer
from lavendersim.trace.encode import Streams
writer.CHUNK_BYTES = Streams(4096, 4096, 4096, 4096)  # so that threads compress
if __name__ == "__main__":
    with getattr(progress, sys.argv[3])("drops") as shown:
        lavendersim.run(Path(sys.argv[1]), root=Path(sys.argv[2]), progress=shown)
        print(may_fork())
"""


@pytest.fixture
def threads(monkeypatch: pytest.MonkeyPatch) -> list[threading.Thread]:
    """Of this process as may_fork sees it, without those of pytest."""
    found = [threading.current_thread()]
    monkeypatch.setattr(threading, "enumerate", lambda: found)
    return found


def test_a_process_of_one_thread_is_forked(threads: list[threading.Thread]) -> None:
    assert may_fork()


@pytest.mark.parametrize(("name", "forked"), [(f"{OWN} trace_0", True), ("a user's", False)])
def test_only_beside_threads_of_this_package(
    name: str, forked: bool, threads: list[threading.Thread]
) -> None:
    threads.append(threading.Thread(name=name))
    assert may_fork() == forked


def test_on_no_other_system(
    threads: list[threading.Thread], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(forking, "sys", type("system", (), {"platform": "darwin"}))
    assert not may_fork()


@pytest.mark.parametrize("shown", ["_terminal", "_lines"])
def test_all_threads_of_a_run_that_is_shown_are_of_this_package(shown: str, tmp_path: Path) -> None:
    (tmp_path / "script.py").write_text(SHOWN)
    arguments = [sys.executable, tmp_path / "script.py", write(tmp_path), tmp_path / "runs", shown]
    done = subprocess.run(
        [*map(str, arguments)], capture_output=True, text=True, check=True, timeout=120.0
    )
    assert done.stdout.split() == ["True"]


@pytest.fixture
def long_logs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let threads compress and sum parts of logs of these sizes, here and in forked processes."""
    monkeypatch.setattr(writer, "CHUNK_BYTES", Streams(4096, 4096, 4096, 4096))
    monkeypatch.setattr(file_digest, "BESIDE", 1024)


@pytest.mark.usefixtures("long_logs")
def test_a_forked_process_writes_the_bytes_of_this_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = lavendersim.run(write(tmp_path), root=tmp_path / "here")
    asked = []
    monkeypatch.setattr(workers, "may_fork", lambda: asked.append(True) or True)
    forked = lavendersim.run(write(tmp_path), root=tmp_path / "forked", jobs=2)
    assert len(asked) == 2
    for one, other in zip(here.run.cells, forked.run.cells, strict=True):
        assert one.path.read_bytes() == other.path.read_bytes()


def test_a_lock_ends_with_the_process_that_took_it(tmp_path: Path) -> None:
    (go, end), (ready, begun) = os.pipe(), os.pipe()
    with run_lock(tmp_path):
        child = os.fork()
        if child == 0:
            os.close(end)
            os.write(begun, b"!")
            os.read(go, 1)  # until the pipe ends
            os._exit(0)
        os.read(ready, 1)
        with pytest.raises(UsageError, match="another process"), run_lock(tmp_path):
            pass
    with run_lock(tmp_path):  # the forked process lives still
        assert os.waitpid(child, os.WNOHANG) == (0, 0)
    for one in (go, end, ready, begun):
        os.close(one)
    os.waitpid(child, 0)
