"""YAML experiments as pytest items: one for each judged expectation.

A YAML file is an experiment when it has a `scene:` at its top level, or a file that it extends
has; other YAML files are left alone, and those whose name begins with `_`, which are there to be
extended. The experiment runs once, when its first selected item does; its logs are kept in pytest's
temporary directory, whose path stands in every failure.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from lavendersim.runner import Finished

FULL = "--lavender-full"
_EXPERIMENT = re.compile(rb"^scene[ \t]*:", re.MULTILINE)
_EXTENDS = re.compile(rb"""^extends[ \t]*:[ \t]*["']?([^"'\s#]+\.ya?ml)\b""", re.MULTILINE)
_MOST_PARENTS = 8
# Experiments are small; a larger YAML file is somebody's data.
_LARGEST_FILE = 1 << 20
COMPLETES = "every cell completes"
# Sentences about cells whose steps did not all converge; shown at the end, never a failure.
_NOT_CONVERGED = pytest.StashKey[list[str]]()


def _is_experiment(path: Path) -> bool:
    if path.suffix not in (".yaml", ".yml") or path.name.startswith("_"):
        return False
    if (path.parent / "cells.json").exists():  # a copy in the directory of a run
        return False
    for _ in range(_MOST_PARENTS + 1):  # what else is wrong with them is said when it is loaded
        if not path.is_file() or path.stat().st_size > _LARGEST_FILE:
            return False
        text = path.read_bytes()
        if _EXPERIMENT.search(text) is not None:
            return True
        if (extended := _EXTENDS.search(text)) is None:
            return False
        path = path.parent / os.fsdecode(extended[1])
    return False


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option that runs slow experiments in full."""
    group = parser.getgroup("lavender")
    group.addoption(FULL, action="store_true", help="run slow experiments at their full length")


def pytest_configure(config: pytest.Config) -> None:
    """Make the marker known by which slow experiments can be chosen or left out."""
    config.addinivalue_line("markers", "slow: a config that says `slow: true`")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Collect experiments."""
    if not _is_experiment(file_path):
        return None
    collector: pytest.Collector = ExperimentFile.from_parent(parent, path=file_path)
    return collector


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """List the cells whose steps did not all converge, whatever became of their expectations."""
    notices = config.stash.get(_NOT_CONVERGED, [])
    if notices:
        terminalreporter.section("steps that did not converge")
        for notice in notices:
            terminalreporter.write_line(notice)


class ExperimentFile(pytest.File):
    """One config file and, once an item asked for it, its run."""

    _finished: Finished | None = None

    def collect(self) -> Iterator[pytest.Item]:
        """Yield one item per expectation and cell, and one for the run itself."""
        from lavendersim.errors import LavenderError
        from lavendersim.experiment import load_experiment
        from lavendersim.lint import warn
        from lavendersim.measures import judge_nodes
        from lavendersim.runner.checks import check

        try:
            experiment = load_experiment(self.path, self._reduced)
            check(experiment)
            warn(experiment)
        except LavenderError as error:
            raise self.CollectError(str(error)) from None
        for number, node in enumerate([COMPLETES, *judge_nodes(experiment)]):
            item = ExpectationItem.from_parent(self, name=node, number=number - 1)
            if experiment.config.slow:
                item.add_marker(pytest.mark.slow)
            yield item

    @property
    def _reduced(self) -> bool:
        return not self.config.getoption(FULL)

    def finished(self) -> Finished:
        """Run the experiment, the first time it is asked for."""
        if self._finished is None:
            from lavendersim.experiment import load_experiment
            from lavendersim.runner import run

            experiment = load_experiment(self.path, self._reduced)
            factory: pytest.TempPathFactory = self.config._tmp_path_factory  # type: ignore[attr-defined]
            # Overheads are read by people, on a quiet machine; nothing is expected of them.
            self._finished = run(experiment, factory.mktemp(self.path.stem), overheads=False)
            self.config.stash.setdefault(_NOT_CONVERGED, []).extend(self._finished.not_converged)
        return self._finished


class Unmet(Exception):  # noqa: N818 - an expectation that was not met, not an error
    """Carries the text a person reads."""


class ExpectationItem(pytest.Item):
    """One verdict; number -1 is the run as a whole."""

    def __init__(self, *, number: int, **arguments: Any) -> None:
        super().__init__(**arguments)
        self.number = number

    def runtest(self) -> None:
        """Run the experiment if need be and look at this item's verdict."""
        assert isinstance(self.parent, ExperimentFile)
        finished = self.parent.finished()
        if self.number < 0:
            ended = [
                f"{cell.label or 'the cell'}: {cell.status}\n  log        {cell.path}"
                for cell in finished.ended_early
            ] + finished.run.cut()
            if ended:
                raise Unmet("\n".join(ended))
            return
        verdict = finished.verdicts[self.number]
        assert verdict.node == self.name
        if not verdict.judged:
            pytest.skip(f"not judged: {verdict.reason or verdict.message}")
        if not verdict.passed:
            raise Unmet(verdict.message)

    def repr_failure(self, excinfo: Any, style: Any = None) -> Any:
        """Show what was measured and expected; a traceback only for a defect of lavender."""
        if isinstance(excinfo.value, Unmet):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Name the item in reports."""
        return self.path, None, self.name
