"""Draws the figures of runs beside the runs that follow; reports all in the order of the runs."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from lavendersim.runner.beside import Beside


class _Due(NamedTuple):
    """What is to be reported: something, or the figures of the next run that is drawn."""

    report: Callable[[], None] | None = None
    take: Callable[[list[Path]], None] | None = None


class _Drawn(NamedTuple):
    """A run to be drawn, as a process needs it that has the experiments in memory."""

    number: int  # of its experiment
    path: Path
    taken: Mapping[int, Mapping[str, Any]]  # see `Run.taken`


class Drawing:
    """Reports on runs, and their figures, which come later than the next runs begin.

    Who measures times is left alone: where a run takes overheads, figures are drawn in between.
    """

    def __init__(self, experiments: Sequence[Any]) -> None:
        """experiments: that may be drawn; without any of them no process is begun."""
        self._experiments = experiments
        self._beside: Beside[_Drawn, list[Path]] | None = None
        self._due: deque[_Due] = deque()
        if any(experiment.is_drawn for experiment in experiments):
            from lavendersim.figures import prepare
            from lavendersim.runner.beside import Beside

            timed = any(experiment.config.overhead is not None for experiment in experiments)
            self._beside = Beside(self._draw, prepare, here=timed)

    def __enter__(self) -> Drawing:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Report what is due; figures of earlier runs are drawn where a later one fails, too."""
        if self._beside is None:
            return
        try:
            if kind is None:
                self._report(wait=True)
            elif issubclass(kind, Exception):
                with suppress(Exception):
                    self._report(wait=True)
        finally:
            self._beside.end()

    def draw(self, number: int, run: Any) -> None:
        """Begin to draw the run of an experiment, by its number; `take` follows."""
        assert self._beside is not None
        self._beside.give(_Drawn(number, run.path, run.taken))

    def take(self, take: Callable[[list[Path]], None]) -> None:
        """Hand on the files of the next run that is drawn, when all before is reported."""
        self._due.append(_Due(take=take))
        self._report(wait=False)

    def say(self, report: Callable[[], None]) -> None:
        """Report something when all before it is."""
        self._due.append(_Due(report))
        self._report(wait=False)

    def _draw(self, one: _Drawn) -> list[Path]:
        from lavendersim.figures import draw
        from lavendersim.runner import Run

        return draw(Run(one.path, self._experiments[one.number], one.taken), one.path / "figures")

    def _report(self, wait: bool) -> None:
        while self._due:
            report, take = self._due[0]
            if take is not None and self._beside is not None:
                found = next(self._beside.results(wait), None)
                if found is None:
                    return
                take(found)
            if report is not None:
                report()
            self._due.popleft()
