"""A signal ends a run cleanly: logs are closed with what was simulated, and no process is left."""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from lavender_cli.going_on import interruptible
from lavendersim import open_run, open_trace
from lavendersim.errors import TraceError
from lavendersim.runner.interruption import (
    Interrupted,
    deferred,
    forked_to_end,
    handled,
    raise_noted,
)
from tests.runner.small_configs import write

# Fifty million steps: minutes on any machine.
ENDLESS = """\
scene:
  bodies:
    floor: {{shape: {{kind: plane}}}}
    ball:
      shape: {{kind: sphere, radius: 0.1}}
      mass: 1.0
      position: [0, 0, 0.5]
      surface: {{restitution: 0.9}}
numerics: {{timestep: 1/100000}}
duration: 500
sweep:
  duration: {{path: duration, values: {durations}}}
"""
SIGNALS = [name for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
WAIT = 120.0  # [s] for what takes some

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")


def logs_with_steps(runs: Path, count: int) -> list[Path]:
    """Wait until so many logs have steps in them; kernels may have to be compiled before."""
    until = time.monotonic() + WAIT
    while time.monotonic() < until:
        found = [log for log in runs.glob("*/cells/*.mcap") if log.stat().st_size > 200_000]
        if len(found) >= count:
            return found
        time.sleep(0.02)
    raise AssertionError(f"no {count} logs have steps after {WAIT} s")


def assert_nobody_is_left(group: int) -> None:
    """Python's own tracker of resources ends a moment after those that it tracks for."""
    until = time.monotonic() + 20.0
    while time.monotonic() < until:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return
        time.sleep(0.02)
    raise AssertionError("a process is left after 20 s")


def interrupted(runs: Path, name: str, command: list[str], logs: int) -> tuple[Path, str]:
    """Interrupt a run when so many logs have steps; returns its directory and what it says."""
    process = subprocess.Popen(
        [sys.executable, *command],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,  # its process group has nothing of this one
    )
    try:
        logs_with_steps(runs, logs)
        process.send_signal(getattr(signal, name))
        _, said = process.communicate(timeout=WAIT)
    finally:
        process.kill()
    assert process.returncode == 130, said
    assert_nobody_is_left(process.pid)
    (directory,) = (path for path in runs.iterdir() if path.name != "latest")
    return directory, said


@pytest.mark.parametrize("name", SIGNALS)
def test_a_run_that_is_interrupted_closes_its_log_and_says_so(tmp_path: Path, name: str) -> None:
    runs, config = tmp_path / "runs", write(tmp_path, ENDLESS.format(durations="[500, 501]"))
    command = ["-m", "lavender_cli.main", "run", str(config), "--yes", "--runs", str(runs)]
    directory, said = interrupted(runs, name, [*command, "--tag", "a", "--plot"], logs=1)
    assert f"interrupted by {name}: 0 of 2 cells are whole, {directory}\n" in said
    assert f"go on with: lavender run {config} --resume --runs {runs} --tag a --plot\n" in said
    (log,) = (directory / "cells").glob("*.mcap")
    with pytest.raises(TraceError, match=f"interrupted by {name} after step"):
        open_trace(log)
    trace = open_trace(log, allow_incomplete=True)
    # The last step that was made is in the log, none is missing before it.
    last = int(trace.step["step"][-1])
    assert trace.status.startswith(f"interrupted by {name} after step {last} (t = ")
    assert trace.step["step"].tolist() == list(range(last + 1))
    cells = open_run(directory).cells
    assert [cell.status == "pending" for cell in cells] == [False, True]
    assert cells[0].status == trace.status


# The first cell of a plan runs in the process that asks, the others in processes of their own.
IN_PROCESSES = """
import sys
import lavendersim
from lavendersim.runner import executor
executor.WORTH_PROCESSES = 0.0
try:
    lavendersim.run(sys.argv[1], root=sys.argv[2], jobs=2)
except KeyboardInterrupt as end:
    sys.exit(130)
"""


def test_other_processes_close_their_logs(tmp_path: Path) -> None:
    runs = tmp_path / "runs"
    config = write(tmp_path, ENDLESS.format(durations="[0.001, 500, 501]"))
    command = ["-c", IN_PROCESSES, str(config), str(runs)]
    directory, _ = interrupted(runs, "SIGTERM", command, logs=2)
    short, *long = (cell.status for cell in open_run(directory).cells)
    assert short == "complete"
    assert all(status.startswith("interrupted by SIGTERM after step ") for status in long), long
    logs = [open_trace(log, allow_incomplete=True) for log in directory.glob("cells/*.mcap")]
    assert sorted(trace.status for trace in logs) == sorted([short, *long])


def lost(number: int) -> None:
    """Let a signal come within a callback from C, as LLVM calls one: no exception leaves it."""
    come = ctypes.CFUNCTYPE(None)(lambda: os.kill(os.getpid(), number))
    come()


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_a_signal_that_the_compiler_loses_is_what_ends_the_run() -> None:
    """The compiler then fails for want of what it was to be handed."""

    def compiled() -> None:
        lost(signal.SIGTERM)
        raise RuntimeError("no compiled object yet")

    with pytest.raises(Interrupted, match="by SIGTERM"), handled():
        compiled()
    with pytest.raises(RuntimeError, match="of its own"), handled():
        raise RuntimeError("of its own")


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_a_signal_that_the_compiler_loses_ends_the_next_cell() -> None:
    with handled():
        lost(signal.SIGTERM)
        with deferred() as signalled:
            assert signalled() == "SIGTERM"
        with pytest.raises(Interrupted, match="by SIGTERM"):
            raise_noted()
    with handled(), deferred() as signalled:
        assert signalled() == ""


@pytest.mark.parametrize(("name", "ends"), [("SIGINT", False), ("SIGTERM", True)])
def test_a_process_that_is_forked_while_signals_are_noted_ends_by_them(
    name: str, ends: bool
) -> None:
    """But for Ctrl-C, which is for the one that forked; that one hears of it afterwards."""
    with handled():
        with deferred():
            os.kill(os.getpid(), getattr(signal, name))
            child = os.fork()
            if not child:
                os._exit(forked_to_end())
            _, status = os.waitpid(child, 0)
        with pytest.raises(Interrupted, match=name):
            raise_noted()
    assert os.waitstatus_to_exitcode(status) == ends
    raise_noted()  # once


def forked(does: Callable[[], int]) -> int:
    """Fork a process that does this; return its number. It ends with 99 where that raises."""
    child = os.fork()
    if child:
        return child
    code = 99
    try:
        code = does()
    finally:
        os._exit(code)


def test_signals_to_a_process_that_is_just_forked_end_it_without_a_word() -> None:
    """As many as come before it begins; after that the next one ends it by default."""

    def noting() -> int:
        for _ in range(3):
            os.kill(os.getpid(), signal.SIGTERM)
        return forked_to_end()

    def beginning() -> int:
        forked_to_end()
        os.kill(os.getpid(), signal.SIGTERM)
        return 0

    with handled():
        with deferred():
            ends = [os.waitpid(forked(one), 0)[1] for one in (noting, beginning)]
        raise_noted()  # nothing came to this one
    assert [os.waitstatus_to_exitcode(end) for end in ends] == [1, -signal.SIGTERM]


def _raw_object_cache_getbuffer(number: int) -> str:
    """Stand for llvmlite's answer to LLVM, by its name."""
    os.kill(os.getpid(), number)
    return "an object"


def test_what_llvm_waits_for_is_not_cut_off() -> None:
    """Without an answer LLVM ends the process by SIGSEGV; the next cell ends the run instead."""
    with handled():
        assert _raw_object_cache_getbuffer(signal.SIGTERM) == "an object"
        with deferred() as signalled:
            assert signalled() == "SIGTERM"
        with pytest.raises(Interrupted, match="by SIGTERM"):
            raise_noted()


@pytest.mark.parametrize("name", SIGNALS)
@pytest.mark.parametrize("translates", [False, True])
def test_a_signal_before_the_first_cell_prints_the_command(
    name: str, translates: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    """A library that is called back may make another exception of it."""

    def planned() -> None:
        try:
            os.kill(os.getpid(), getattr(signal, name))
        except KeyboardInterrupt as end:
            if translates:
                raise ValueError(f"no JSON: {end}") from None
            raise

    with pytest.raises(KeyboardInterrupt), interruptible("lavender run a.yaml --resume"):
        planned()
    said = f"interrupted by {name}\ngo on with: lavender run a.yaml --resume\n"
    assert capsys.readouterr().err == said
