"""Executors that stand for those of other libraries, and lose what they are given."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import Any


class Here(Executor):
    """Does everything at once, in this process; the first tasks are lost."""

    def __init__(self, lost: int = 0, function: Callable[..., Any] | None = None) -> None:
        self._lost, self._function = lost, function
        self.given = 0

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.given += 1
        future: Future[Any] = Future()
        try:
            if self.given <= self._lost:
                raise RuntimeError("gone")
            future.set_result((self._function or fn)(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future
