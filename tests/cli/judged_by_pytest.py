"""pytest on a config whose log is damaged as soon as it is closed, before anything is judged."""

from __future__ import annotations

import contextlib
import io
import re
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple
from unittest import mock

import pytest
from damaged_runs import CHUNK_BYTES

from lavendersim import pytest_plugin
from lavendersim.runner import cell
from lavendersim.trace import writer

_FOLDER_OF_LOGS: Final = re.compile(r"[^\s`]*/cells/")  # which has the time in it


class Judged(NamedTuple):
    """What pytest said of an experiment."""

    code: int
    items: dict[str, tuple[str, str]]  # by node: passed, failed or skipped, and what was shown
    numbers: dict[str, str]  # measured, by node
    logs: dict[str, bytes]  # as they were closed, by name


class _Reports:
    """Keeps what became of each item."""

    def __init__(self) -> None:
        self.items: dict[str, tuple[str, str]] = {}

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Keep the report of the call."""
        if report.when == "call":
            name = report.nodeid.partition("::")[2]
            text = _FOLDER_OF_LOGS.sub("", str(report.longrepr or ""))
            self.items[name] = report.outcome, text


def judged_by_pytest(
    config: Path, folder: Path, damaged: Mapping[str, bytes], read: bool = True
) -> Judged:
    """Run pytest on a config in this process; damaged: what a log is after it was closed, by name.

    folder: of the logs, made anew. read: logs are judged from their files, as those that are too
    large to be kept in memory; else from what went into them.
    """
    shutil.rmtree(folder, ignore_errors=True)
    reports = _Reports()
    closed: dict[str, bytes] = {}
    runs: list[Any] = []
    note, finish = cell.note_closed, pytest_plugin.ExperimentFile.finished

    def note_and_damage(log: Path, *arguments: Any, **more: Any) -> None:
        if not more:  # with more it is noted again, when it is measured
            closed[log.name] = log.read_bytes()
            log.write_bytes(damaged.get(log.name, closed[log.name]))
        note(log, *arguments, **more)

    def finished(self: pytest_plugin.ExperimentFile) -> Any:
        runs.append(finish(self))
        return runs[-1]

    options = ["-q", "-p", "no:cacheprovider", "-p", "no:unraisableexception", "-c", "/dev/null"]
    options += [f"--rootdir={config.parent}", f"--basetemp={folder}", str(config)]
    with (
        mock.patch.object(writer, "CHUNK_BYTES", CHUNK_BYTES),
        mock.patch.object(writer, "KEPT_BYTES", 0 if read else writer.KEPT_BYTES),
        mock.patch.object(cell, "note_closed", note_and_damage),
        mock.patch.object(pytest_plugin.ExperimentFile, "finished", finished),
        mock.patch.dict("os.environ", PYTEST_DISABLE_PLUGIN_AUTOLOAD="1"),
        contextlib.redirect_stdout(io.StringIO()),
    ):
        code = int(pytest.main([*options, "-p", "lavendersim.pytest_plugin"], [reports]))
    numbers = {one.node: repr(one.measured) for one in runs[-1].verdicts}
    return Judged(code, reports.items, numbers, closed)
