"""Processes that do tasks for this one: they end with it, and one that dies is replaced.

A task whose process dies is done once more; where that one dies too, its death is its result, and
the other tasks go on. Each process has a pipe and a task ahead, so that it does not wait for this
one between two short tasks. A forked one has all tasks in memory, and is sent their indices; to one
that is spawned the tasks themselves are sent. Of tasks of milliseconds each has more ahead, and
this process wakes for several results at once: it shares the cores with those that work.
"""

from __future__ import annotations

import ctypes
import gc
import os
import pickle
import signal
import sys
import traceback
import warnings
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from multiprocessing import get_context, parent_process
from multiprocessing.connection import Connection, wait
from queue import SimpleQueue
from threading import Thread
from time import monotonic, sleep
from typing import Any, Final, Generic, NamedTuple, TypeVar

from .forking import may_fork
from .interruption import deferred, forked_to_end, handled, raise_noted

Task = TypeVar("Task")
Result = TypeVar("Result")

AHEAD: Final = 2  # tasks that a process is given: the one it does, and the next,
PLENTY: Final = 4  # while more of them wait than so many for each process;
MOST_AHEAD: Final = 12  # where they are so short that results are taken
EVERY: Final = 0.02  # [s] together
TRIES: Final = 2  # of a task
STILLBORN: Final = 3  # processes one after the other that may die before they are ready
PATIENCE: Final = 2.0  # [s] for a process to end that has nothing to do
CLOSING: Final = 20.0  # [s] for one to write what it simulated, and close its log
PR_SET_PDEATHSIG: Final = 1  # of Linux's prctl


class Death(NamedTuple):
    """How the process of a task ended that did not come to its end."""

    how: str  # "was killed by SIGKILL"


class Retried(NamedTuple, Generic[Task]):
    """A task that is done once more, for its process died."""

    task: Task
    death: Death


def end_with_parent() -> None:
    """End this process, in whatever it is doing, when the one that started it has ended.

    Linux sends a signal, which nothing delays. Elsewhere a thread waits for the end of a pipe,
    which a running kernel delays until it returns.
    """
    parent = parent_process()
    if parent is None:
        return
    Thread(target=_end_after, args=(parent,), daemon=True).start()
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent.pid:  # it has ended before there was to be a signal
            os._exit(1)


def _end_after(parent: Any) -> None:
    parent.join()
    os._exit(1)


def work(
    function: Callable[[Task], Result],
    tasks: Sequence[Task],
    workers: int,
    retried: Callable[[Retried[Task]], None] = lambda one: None,
) -> Iterator[tuple[Task, Result | Death]]:
    """Yield every task with its result, as they end.

    function: of a module, so that another process can import it; an exception of it is raised here.
    retried: called when a task is done once more.
    """
    crew = _Crew(function, tasks, retried)
    try:
        yield from crew.results(min(workers, len(tasks)))
        crew.dismiss()
    finally:
        crew.end()


class _Worker:
    """A process, and what it was given."""

    def __init__(
        self,
        function: Callable[[Any], Any],
        tasks: Sequence[Any],
        others: Sequence[Connection],
    ) -> None:
        """others: this process's ends of the pipes of other ones, of which a fork has copies."""
        self._tasks = tasks
        self._forked = may_fork()
        context: Any = get_context("fork" if self._forked else "spawn")
        self.pipe, other = context.Pipe()
        if self._forked:
            target: Any = _serve_forked
            arguments: Any = (other, function, tasks, [self.pipe, *others])
        else:
            target, arguments = serve, (other, function)
        self.process = context.Process(target=target, args=arguments, daemon=True)
        with warnings.catch_warnings():
            # Python 3.12 warns of threads in a forked process: see `forking`.
            warnings.simplefilter("ignore", DeprecationWarning)
            # Python drops what a signal raises in the functions that it calls around a fork.
            with handled(), deferred():
                self.process.start()
        other.close()  # so that the pipe ends with the process
        self.given: deque[int] = deque()
        self.ready = False

    def give(self, indices: Sequence[int]) -> None:
        """Hand over tasks."""
        self.given.extend(indices)
        with suppress(OSError):  # it died: its pipe says so where results are read
            self.pipe.send(indices if self._forked else [self._tasks[one] for one in indices])

    def death(self) -> Death:
        self.process.join()
        code = self.process.exitcode or 0
        if code < 0:
            return Death(f"was killed by {signal.Signals(-code).name}")
        return Death(f"ended with exit code {code}")


