"""One process beside this one, which does tasks in their order while this one goes on.

It is forked, so it begins with all that this one has in memory: nothing is imported or read again.
Where that is not to be had (see `forking`; a single core), or where it has died, tasks are done
here when results are taken.
"""

from __future__ import annotations

import os
import warnings
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import suppress
from multiprocessing import get_context
from typing import Any, Generic, TypeVar

from .forking import may_fork
from .interruption import forked_to_end
from .workers import PATIENCE, end_with_parent, serve

Task = TypeVar("Task")
Result = TypeVar("Result")


class Beside(Generic[Task, Result]):
    """Does a function of tasks, beside this process where that is possible."""

    def __init__(
        self,
        function: Callable[[Task], Result],
        prepare: Callable[[], None] = lambda: None,
        here: bool = False,
    ) -> None:
        """prepare: called in the other process before the first task; what takes long to import.

        here: no other process, tasks are done here as they are given.
        """
        self._function = function
        self._tasks: deque[Task] = deque()  # given to the other process, results not taken yet
        self._done: deque[Result] = deque()  # here
        self._process: Any = None
        if here or not _may_fork():
            return
        context = get_context("fork")
        self._pipe, other = context.Pipe()
        arguments = other, self._pipe, function, prepare
        process = context.Process(target=_begin, args=arguments, daemon=True)
        with warnings.catch_warnings():
            # Python 3.12 counts threads of libraries, which make theirs anew in the other process.
            warnings.simplefilter("ignore", DeprecationWarning)
            process.start()
        other.close()
        self._process = process

    def give(self, task: Task) -> None:
        """Let a task be done."""
        if self._process is None:
            self._done.append(self._function(task))
            return
        self._tasks.append(task)
        with suppress(OSError):  # it died: `results` does the task
            self._pipe.send([task])

    def results(self, wait: bool = True) -> Iterator[Result]:
        """Yield the results of tasks in their order; an exception of one is raised here.

        wait: for all of them; else those that are there.
        """
        while True:
            if self._tasks and self._process is not None:
                if not wait and not self._pipe.poll():
                    return
                self._receive()
            while self._tasks and self._process is None:  # it died
                self._done.append(self._function(self._tasks.popleft()))
            while self._done:
                yield self._done.popleft()
            if not self._tasks:
                return

    def _receive(self) -> None:
        try:
            message = self._pipe.recv()
        except (EOFError, OSError):
            self.end()
            return
        if message is None:  # it is ready
            return
        good, result = message
        self._tasks.popleft()
        if not good:
            raise result
        self._done.append(result)

    def end(self) -> None:
        """End the other process; what it does is cut off, as by a signal."""
        if self._process is None:
            return
        process, self._process = self._process, None
        self._pipe.close()
        if self._tasks:
            process.terminate()
        process.join(PATIENCE)
        process.kill()
        process.join()


def _begin(pipe: Any, others: Any, function: Callable[[Any], Any], prepare: Any) -> None:
    if forked_to_end():  # Ctrl-C is for the process that asks
        return
    end_with_parent()  # while it prepares, too
    others.close()  # the parent's end: else the pipe would not end with the parent
    with suppress(Exception):  # raised again by the first task
        prepare()
    serve(pipe, function)


def _may_fork() -> bool:
    return may_fork() and len(os.sched_getaffinity(0)) > 1
