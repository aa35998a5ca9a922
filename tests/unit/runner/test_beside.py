"""A process beside this one does tasks one after the other; what it does not do is done here."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path

import pytest

from lavendersim.runner import beside
from lavendersim.runner.beside import Beside

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes are forked on Linux")
MANY = 20


@pytest.fixture(autouse=True)
def _two_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fork beside the threads of pytest's own workers, too."""
    monkeypatch.setattr(beside, "_may_fork", lambda: True)


def pid_of(task: int) -> tuple[int, int]:
    return task, os.getpid()


def test_tasks_are_done_in_their_order_by_one_other_process() -> None:
    one: Beside[int, tuple[int, int]] = Beside(pid_of)
    for task in range(MANY):
        one.give(task)
    found = list(one.results())
    one.end()
    assert [task for task, _ in found] == list(range(MANY))
    processes = {process for _, process in found}
    assert len(processes) == 1
    assert os.getpid() not in processes


def test_what_is_in_memory_is_there_without_being_sent() -> None:
    unsendable = lambda: 7  # noqa: E731 - pickle takes no function without a name
    one: Beside[int, int] = Beside(lambda task: task + unsendable())
    one.give(1)
    assert list(one.results()) == [8]
    one.end()


def test_nobody_waits_for_a_result_that_is_not_there(tmp_path: Path) -> None:
    fifo = tmp_path / "go"
    os.mkfifo(fifo)
    one: Beside[int, str] = Beside(lambda task: fifo.read_text())
    one.give(0)
    assert list(one.results(wait=False)) == []
    fifo.write_text("gone on")
    assert list(one.results()) == ["gone on"]
    one.end()


def test_an_exception_is_raised_here() -> None:
    def fail(task: int) -> int:
        if task == 1:
            raise OSError(28, "No space left on device", "figure.png")
        return task

    one: Beside[int, int] = Beside(fail)
    for task in range(3):
        one.give(task)
    results = one.results()
    assert next(results) == 0
    with pytest.raises(OSError, match="No space left") as raised:
        next(results)
    assert (raised.value.errno, raised.value.filename) == (28, "figure.png")
    one.end()


def test_what_a_killed_process_has_not_done_is_done_here() -> None:
    def die(task: int) -> tuple[int, int]:
        if task == 2 and os.getpid() != here:
            os.kill(os.getpid(), signal.SIGKILL)
        return pid_of(task)

    here = os.getpid()
    one: Beside[int, tuple[int, int]] = Beside(die)
    for task in range(4):
        one.give(task)
    found = list(one.results())
    assert [task for task, _ in found] == [0, 1, 2, 3]
    assert [process == here for _, process in found] == [False, False, True, True]


def test_without_another_process_a_task_is_done_when_it_is_given() -> None:
    done = []
    one: Beside[int, None] = Beside(done.append, here=True)
    one.give(5)
    assert done == [5]
    assert list(one.results(wait=False)) == [None]


def test_it_ends_with_its_tasks_undone() -> None:
    one: Beside[int, None] = Beside(lambda task: signal.pause())
    one.give(0)
    process = one._process
    one.end()
    assert process.exitcode is not None