class _Crew(Generic[Task, Result]):
    """The processes of one sequence of tasks."""

    def __init__(
        self,
        function: Callable[[Task], Result],
        tasks: Sequence[Task],
        retried: Callable[[Retried[Task]], None],
    ) -> None:
        self._function, self._tasks, self._retried = function, tasks, retried
        self._waiting = deque(range(len(tasks)))
        self._tries = [0] * len(tasks)
        self._workers: list[_Worker] = []
        self._stillborn = 0
        self._done, self._begun = 0, monotonic()

    def results(self, workers: int) -> Iterator[tuple[Task, Result | Death]]:
        for _ in range(workers):
            self._start()
        while self._waiting or any(worker.given for worker in self._workers):
            ahead = self._ahead()
            self._give(ahead)
            if ahead > AHEAD and all(len(worker.given) > AHEAD for worker in self._workers):
                sleep(EVERY / 2)
            ready = wait([worker.pipe for worker in self._workers])
            for worker in [one for one in self._workers if one.pipe in ready]:
                yield from self._results_of(worker)

    def _results_of(self, worker: _Worker) -> Iterator[tuple[Task, Result | Death]]:
        """Yield what a process has sent so far."""
        more = True
        while more:
            try:
                message = worker.pipe.recv()
                more = bool(worker.given) and worker.pipe.poll()
            except (EOFError, OSError):  # it died, maybe within a message
                yield from self._replace(worker)
                return
            if message is None:
                worker.ready, self._stillborn = True, 0
                continue
            good, result = message
            index = worker.given.popleft()
            if not good:
                raise result
            self._done += 1
            yield self._tasks[index], result

    def _ahead(self) -> int:
        """Return how many tasks a process is given, by what tasks took so far."""
        each = (monotonic() - self._begun) * len(self._workers) / max(self._done, 1)  # [s]
        if self._done < AHEAD * len(self._workers) or each >= EVERY:
            return AHEAD
        return max(AHEAD, min(MOST_AHEAD, int(EVERY / each) + AHEAD))

    def _give(self, ahead: int) -> None:
        """Give each process as many tasks as it may have, in turns, while there are some.

        Towards the end none stands behind another that may be long while a process has nothing.
        """
        taken: list[list[int]] = [[] for _ in self._workers]
        for most in range(1, ahead + 1):
            least = most * PLENTY // AHEAD * len(self._workers) if most > 1 else 0
            for worker, indices in zip(self._workers, taken, strict=True):
                if len(self._waiting) > least and len(worker.given) + len(indices) < most:
                    indices.append(self._waiting.popleft())
        for worker, indices in zip(self._workers, taken, strict=True):
            if indices:
                worker.give(indices)

    def _start(self) -> None:
        others = [worker.pipe for worker in self._workers]
        self._workers.append(_Worker(self._function, self._tasks, others))
        raise_noted()  # the process is one of those that are ended

    def _replace(self, worker: _Worker) -> Iterator[tuple[Task, Death]]:
        """Start another process in the place of a dead one; yield a task that it dies of again."""
        death = worker.death()
        given = worker.given
        worker.pipe.close()
        self._workers.remove(worker)
        if worker.ready and given:
            index = given.popleft()
            self._tries[index] += 1
            if self._tries[index] < TRIES:
                self._waiting.extendleft(reversed([index, *given]))
                self._retried(Retried(self._tasks[index], death))
            else:
                self._waiting.extendleft(reversed(given))
                yield self._tasks[index], death
        else:  # of no task
            self._waiting.extendleft(reversed(given))
            self._stillborn += not worker.ready
            if self._stillborn >= STILLBORN:
                raise RuntimeError(f"no process can be started: the last one {death.how}")
        self._start()

    def dismiss(self) -> None:
        """Let the processes end by themselves, with what they do at their end."""
        for worker in self._workers:
            worker.pipe.close()
        for worker in self._workers:
            worker.process.join(PATIENCE)

    def end(self) -> None:
        """End the processes that there are still."""
        for worker in self._workers:
            worker.process.terminate()
        for worker in self._workers:
            worker.process.join(CLOSING)
            worker.process.kill()
            worker.process.join()
            worker.pipe.close()


def _serve_forked(
    pipe: Connection,
    function: Callable[[Any], Any],
    tasks: Sequence[Any],
    parents: Sequence[Connection],
) -> None:
    """Do the tasks whose indices come through the pipe, several in a message."""
    for one in parents:  # else another process's pipe would not end with the parent
        one.close()
    gc.freeze()  # a collection would write to, and so copy, every page of what is shared
    serve(pipe, lambda index: function(tasks[index]))


def serve(pipe: Connection, function: Callable[[Any], Any]) -> None:
    """Do what comes through the pipe, until it ends."""
    if forked_to_end():
        return
    end_with_parent()
    tasks: SimpleQueue[Any] = SimpleQueue()
    # Tasks are read beside the one that is done: the other process never waits to send one.
    Thread(target=_receive, args=(pipe, tasks), daemon=True).start()
    pipe.send(None)
    with suppress(KeyboardInterrupt), handled():
        while (one := tasks.get()) is not None:
            try:
                message = True, function(*one)
            except Exception as error:
                message = False, _sendable(error)
            pipe.send(message)


def _receive(pipe: Connection, tasks: SimpleQueue[Any]) -> None:
    try:
        while True:
            for one in pipe.recv():
                tasks.put((one,))
    except (EOFError, OSError):
        tasks.put(None)


def _sendable(error: Exception) -> Exception:
    """Return an error that another process can raise, with where it came from."""
    where = traceback.format_exc()
    try:
        error = pickle.loads(pickle.dumps(error))
    except Exception:
        error = RuntimeError(str(error))
    error.add_note(f"in a process of its own:\n{where}")
    return error
