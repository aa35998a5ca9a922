"""Processes that do tasks for this one: they end with it, and one that dies is replaced.

A task whose process dies is done once more; where that one dies too, its death is its result, and
the other tasks go on. Each process has a pipe and a task ahead, so that it does not wait for this
one between two short tasks. A forked one has all tasks in memory, and is sent their indices; to one
that is spawned the tasks themselves are sent. Tasks of milliseconds are given in groups, and their
results come back together: to wake for each takes this process a tenth of a millisecond, and it
shares the cores with those that work. Which task of a group a process died of, it has counted in
memory that both see; those before it are done again, for their results are lost.
"""

from __future__ import annotations

import ctypes
import gc
import mmap
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
from time import monotonic
from typing import Any, Final, Generic, NamedTuple, TypeVar

from .forking import may_fork
from .interruption import deferred, forked_to_end, handled, raise_noted

Task = TypeVar("Task")
Result = TypeVar("Result")

AHEAD: Final = 2  # groups of tasks that a process is given: the one it does, and the next,
PLENTY: Final = 4  # while more of them wait than so many for each process
EVERY: Final = 0.1  # [s] that a group of short tasks takes,
MOST: Final = 64  # tasks at most
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
        self._done: Any = None  # tasks, as the other process counts
        if self._forked:
            self._done = memoryview(mmap.mmap(-1, 8)).cast("Q")
            target: Any = _serve_forked
            arguments: Any = (other, function, tasks, self._done, [self.pipe, *others])
        else:
            target, arguments = serve, (other, _Together(function))
        self.process = context.Process(target=target, args=arguments, daemon=True)
        with warnings.catch_warnings():
            # Python 3.12 warns of threads in a forked process: see `forking`.
            warnings.simplefilter("ignore", DeprecationWarning)
            # Python drops what a signal raises in the functions that it calls around a fork.
            with handled(), deferred():
                self.process.start()
        other.close()  # so that the pipe ends with the process
        self.given: deque[list[int]] = deque()  # groups of tasks
        self.answered = 0  # tasks whose results came
        self.ready = False

    @property
    def most(self) -> int:
        """How many tasks a group may have; a spawned one does not tell which it died of."""
        return MOST if self._forked else 1

    def give(self, groups: Sequence[list[int]]) -> None:
        """Hand over groups of tasks."""
        self.given.extend(groups)
        tasks = [group if self._forked else [self._tasks[one] for one in group] for group in groups]
        with suppress(OSError):  # it died: its pipe says so where results are read
            self.pipe.send(tasks)

    def left(self) -> tuple[list[int], list[int]]:
        """Return what a process that died was given: of its group what it had done, and the rest.

        It died of the first of the rest.
        """
        tasks = [one for group in self.given for one in group]
        done = self._done[0] - self.answered if self._done is not None else 0
        return tasks[:done], tasks[done:]

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
            self._give()
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
            group = worker.given.popleft()
            if not good:
                raise result
            self._done += len(group)
            worker.answered += len(group)
            yield from zip([self._tasks[index] for index in group], result, strict=True)

    def _together(self) -> int:
        """Return how many tasks make a group, by what tasks took so far and how many are left."""
        each = (monotonic() - self._begun) * len(self._workers) / max(self._done, 1)  # [s]
        if self._done < AHEAD * len(self._workers):
            return 1
        left = len(self._waiting) // (AHEAD * PLENTY * len(self._workers))
        return max(1, min(int(EVERY / each), left))

    def _give(self) -> None:
        """Give each process as many groups as it may have, in turns, while there are tasks.

        Towards the end none stands behind another that may be long while a process has nothing.
        """
        together, each = self._together(), len(self._workers)
        taken: list[list[list[int]]] = [[] for _ in self._workers]
        for most, least in zip(range(1, AHEAD + 1), (0, PLENTY * each), strict=True):
            for worker, groups in zip(self._workers, taken, strict=True):
                if len(self._waiting) > least and len(worker.given) + len(groups) < most:
                    size = min(together, worker.most, len(self._waiting))
                    groups.append([self._waiting.popleft() for _ in range(size)])
        for worker, groups in zip(self._workers, taken, strict=True):
            if groups:
                worker.give(groups)

    def _start(self) -> None:
        others = [worker.pipe for worker in self._workers]
        self._workers.append(_Worker(self._function, self._tasks, others))
        raise_noted()  # the process is one of those that are ended

    def _replace(self, worker: _Worker) -> Iterator[tuple[Task, Death]]:
        """Start another process in the place of a dead one; yield a task that it dies of again."""
        death = worker.death()
        lost, given = worker.left()
        worker.pipe.close()
        self._workers.remove(worker)
        if worker.ready and given:
            index, *others = given
            self._tries[index] += 1
            if self._tries[index] < TRIES:
                self._waiting.extendleft(reversed([*lost, index, *others]))
                self._retried(Retried(self._tasks[index], death))
            else:
                self._waiting.extendleft(reversed([*lost, *others]))
                yield self._tasks[index], death
        else:  # of no task
            self._waiting.extendleft(reversed([*lost, *given]))
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


class _Together:
    """Does a group of tasks, and returns the results."""

    def __init__(self, function: Callable[[Any], Any], done: Any = None) -> None:
        """done: memory in which all tasks that are done are counted."""
        self._function, self._done = function, [0] if done is None else done

    def __call__(self, group: Sequence[Any]) -> list[Any]:
        results = []
        for one in group:
            results.append(self._function(one))
            self._done[0] += 1
        return results


def _serve_forked(
    pipe: Connection,
    function: Callable[[Any], Any],
    tasks: Sequence[Any],
    done: Any,
    parents: Sequence[Connection],
) -> None:
    """Do the tasks whose indices come through the pipe, in groups.

    done: memory in which tasks that are done are counted.
    """
    for one in parents:  # else another process's pipe would not end with the parent
        one.close()
    gc.freeze()  # a collection would write to, and so copy, every page of what is shared
    serve(pipe, _Together(lambda index: function(tasks[index]), done))


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
