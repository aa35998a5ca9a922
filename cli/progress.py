"""Shows a run while it goes on, on stderr: one live display on a terminal, few lines elsewhere.

pile  3 of 12 cells  ━━━━━━━━━━━━━╸━━━━━━━━━━━━━━━━━━━━━━━  34 %  1 min 12 s left
      1.34 of 5 s simulated in friction=0.3; 17.2 of 60 s in all; 1.2 GB written
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event, Thread
from time import monotonic
from typing import TYPE_CHECKING, Any

import typer

from lavender_cli.printing import byte_size, digits, time_span

if TYPE_CHECKING:
    from rich.console import Console, RenderableType

    from lavendersim.runner.progress import Compilation, Moment, Tally

PER_SECOND = 4  # times that a terminal is drawn anew
EVERY = 10.0  # [s] between two lines elsewhere
SHOWN_PLANS = 3  # that are compiled at once, by name


@contextmanager
def reporting(name: str) -> Iterator[Any]:
    """Give a runner.Progress that shows a run: live on a terminal, else in lines."""
    shown = _terminal(name) if sys.stderr.isatty() else _lines(name)
    with shown as progress:
        yield progress


@contextmanager
def _lines(name: str) -> Iterator[Any]:
    from lavendersim.runner import Progress

    state = ShownState(name)

    def compiling(begun: Compilation) -> None:
        typer.echo(f"{name}: {compilation_line(begun)}", err=True)

    def timing(what: str, done: int, total: int) -> None:
        state.timing(what, done, total)
        if done == 0:
            typer.echo(f"{name}: {what}, {total} in all", err=True)

    stopped = Event()

    def show() -> None:
        while not stopped.wait(1.0):
            if line := state.line():
                typer.echo(f"{name}: {line}", err=True)

    _thread(show).start()
    try:
        yield Progress(
            compiling=compiling,
            running=state.running,
            timing=timing,
            warning=_warn(name),
            note=_note(name),
        )
    finally:
        stopped.set()


@contextmanager
def _terminal(name: str) -> Iterator[Any]:
    from rich.console import Console
    from rich.live import Live

    from lavendersim.runner import Progress

    state, console = ShownState(name), Console(stderr=True)
    stopped = Event()
    with Live(
        get_renderable=lambda: state.drawn(console),
        console=console,
        auto_refresh=False,  # by a thread of ours, whose name says so
        transient=True,
    ) as live:

        def show() -> None:
            while not stopped.wait(1.0 / PER_SECOND):
                live.refresh()

        thread = _thread(show)
        thread.start()
        try:
            yield Progress(
                compiling=state.compiling,
                compiled=state.compiled,
                running=state.running,
                timing=state.timing,
                warning=_warn(name),
                note=_note(name),
            )
        finally:
            stopped.set()
            thread.join()


def _thread(show: Callable[[], None]) -> Thread:
    """Return the thread that shows a run; beside one of this name processes may be forked."""
    return Thread(target=show, name="lavender display", daemon=True)


def _warn(name: str) -> Callable[[str], None]:
    def warn(sentence: str) -> None:
        typer.echo(f"{name}: {typer.style(sentence, fg=typer.colors.YELLOW)}", err=True)

    return warn


def _note(name: str) -> Callable[[str], None]:
    def note(sentence: str) -> None:
        typer.echo(f"{name}: {sentence}", err=True)

    return note


class ShownState:
    """What a run said of itself last; read by the thread that shows it."""

    def __init__(self, name: str, now: Callable[[], float] = monotonic) -> None:
        self._name, self._now = name, now
        self._compilations: dict[int, Compilation] = {}
        self._since = now()
        self._tally: Tally | None = None
        self._stage: tuple[str, int, int] | None = None
        self._next_line = EVERY  # [s] of work

    def compiling(self, begun: Compilation) -> None:
        """Note that a kernel is being compiled."""
        if not self._compilations:
            self._since = self._now()
        self._compilations = {**self._compilations, begun.number: begun}

    def compiled(self, ended: Compilation) -> None:
        """Note that it is compiled."""
        left = self._compilations.items()
        self._compilations = {number: one for number, one in left if number != ended.number}

    def running(self, tally: Tally) -> None:
        """Note where to read how far the cells are."""
        self._tally = tally

    def timing(self, what: str, done: int, total: int) -> None:
        """Note how far a stage is that follows the cells."""
        if self._stage is None or self._stage[0] != what:
            self._since = self._now()
        self._stage = what, done, total

    def line(self) -> str:
        """Return all there is to report in one line; nothing before cells ran for another while."""
        if self._tally is None or self._stage is not None:
            return ""
        moment = self._tally.read()
        if moment.worked < self._next_line or moment.cells_done == moment.cells:
            return ""
        self._next_line = moment.worked + EVERY
        parts = [_cells(moment), *_details(moment), _left(moment.remaining)]
        return "; ".join(part for part in parts if part)

    def drawn(self, console: Console) -> RenderableType:
        """Return what a terminal shows now, at most two lines."""
        if self._stage is not None:
            return self._drawn_stage(*self._stage)
        if compilations := list(self._compilations.values()):
            return self._drawn_compilations(compilations)
        if self._tally is None:
            return ""
        moment = self._tally.read()
        share = f"{100 * moment.share:3.0f} %"
        left = "" if moment.cells_done == moment.cells else _left(moment.remaining)
        first = (_cells(moment), moment.share, share, left)
        return self._rows(first, "; ".join(_details(moment)))

    def _drawn_compilations(self, compilations: list[Compilation]) -> RenderableType:
        from lavendersim.runner.environment import kernel_place

        total, spent = compilations[0].total, time_span(self._now() - self._since)
        if len(compilations) == 1:
            (one,) = compilations
            what = f"compiling {one.number} of {total}" if total > 1 else "compiling"
            named = f"{one.title}: {_parts(one)}" if total > 1 else _parts(one)
        else:
            what = f"compiling {total}, {total - len(compilations)} done"
            named = "; ".join(one.title for one in compilations[:SHOWN_PLANS])
            if len(compilations) > SHOWN_PLANS:
                named += f"; {len(compilations) - SHOWN_PLANS} more"
        return self._rows((f"{what} ({kernel_place()})", None, "", spent), named)

    def _drawn_stage(self, what: str, done: int, total: int) -> RenderableType:
        spent = self._now() - self._since
        left = _left(spent * (total - done) / done) if done else ""
        return self._rows((what, done / max(total, 1), f"{done} of {total}", left), "")

    def _rows(self, first: tuple[str, float | None, str, str], second: str) -> RenderableType:
        from rich.console import Group
        from rich.padding import Padding
        from rich.progress_bar import ProgressBar
        from rich.table import Table
        from rich.text import Text

        what, share, count, left = first
        row = Table.grid(padding=(0, 2, 0, 0), expand=True)
        row.add_column(no_wrap=True)
        row.add_column(no_wrap=True, overflow="ellipsis", ratio=1 if share is None else None)
        cells: list[RenderableType] = [Text(self._name, "bold"), Text(what)]
        if share is not None:
            row.add_column(ratio=1)
            cells.append(ProgressBar(total=1.0, completed=share))
        row.add_column(no_wrap=True, justify="right")
        row.add_row(*cells, Text("  ".join(part for part in (count, left) if part)))
        if not second:
            return row
        below = Text(second, "dim", no_wrap=True, overflow="ellipsis")
        return Group(row, Padding(below, (0, 0, 0, len(self._name) + 2)))


def compilation_line(begun: Compilation) -> str:
    """Return what is compiled, in one line: effects, pairs of shapes, where it is kept."""
    from lavendersim.runner.environment import kernel_place

    which = f"{begun.number} of {begun.total}, {begun.title}: " if begun.total > 1 else ""
    return f"compiling {which}kernels for {_parts(begun)} ({kernel_place()})"


def _parts(begun: Compilation) -> str:
    effects = ", ".join(begun.plan.spec.effects) or "no effects"
    return f"{effects}; {', '.join(begun.plan.spec.shape_pairs) or 'no pairs'}"


def _cells(moment: Moment) -> str:
    return f"{moment.cells_done} of {moment.cells} cell{'s' * (moment.cells != 1)}"


def _details(moment: Moment) -> list[str]:
    """Return simulated time of all cells, what is written, and where the cell that runs is."""
    whole = f"{digits_of_time(moment.seconds_done)} of {digits(moment.seconds)} s simulated"
    details = [f"{whole}, {byte_size(moment.written)} written"]
    if moment.cells_done == moment.cells:
        return [*details, "measuring"]
    if moment.cells == 1 or moment.label is None:
        return details
    own = f"{digits_of_time(moment.cell_seconds_done)} of {digits(moment.cell_seconds)} s"
    return [*details, f"{own} in {moment.label or 'a cell'}"]


def digits_of_time(seconds: float) -> str:
    """Return a simulated time in three digits or whole seconds; it changes as one looks."""
    return f"{seconds:.3g}" if seconds < 1000.0 else f"{seconds:.0f}"


def _left(seconds: float | None) -> str:
    return "" if seconds is None else f"{time_span(seconds)} left"
