"""Tests that are collected once, and run in forks of the process that collected them.

A fork begins with every module imported, so that a test costs what it does and nothing else.
"""

from __future__ import annotations

import gc
import json
import os
import resource
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from types import CodeType, FrameType
from typing import Any, NamedTuple

import pytest

Work = Callable[[Path], None]  # writes what it found to a file


MOST_LATE = 2  # tests of a file that are over their time, before its others are left out


class Done(NamedTuple):
    """How a fork ended, and what it wrote."""

    number: int
    status: int  # exit code; -n where signal n ended it
    said: str
    seconds: float  # of a processor


class TookTooLong(BaseException):
    """A test that is over its time."""


def forks(works: Iterable[Work], jobs: int, limits: tuple[float, float]) -> Iterator[Done]:
    """Do each work in a fork, so many at a time; limits: seconds of a processor, and of a clock."""
    running: dict[int, tuple[int, Path, float]] = {}
    waiting = enumerate(works)
    with tempfile.TemporaryDirectory() as folder:
        while True:
            while len(running) < jobs and (following := next(waiting, None)):
                number, work = following
                said = Path(folder) / str(number)
                said.touch()
                process = os.fork()
                if process == 0:
                    _child(work, said, limits[0])
                running[process] = number, said, time.monotonic()
            if not running:
                return
            for process, (number, said, begin) in [*running.items()]:
                done, status, used = os.wait4(process, os.WNOHANG)
                if not done and time.monotonic() - begin > limits[1]:
                    os.kill(process, signal.SIGKILL)
                    done, status, used = os.wait4(process, 0)
                if done:
                    del running[process]
                    code = os.waitstatus_to_exitcode(status)
                    seconds = used.ru_utime + used.ru_stime
                    yield Done(number, code, said.read_text(), seconds)
            time.sleep(0.005)


def _child(work: Work, said: Path, limit: float) -> None:
    code = 3
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        resource.setrlimit(resource.RLIMIT_CPU, (int(limit) + 1, int(limit) + 2))
        work(said)
        code = 0
    finally:
        os._exit(code)


class Outcome(NamedTuple):
    """How a test ended."""

    failed: bool
    skipped: bool
    why: str  # the exception, where it failed
    seconds: float  # of a processor


class Collected:
    """Tests of one session of pytest, by name."""

    def __init__(self, task: Callable[[Collected], int]) -> None:
        self._task = task
        self.items: dict[str, pytest.Item] = {}
        self.status = 3
        self._reports: list[Any] = []

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Do the task in place of running tests."""
        self.items = {item.nodeid: item for item in session.items}
        gc.collect()
        gc.freeze()
        self.status = self._task(self)
        return True

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Note how each phase of a test ended."""
        self._reports.append(report)

    def outcomes(self, names: list[str], limits: tuple[float, float]) -> Iterator[Outcome]:
        """Run tests in this process; limits of each: seconds of a processor, and of a clock."""

        def late(*_: Any) -> None:
            raise TookTooLong

        for kind in (signal.SIGVTALRM, signal.SIGALRM):
            signal.signal(kind, late)
        for name, following in zip(names, [*names[1:], ""], strict=True):
            item, begin = self.items[name], time.process_time()
            self._reports.clear()
            signal.setitimer(signal.ITIMER_VIRTUAL, limits[0])
            signal.setitimer(signal.ITIMER_REAL, limits[1])
            try:
                item.config.hook.pytest_runtest_protocol(
                    item=item, nextitem=self.items.get(following)
                )
            finally:
                signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
                signal.setitimer(signal.ITIMER_REAL, 0.0)
            bad = [report for report in self._reports if report.failed]
            if bad:  # what was stopped within a fixture is still set up
                with suppress(BaseException):
                    item.session._setupstate.teardown_exact(None)
            crash = getattr(getattr(bad[0], "longrepr", None), "reprcrash", None) if bad else None
            yield Outcome(
                bool(bad),
                any(report.skipped for report in self._reports),
                str(crash.message).split("\n")[0][:100] if crash else "in a fixture" if bad else "",
                time.process_time() - begin,
            )


def collected(paths: list[str], task: Callable[[Collected], int]) -> int:
    """Collect tests and do the task with them; returns what it returns."""
    plugin = Collected(task)
    off = ("cacheprovider", "faulthandler", "terminal")
    options = ["-o", "addopts=", *(part for name in off for part in ("-p", f"no:{name}"))]
    code = int(pytest.main([*options, *paths], plugins=[plugin]))
    return plugin.status if code in (0, 5) else code


class Lines:
    """Lines of some files that a test runs; of a function that it calls often, those of the first.

    To follow every line of every call takes four times as long.
    """

    CALLS = 12  # of a function that are followed, in a test

    def __init__(self, folder: Path) -> None:
        self.lines: set[tuple[str, int]] = set()
        self._folder = str(folder) + os.sep
        self._names: dict[CodeType, str] = {}
        self._calls: Counter[CodeType] = Counter()

    def clear(self) -> None:
        """Begin another test."""
        self.lines.clear()
        self._calls.clear()

    def __enter__(self) -> Lines:
        sys.settrace(self._call)
        return self

    def __exit__(self, *_: object) -> None:
        sys.settrace(None)

    def _call(self, frame: FrameType, event: str, _: Any) -> Any:
        code = frame.f_code
        name = self._names.get(code)
        if name is None:
            path = code.co_filename
            name = path[len(self._folder) :] if path.startswith(self._folder) else ""
            self._names[code] = name
        if not name or self._calls[code] >= self.CALLS:
            return None
        self._calls[code] += 1
        add = self.lines.add
        add((name, code.co_firstlineno))

        def line(frame: FrameType, event: str, _: Any) -> Any:
            add((name, frame.f_lineno))
            return line

        return line


def reached(
    tests: Collected, jobs: int, folder: Path, limits: tuple[float, float], share: float
) -> Iterator[tuple[str, float, list[tuple[str, int]]]]:
    """Run every test once; yields name, seconds and lines of `folder` of each that passes.

    limits of a test: seconds of a processor and of a clock; of a file `share` times those.
    """
    files: dict[Path, list[str]] = {}
    for name, item in tests.items.items():
        files.setdefault(item.path, []).append(name)

    def work_of(names: list[str]) -> Work:
        def work(said: Path) -> None:
            late = 0
            with said.open("w") as out, Lines(folder) as found:
                outcomes = tests.outcomes(names, limits)
                for name in names:
                    found.clear()
                    one = next(outcomes)
                    late += one.why.endswith(TookTooLong.__name__)
                    if not (one.failed or one.skipped):
                        lines = sorted(found.lines)
                        print(json.dumps([name, one.seconds, lines]), file=out, flush=True)
                    if late == MOST_LATE:
                        return

        return work

    works = [work_of(names) for names in files.values()]
    for done in forks(works, jobs, (share * limits[0], share * limits[1])):
        for text in done.said.splitlines():
            if text.endswith("]"):  # whole
                name, seconds, lines = json.loads(text)
                yield name, seconds, [(file, line) for file, line in lines]
