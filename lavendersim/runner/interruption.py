"""Signals that end a run: what was simulated is in the log, and the log is closed, before it ends.

While a log is open a signal is only noted, and the cell asks for it between two calls of the
engine. While a process is forked it is noted, too: Python drops what is raised in the functions
that it calls before and after. Elsewhere it ends at once what goes on, and so does a second one.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Final

from lavendersim.trace.whole import INTERRUPTED

_ASKED: Final = ("_raw_object_cache_getbuffer", "_raw_object_cache_notify")  # of llvmlite
SIGNALS: Final = ("SIGINT", "SIGTERM", "SIGHUP")  # those of them that a system has


class Interrupted(KeyboardInterrupt):
    """A signal ended a run; the argument says which."""


class _Noted:
    """Of this process: signals come to its main thread."""

    open = False  # whether they are noted: a log is open, or a process begins
    signal = ""  # that came meanwhile
    by = 0  # the process that began to note them
    raised = ""  # one that was to end what goes on: a callback from C loses the exception


def _take(number: int, frame: Any) -> None:
    name = signal.Signals(number).name
    forked = _Noted.by != os.getpid()  # and not yet so far that a second one may end it
    if _Noted.open and (forked or not _Noted.signal):
        _Noted.signal = _Noted.signal or name
        return
    _Noted.raised = name
    if not _is_asked_by_llvm(frame):
        raise Interrupted(f"{INTERRUPTED} by {name}")


def _is_asked_by_llvm(frame: Any) -> bool:
    """Whether LLVM waits for an object that is kept: left without an answer it ends the process."""
    while frame is not None:
        if frame.f_code.co_name in _ASKED:
            return True
        frame = frame.f_back
    return False


def _is_main() -> bool:
    return threading.current_thread() is threading.main_thread()


@contextmanager
def handled() -> Iterator[None]:
    """Let signals end what is run meanwhile in this way.

    In another than the main thread, and of signals that somebody else handles or ignores, nothing
    changes.
    """
    numbers = [getattr(signal, name) for name in SIGNALS if hasattr(signal, name)]
    defaults = (signal.SIG_DFL, signal.default_int_handler)
    before = {one: signal.getsignal(one) for one in numbers if _is_main()}
    taken = {number: handler for number, handler in before.items() if handler in defaults}
    for number in taken:
        signal.signal(number, _take)
    try:
        yield
    except Exception:
        if _is_main() and _Noted.raised:  # the compiler's defect is what became of the signal
            raise Interrupted(f"{INTERRUPTED} by {_Noted.raised}") from None
        raise
    finally:
        if _is_main():
            _Noted.raised = ""
        for number, handler in taken.items():
            signal.signal(number, handler)


@contextmanager
def deferred() -> Iterator[Callable[[], str]]:
    """Note signals meanwhile; yields what returns the name of one that came, or ""."""
    if not _is_main():
        yield str
        return
    _Noted.open, _Noted.signal, _Noted.by = True, _Noted.raised, os.getpid()
    try:
        yield lambda: _Noted.signal
    finally:
        _Noted.open = False


def forked_to_end() -> bool:
    """Whether a signal came as this process was forked, or just before; but for Ctrl-C.

    It begins as its parent was then, with signals noted; from now on they end it as they end any
    process, without a word, and Ctrl-C is for the parent alone.
    """
    for name in SIGNALS:
        if hasattr(signal, name):
            action = signal.SIG_IGN if name == "SIGINT" else signal.SIG_DFL
            signal.signal(getattr(signal, name), action)
    name, _Noted.open, _Noted.signal = _Noted.signal, False, ""
    return name not in ("", "SIGINT")


def raise_noted() -> None:
    """Raise Interrupted where a signal came while signals were noted the last time."""
    if _is_main() and _Noted.signal:
        name, _Noted.signal = _Noted.signal, ""
        raise Interrupted(f"{INTERRUPTED} by {name}")
