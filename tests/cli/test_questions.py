"""What is asked on a terminal, a pseudo-terminal here, and what becomes of each answer."""

from __future__ import annotations

import os
import select
import shutil
import signal
import sys
from pathlib import Path

import pytest

from lavendersim.runner import Run, list_runs, run
from tests.runner.small_configs import write

if sys.platform == "win32":
    pytest.skip("pseudo-terminals are of POSIX", allow_module_level=True)

import pty

QUESTION = b"Remove 1 run, "
# [s] without a word, after which the key is pressed again: its meaning is lost where it comes while
# the terminal passes from lines to single characters.
AGAIN = 10.0


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with two runs of one config."""
    folder = tmp_path_factory.mktemp("runs")
    config = write(folder)
    for _ in range(2):
        run(config, folder / "runs")
    return folder / "runs"


@pytest.fixture
def runs(made: Path, tmp_path: Path) -> Path:
    shutil.copytree(made, tmp_path / "runs", symlinks=True)
    return tmp_path / "runs"


def on_terminal(runs: Path, answer: bytes, *options: str) -> tuple[int, str]:
    """Answer `lavender rm` of all runs but the newest; returns its exit code and what it says."""
    words = ["-m", "lavender_cli.main", "rm", "--larger", "1kB", "--runs", str(runs), *options]
    process, terminal = pty.fork()
    if process == 0:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        os.execv(sys.executable, [sys.executable, *words])
    said, asked = b"", False
    while True:
        if asked and not select.select([terminal], [], [], AGAIN)[0]:
            os.write(terminal, answer)
        try:
            part = os.read(terminal, 4096)
        except OSError:  # the other end is closed
            break
        if not part:
            break
        said += part
        if not asked and QUESTION in said and b"[y/N]: " in said:
            asked = True
            os.write(terminal, answer)
    os.close(terminal)
    _, status = os.waitpid(process, 0)
    assert asked == (not options), said.decode()
    return os.waitstatus_to_exitcode(status), said.decode()


def left(runs: Path) -> list[Run]:
    return list_runs(runs)


def test_what_is_meant_is_shown_and_goes_with_a_yes(runs: Path) -> None:
    older, newer = left(runs)
    code, said = on_terminal(runs, b"y\n")
    assert code == 0
    assert (
        said.index(older.path.name) < said.index("Remove 1 run, ") < said.index("removed 1 run, ")
    )
    assert newer.path.name not in said
    assert [one.path for one in left(runs)] == [newer.path]


@pytest.mark.parametrize("answer", [b"n\n", b"\n"])
def test_without_a_yes_nothing_goes(runs: Path, answer: bytes) -> None:
    code, said = on_terminal(runs, answer)
    assert code == 0
    assert "nothing is removed" in said
    assert len(left(runs)) == 2


@pytest.mark.parametrize("answer", [b"\x03", b"\x04"], ids=["Ctrl-C", "end of input"])
def test_an_interrupted_question_removes_nothing(runs: Path, answer: bytes) -> None:
    code, said = on_terminal(runs, answer)
    assert code == 130
    assert said.rstrip().endswith("interrupted")
    assert len(left(runs)) == 2


def test_who_says_yes_is_not_asked(runs: Path) -> None:
    code, _ = on_terminal(runs, b"", "--yes")
    assert code == 0
    assert len(left(runs)) == 1
