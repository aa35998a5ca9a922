"""`lavender check`: runs configs and prints a verdict per expectation and cell, or a matrix."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from lavender_cli import claims, printing, progress, solver_matrix, time_errors
from lavender_cli.prediction import Yes, confirm, with_refined
from lavender_cli.run import (
    Configs,
    Engines,
    Jobs,
    Refine,
    Runs,
    Set,
    Starts,
    Strict,
    Sweep,
    Threads,
    overrides_of,
    share_sweeps,
)


def check(
    configs: Configs,
    jobs: Jobs = 1,
    threads: Threads = None,
    runs: Runs = Path("runs"),
    full: Annotated[
        bool, typer.Option("--full", help="Run slow experiments in full, not reduced.")
    ] = False,
    report: Annotated[
        Path | None,
        typer.Option("--report", metavar="FILE.html", help="Write a page: a row per case."),
    ] = None,
    solver: Annotated[
        list[str] | None,
        typer.Option(
            *("--solver", "-s"),
            metavar="NAME",
            help="A matrix: every case by each of these instead of the config's solver, with "
            "commas between; `all` is every one.",
        ),
    ] = None,
    engine: Engines = None,
    starts: Starts = None,
    refine: Refine = False,
    values: Set = None,
    axes: Sweep = None,
    strict: Strict = False,
    verbose: claims.Verbose = False,
    yes: Yes = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the verdicts as JSON.")] = False,
) -> None:
    """Run experiments and print their verdicts: of each claim the count and the worst cell.

    With -v: every verdict, cell by cell. Exits 1 when one fails.

    With --solver, or --engine: a matrix of verdicts, case by solver or engine. Exits 1 when one
    fails a case in more than what the case declares; a known failure is
    no pass, but no error either.
    """
    from lavendersim.errors import UsageError
    from lavendersim.experiment.sweeps import perturbed_starts
    from lavendersim.figures import check_page_path, write_report
    from lavendersim.runner import load_all, run
    from lavendersim.runner.environment import about
    from lavendersim.runner.prediction import planned_before

    share_sweeps(threads)
    overrides = overrides_of(values, axes)
    if solver and engine:
        raise UsageError("a matrix is of solvers or of engines: leave out --solver or --engine")
    columns: tuple[str, ...] = ()
    if solver or engine:
        from lavendersim.peers import catalogue
        from lavendersim.runner.solver_cases import about_something_else
        from lavendersim.runner.solver_matrix import chosen

        if overrides:
            raise UsageError("a matrix is of cases as they stand: leave out --set and --sweep")
        if refine:
            raise UsageError("--refine tells time errors of one run: leave out --solver, --engine")
        if starts and solver:
            raise UsageError("--starts is for engines: leave out --solver")
        # a wrong name is refused before any file is read
        columns = catalogue.chosen(engine) if engine else chosen(solver or ())
        starts = perturbed_starts.starts_of(starts, columns) if engine else None
    perturbed = perturbed_starts.overrides_of(starts)
    if not columns:
        overrides += perturbed
    experiments = load_all(configs, not full, overrides, strict)
    if report is not None:
        check_page_path(report)  # not after an hour of runs
    printing.warn_of_untried(experiments, columns if engine else ())
    if columns:
        cases = [one for one in experiments if not about_something_else(one)]
        count = len(columns) * (starts or 1)
        confirm(([one] * count for one in cases), runs, jobs, yes)
        by_engine = perturbed if engine else None
        if not solver_matrix.check_by(experiments, columns, runs, jobs, report, as_json, by_engine):
            raise typer.Exit(1)
        return
    planned = [planned_before(one, jobs) for one in experiments]
    each = (with_refined(one) if refine else [one] for one in experiments)
    confirm(each, runs, jobs, yes, [one for one in planned if one])
    good, verdicts, cells, results, refined = True, [], [], [], []
    for experiment, prepared in zip(experiments, planned, strict=True):
        printing.warn_of_mistakes(experiment)
        with progress.reporting(experiment.name) as shown:
            finished = run(
                experiment,
                *(runs, jobs, shown),
                overheads=False,
                is_predicted=True,
                prepared=prepared,
            )
        good = good and finished.good
        results.append(finished)
        printing.warn_of_not_converged(finished)
        found = time_errors.refine(finished, jobs) if refine else []
        refined += [{"experiment": experiment.name, **row} for row in time_errors.as_table(found)]
        cells += [
            {"experiment": experiment.name, "cell": cell.label, "status": cell.status}
            for cell in finished.run.cells
        ]
        verdicts += [
            {"experiment": experiment.name, **verdict.row} for verdict in finished.verdicts
        ]
        if as_json:
            continue
        count = len(finished.run.cells)
        title = typer.style(experiment.name, bold=True)
        typer.echo(f"{title}: {count} cell{'s' * (count != 1)}")
        claims.print_claims(finished.verdicts, verbose)
        claims.print_failures(finished.ended_early, finished.verdicts, verbose)
        if refine:
            time_errors.print_table(found)
    damaged: list[str] = []
    if report is not None:
        damaged = write_report(results, report, about(sys.argv[1:]))
        typer.echo(f"report {report}", err=True)
        printing.report_damage(damaged)
    if as_json:
        table = {"passed": good, "cells": cells, "verdicts": verdicts}
        printing.as_json(table | ({"time_errors": refined} if refine else {}))
    else:
        passed = sum(bool(verdict["passed"]) for verdict in verdicts)
        unjudged = sum(not verdict.get("judged", True) for verdict in verdicts)
        left = f"{unjudged} not judged, " if unjudged else ""
        ended = sum(cell["status"] == "complete" for cell in cells)
        short = sum(experiment.options.reduced for experiment in experiments)
        typer.echo(
            f"{passed} of {len(verdicts)} expectations met, {left}"
            f"{ended} of {len(cells)} cells complete"
            + (
                f"; {short} experiment{'s' * (short != 1)} reduced, --full runs all of them"
                if short
                else ""
            )
        )
    if damaged:
        raise typer.Exit(printing.DAMAGED)
    if not good:
        raise typer.Exit(1)
