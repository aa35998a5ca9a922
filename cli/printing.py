"""Text that several verbs print: verdicts, costs, warnings and JSON."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from rich.console import Console

FAILURES_SHOWN = 10
DAMAGED = 3  # exit code of a verb that met a log which is not whole
CELLS_SHOWN = 12  # of a larger sweep the range is printed; results.csv and `show` have each


def digits(value: float) -> str:
    """Return a number with the digits a person can use."""
    return f"{value:.6g}"


def digits_between(values: list[float]) -> str:
    """Return the least and the greatest of some numbers; one where they are equal."""
    low, high = min(values), max(values)
    return digits(low) if low == high else f"{digits(low)} to {digits(high)}"


def byte_size(count: float, digits: int = 3) -> str:
    """Return a number of bytes in the unit that suits it."""
    for unit, size in (("TB", 1e12), ("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if count >= 0.9995 * size:  # three digits of the larger unit, never 1e+03
            rounded = float(f"{count / size:.{digits}g}")
            return f"{rounded:g} {unit}"
    return f"{count:.0f} B"


def time_span(seconds: float) -> str:
    """Return a time by the clock on the wall: its two largest units, at least seconds."""
    whole = round(seconds)
    hours, minutes, rest = whole // 3600, whole // 60 % 60, whole % 60
    if hours >= 48:
        return f"{hours // 24} days {hours % 24} h"
    if hours:
        return f"{hours} h {minutes} min"
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"


def mark(passed: bool | None) -> str:
    """Return a coloured word; typer drops the colour where NO_COLOR or a pipe requires it.

    None: not judged.
    """
    if passed is None:
        return typer.style("----", fg=typer.colors.YELLOW)
    if passed:
        return typer.style("pass", fg=typer.colors.GREEN)
    return typer.style("FAIL", fg=typer.colors.RED, bold=True)


def print_unjudged(finished: Any) -> None:
    """Print the measures of which nothing is expected: of each the range over the cells."""
    from lavendersim.measures.meanings import RATIO, meaning_of

    experiment, taken = finished.run.experiment, finished.run.taken
    for name in experiment.unjudged:
        values = [cell[name] for cell in taken.values() if name in cell]
        numbers = [value for value in values if isinstance(value, float | int)]
        spec = experiment.measures[name]
        known = [number for number in numbers if number == number]
        unit = meaning_of(spec)[1].removeprefix(RATIO)
        if known:
            typer.echo(f"        {name}: {digits_between(known)} {unit}".rstrip())
        if missing := len(numbers) - len(known):
            cells = f" in {missing} of {len(numbers)} cells" if len(numbers) > 1 else ""
            why = f": {spec.NO_NUMBER}" if spec.NO_NUMBER else ""
            typer.echo(f"        {name}: no number{cells}{why}")
        for reason in dict.fromkeys(value for value in values if isinstance(value, str)):
            typer.echo(f"        {name}: {reason}")


def print_costs(finished: Any) -> None:
    """Print what a run cost: physics by cell, logging and compilation once."""
    outcomes, reduced = finished.outcomes, finished.run.experiment.options.reduced
    steps = sum(outcome.steps for outcome in outcomes)
    logging = sum(outcome.logging_ns for outcome in outcomes) / max(steps, 1) / 1000
    physics = [outcome.physics_ns / max(outcome.steps, 1) / 1000 for outcome in outcomes]
    low, high = min(physics), max(physics)
    listed = 1 < len(physics) <= CELLS_SHOWN
    spread = (
        "" if listed else f"physics {low:.2f}{f' to {high:.2f}' if high > low else ''} us/step, "
    )
    typer.echo(
        f"{typer.style(finished.run.name, bold=True)}{' (reduced)' if reduced else ''}: "
        f"{len(outcomes)} cell{'s' if len(outcomes) > 1 else ''}, {steps} steps; {spread}"
        f"logging {logging:.2f} us/step, compile {finished.compile_s:.1f} s"
    )
    for cell, cost in zip(finished.run.cells, physics, strict=True) if listed else ():
        typer.echo(f"  physics {cost:10.2f} us/step  {cell.label}")


def warn_of_mistakes(experiment: Any) -> None:
    """Print to stderr which deliberate errors an experiment makes, and in how many cells."""
    for mistake, cells in experiment.mistakes.items():
        total = len(experiment.cells())
        where = "" if total == 1 else f" in {len(cells)} of {total} cells"
        warning = f"study-only: {mistake}, a deliberate error{where}"
        typer.echo(f"{experiment.name}: {typer.style(warning, fg=typer.colors.YELLOW)}", err=True)


def warn_of_untried(experiments: Iterable[Any], engines: Iterable[str] = ()) -> None:
    """Print to stderr which engines have a version that was never tried, each once a command.

    engines: beside those that the experiments name.
    """
    from lavendersim.peers.catalogue import untried

    named = [name for one in experiments for name in one.engines]
    for sentence in untried([*engines, *named]):
        typer.echo(typer.style(sentence, fg=typer.colors.YELLOW), err=True)


def warn_of_not_converged(finished: Any) -> None:
    """List on stderr the cells whose steps did not all converge, the first few by name."""
    for notice in finished.not_converged[:FAILURES_SHOWN]:
        typer.echo(notice, err=True)
    if len(finished.not_converged) > FAILURES_SHOWN:
        more = len(finished.not_converged) - FAILURES_SHOWN
        typer.echo(f"{finished.run.name}: and {more} more cells, see results.csv", err=True)


def report_damage(sentences: list[str], refused: str = "") -> None:
    """Print to stderr which logs are damaged, the first few; exits with 3 where that is refused.

    refused: what is not done for it; where it is empty the verb goes on.
    """
    for sentence in sentences[:FAILURES_SHOWN]:
        typer.echo(sentence, err=True)
    if len(sentences) > FAILURES_SHOWN:
        typer.echo(f"and {len(sentences) - FAILURES_SHOWN} more that are damaged", err=True)
    if sentences and refused:
        allow = "--allow-incomplete takes what is whole, and marks it"
        typer.echo(f"{refused}; {allow}", err=True)
        raise typer.Exit(DAMAGED)


@contextmanager
def by_rich(width: int | None, of_a_pipe: int) -> Iterator[Console]:
    """Give a console, and print what it was given: wrapped to the terminal, without its spaces.

    width: columns in place of the terminal's; of_a_pipe: where there is none.
    """
    from rich.console import Console

    wrapped = sys.stdout.isatty() or width is not None
    console = Console(width=width if wrapped else of_a_pipe, highlight=False, markup=False)
    with console.capture() as captured:
        yield console
    for line in captured.get().splitlines():
        typer.echo(line.rstrip())


def as_json(data: Any) -> None:
    """Print one JSON document."""
    typer.echo(json.dumps(data, indent=1, default=str))
