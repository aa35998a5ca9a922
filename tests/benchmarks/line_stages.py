"""Where the time of a run goes: the stages of the line, each in seconds.

physics, logging and kernels are what the run itself reports; what it does not tell apart is taken
by wrapping the functions named in WRAPPED, for as long as the run lasts. `rest` is what is left of
the call of `run`: directory, index, results, scenes of the cells, and the loop around the engine.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from importlib import import_module
from pathlib import Path
from time import perf_counter, process_time
from typing import Any, NamedTuple
from unittest.mock import patch

from mcap.reader import make_reader

from lavendersim.experiment import Experiment
from lavendersim.figures import draw
from lavendersim.runner import Finished, run
from lavendersim.trace import open_trace

NANOSECOND = 1e-9  # [s]
# Stage -> module and name. Of a class the method: whoever imported the class calls it.
WRAPPED = {
    "opening": [("lavendersim.trace", "TraceWriter.__init__")],
    "judging": [("lavendersim.runner.bounds", "Bounds.within")],
    "measuring": [
        ("lavendersim.runner.cell", "measure_cell"),
        ("lavendersim.runner.experiment_run", "judge"),
    ],
}
# Parts of the call of `run`; the log is opened, then written, and bounds are judged in between.
WITHIN = ("kernels", "physics", "opening", "logging", "judging", "measuring", "rest")
STAGES = ("loading", *WITHIN, "reading", "drawing")
TOTALS = ("wall", "processor")  # of the calls of `run`


class Sample(NamedTuple):
    """One run of a case."""

    seconds: dict[str, float]  # by STAGES and TOTALS
    cells: int
    steps: int
    log_bytes: int
    last_bytes: float  # [byte/step] of the log, over the last quarter of the first cell's run


def owner_of(module: str, name: str) -> tuple[Any, str]:
    """Return what has an attribute, and the attribute's name."""
    *owners, attribute = name.split(".")
    return functools.reduce(getattr, owners, import_module(module)), attribute


def timed(function: Callable[..., Any], add: Callable[[float], None]) -> Callable[..., Any]:
    """Return a function that hands on what each of its calls takes [s]."""

    @functools.wraps(function)
    def call(*arguments: Any, **named: Any) -> Any:
        begin = perf_counter()
        try:
            return function(*arguments, **named)
        finally:
            add(perf_counter() - begin)

    return call


@contextmanager
def stopwatch() -> Iterator[dict[str, float]]:
    """Add up what the functions of WRAPPED take [s], by stage, while it is open."""
    spent = dict.fromkeys(WRAPPED, 0.0)

    def adding(stage: str) -> Callable[[float], None]:
        def add(seconds: float) -> None:
            spent[stage] += seconds

        return add

    with ExitStack() as stack:
        for stage, places in WRAPPED.items():
            for module, name in places:
                owner, attribute = owner_of(module, name)
                wrapper = timed(getattr(owner, attribute), adding(stage))
                stack.enter_context(patch.object(owner, attribute, wrapper))
        yield spent


def split(wall: float, reported: dict[str, float], wrapped: dict[str, float]) -> dict[str, float]:
    """Return the parts of a call of `run` [s] by WITHIN; their sum is its wall time.

    reported: what cells report; their `logging` has the judging in it.
    """
    parts = reported | wrapped
    parts["logging"] = reported["logging"] - wrapped["judging"]
    parts["rest"] = wall - sum(parts.values())
    return {stage: parts[stage] for stage in WITHIN}


def reported_by(finished: Finished) -> tuple[dict[str, float], int, dict[Path, int]]:
    """Return what the cells report [s], their steps, and the size of each log [byte]."""
    # Cells that are the same simulation share one outcome and one log.
    pairs = zip(finished.run.cells, finished.outcomes, strict=True)
    once = {cell.path: outcome for cell, outcome in pairs}
    seconds = {
        "kernels": sum(outcome.compile_ns for outcome in once.values()) * NANOSECOND,
        "physics": sum(outcome.physics_ns for outcome in once.values()) * NANOSECOND,
        "logging": sum(outcome.logging_ns for outcome in once.values()) * NANOSECOND,
    }
    steps = sum(outcome.steps for outcome in once.values())
    return seconds, steps, {path: path.stat().st_size for path in once}


def read_back(path: Path) -> None:
    """Read every column of a log."""
    trace = open_trace(path, allow_incomplete=True)
    for columns in (trace.step, trace.residual, trace.pose, trace.contact):
        assert columns is not None


def sample(load: Callable[[], Sequence[Experiment]], folder: Path) -> Sample:
    """Run experiments one after another, as the command line does, and read their logs back."""
    begin = perf_counter()
    experiments = load()
    seconds = dict.fromkeys((*STAGES, *TOTALS), 0.0)
    seconds["loading"] = perf_counter() - begin
    cells = steps = 0
    logs: dict[Path, int] = {}
    for experiment in experiments:
        with stopwatch() as wrapped:
            begin, worked = perf_counter(), process_time()
            finished = run(experiment, folder)
            wall, processor = perf_counter() - begin, process_time() - worked
        reported, count, sizes = reported_by(finished)
        if experiment.is_drawn:
            begin = perf_counter()
            draw(finished.run, finished.run.path / "figures")
            seconds["drawing"] += perf_counter() - begin
        found = split(wall, reported, wrapped) | {"wall": wall, "processor": processor}
        for stage, value in found.items():
            seconds[stage] += value
        cells, steps, logs = cells + len(finished.run.cells), steps + count, logs | sizes
    begin = perf_counter()
    for path in logs:
        read_back(path)
    seconds["reading"] = perf_counter() - begin
    rate = growth(next(iter(logs)), steps) if len(logs) == 1 else float("nan")
    return Sample(seconds, cells, steps, sum(logs.values()), rate)


def growth(path: Path, steps: int) -> float:
    """Return by how much a log grows with a step [byte], over the last quarter of its run."""
    with path.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    duration = max(chunk.message_end_time for chunk in summary.chunk_indexes)  # [ns]
    chunks = [
        (chunk.message_start_time / duration * steps, chunk.compressed_size)
        for chunk in summary.chunk_indexes
    ]
    return growth_of(chunks, steps)


def growth_of(chunks: Sequence[tuple[float, int]], steps: int) -> float:
    """Return the growth [byte/step] over the last quarter; chunks: first step and size [byte].

    It begins with the first chunk that lies in it whole; without one, it is that of the whole run.
    Of `steps` steps there are one more states: step 0 is the initial one.
    """
    late = [first for first, _ in chunks if first >= 0.75 * steps]
    start = min(late) if late else 0.0
    return sum(size for first, size in chunks if first >= start) / (steps + 1 - start)
