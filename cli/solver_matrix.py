"""`lavender check --solver`: prints the matrix of verdicts, case by solver, and what failed."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from lavender_cli import printing

if TYPE_CHECKING:
    from rich.table import Table

    from lavendersim.runner.matrix_entry import Entry
    from lavendersim.runner.solver_matrix import Case

# What an entry shows: a word as well as a colour, capitals where it is no pass.
WORDS = {
    "passes": ("pass", "green"),
    "known failure": ("known", "yellow"),
    "fails": ("FAIL", "bold red"),
    "beyond bounds": ("BOUNDS", "bold red"),
    "diverged": ("DIVERGED", "bold red"),
    "refused": ("REFUSED", "bold red"),
    "died": ("DIED", "bold red"),
    "not judged": ("UNJUDGED", "yellow"),
}
UNWRAPPED = 200  # columns of a pipe


def check_by(
    experiments: Sequence[Any],
    solvers: Sequence[str],
    runs: Path,
    jobs: int,
    report: Path | None,
    as_json: bool,
    of_engines: list[str] | None = None,
) -> bool:
    """Run every case by every solver and print the matrix; False where more than known fails.

    of_engines: these are engines, with overrides for each case; what one cannot do is refused,
    which is no failure. None: solvers.
    """
    engines = of_engines is not None
    from lavendersim.errors import UsageError
    from lavendersim.runner.solver_matrix import cases_of, entries, make_engine_entry, make_entry

    make = make_entry if of_engines is None else partial(make_engine_entry, more=of_engines)
    cases, left_out = cases_of(experiments)
    if not cases:
        name, why = next(iter(left_out.items()))
        raise UsageError(
            f"nothing here is put to several {'engines' if engines else 'solvers'}: {name} {why}"
        )
    made: list[Entry] = []
    damaged: list[str] = []
    try:
        for entry in entries(cases, solvers, runs, jobs, make):
            made.append(entry)
            total = len(cases) * len(solvers)
            why = f": {entry.why}" if entry.why else ""
            progress = f"{len(made)} of {total}  {entry.solver}  {entry.case}"
            typer.echo(f"{progress}  {entry.verdict}{why}", err=True)
    finally:
        # what an interrupted matrix has is shown; what it has not stands as not run
        if report is not None:
            what = "engine" if engines else "solver"
            damaged = _write(report, cases, solvers, made, left_out, what)
        if as_json:
            printing.as_json(as_data(cases, solvers, made, left_out))
        else:
            print_matrix(cases, solvers, made, left_out, of_engines=engines)
    printing.report_damage(damaged)
    if damaged:
        raise typer.Exit(printing.DAMAGED)
    beside = {"refused", "not judged"} if engines else set()
    return all(entry.fine or entry.verdict in beside for entry in made)


def as_data(
    cases: Sequence[Case],
    solvers: Sequence[str],
    made: Sequence[Entry],
    left_out: dict[str, str],
) -> dict[str, Any]:
    """Return the matrix as plain data; JSON has no number for what is not one."""
    from lavendersim.runner.environment import processor
    from lavendersim.runner.matrix_entry import passed

    return {
        "passed": all(entry.fine for entry in made),
        "processor": processor(),
        "cases": [case.name for case in cases],
        "reduced": [case.name for case in cases if case.reduced],
        "left_out": left_out,
        "solvers": {solver: passed(made, solver) for solver in solvers},
        "entries": [
            {name: None if value != value else value for name, value in entry._asdict().items()}
            for entry in made
        ],
    }


def _write(
    report: Path,
    cases: Sequence[Case],
    solvers: Sequence[str],
    made: Sequence[Entry],
    left_out: dict[str, str],
    what: str,
) -> list[str]:
    """Write the page; returns a sentence of each log that has no picture for its damage."""
    from lavendersim.figures import write_matrix
    from lavendersim.peers.catalogue import facts_of
    from lavendersim.runner import open_run
    from lavendersim.runner.environment import processor

    pictured = {entry.case: entry for entry in reversed(made) if entry.run is not None}
    shown = {name: open_run(entry.run).cells[0] for name, entry in pictured.items()}
    place: dict[str, Any] = {"path": report, "what": what}
    if what == "engine":
        place["about"] = {engine: facts_of(engine) for engine in solvers}
    write_matrix(cases, solvers, made, left_out, shown=shown, processor=processor(), **place)
    typer.echo(f"report {report}", err=True)
    return [sentence for cell in shown.values() if (sentence := cell.damage())]


def print_matrix(
    cases: Sequence[Case],
    solvers: Sequence[str],
    made: Sequence[Entry],
    left_out: dict[str, str],
    width: int | None = None,
    of_engines: bool = False,
) -> None:
    """Print the matrix, what failed below it, and what is not in it, wrapped to the terminal.

    of_engines: every entry stands below it, with its number, its spread and what its steps had.
    """
    with printing.by_rich(width, UNWRAPPED) as console:
        console.print(_matrix(cases, solvers, made))
        for solver in solvers:
            own = [one for one in made if one.solver == solver]
            bad = own if of_engines else [one for one in own if one.verdict != "passes"]
            if of_engines:
                console.print()
                console.print(solver, style="bold")
                console.print(effort_line(solver), style="dim")
                console.print(_failures(bad))
            elif bad:
                console.print()
                console.print(solver, style="bold")
                console.print(_failures(bad))
        if left_out:
            console.print("\nnot in the matrix", style="bold")
            for why in dict.fromkeys(left_out.values()):
                names = [name for name, reason in left_out.items() if reason == why]
                console.print(f"{why}: {', '.join(names)}")
        if reduced := [case.name for case in cases if case.reduced]:
            console.print(f"\nreduced, --full runs all of them: {', '.join(reduced)}")


def _matrix(cases: Sequence[Case], solvers: Sequence[str], made: Sequence[Entry]) -> Table:
    from rich.table import Table
    from rich.text import Text

    from lavendersim.runner.matrix_entry import passed

    table = Table(
        box=None, padding=(0, 2, 0, 0), header_style="bold", pad_edge=False, show_footer=True
    )
    table.add_column("case", footer="passed", no_wrap=True)
    for solver in solvers:
        # a word a line: names of three words would take the space of the entries
        run = sum(entry.solver == solver for entry in made)
        foot = f"{passed(made, solver)} of {run}" if run else "not run"
        table.add_column(solver.replace("_", "\n"), footer=foot, vertical="bottom")
    places = {(entry.case, entry.solver): entry for entry in made}
    family = ""
    for case in cases:
        before, family = family, case.name.rpartition("/")[0]
        if before and before != family:
            table.add_row()
        found = [places.get((case.name, solver)) for solver in solvers]
        words = [WORDS[one.verdict] if one is not None else ("-", "dim") for one in found]
        table.add_row(case.name, *(Text(word, style) for word, style in words))
    table.add_row()
    return table


def _failures(bad: Sequence[Entry]) -> Table:
    from rich.table import Table
    from rich.text import Text

    table = Table.grid(padding=(0, 2, 0, 0))
    table.add_column(no_wrap=True)
    table.add_column(no_wrap=True)
    table.add_column()
    for entry in bad:
        word, style = WORDS[entry.verdict]
        table.add_row(f"  {entry.case}", Text(word, style), _why(entry))
    return table


def _why(entry: Entry) -> str:
    """Return what is behind an entry: its claim, over its starts, and what its steps cost."""
    from lavendersim.quantities.short_times import short_time

    text = entry.why or entry.claim
    if entry.least == entry.least:
        text += f" (over its starts {entry.least:.3g} to {entry.most:.3g})"
    reported = [
        f"{value:.3g} {name} a step"
        for value, name in ((entry.contacts, "contacts"), (entry.iterations, "iterations"))
        if value == value
    ]
    if reported and entry.cost == entry.cost:
        reported.insert(0, f"{short_time(entry.cost)} per simulated s")
    return "; ".join(filter(None, (text, ", ".join(reported))))


def effort_line(engine: str) -> str:
    """Return what an engine's iterations are, and for how many contacts it has room."""
    from lavendersim.peers import catalogue

    return catalogue.effort_of(engine)
