"""`lavender cost`: measures error and time over settings; prints a table and draws the figure."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lavender_cli import printing, progress
from lavender_cli.going_on import as_words, command_of, interruptible
from lavender_cli.prediction import Yes, confirm
from lavender_cli.run import Configs, Engines, Jobs, Runs, Set, Starts, Strict, Sweep, overrides_of

if TYPE_CHECKING:
    from lavendersim.measures.cost_table import CostRow, CostTable

HEADER = ("setting", "error", "worst at", "order", "residual m/s", "per simulated s", "quartiles")
BESIDE = ("contacts", "iterations")  # a step; where other engines are in the table
MARKS = {"specified": "specified", "chapter": "the chapter's", "grid": ""}


def cost(
    configs: Configs,
    targets: Annotated[
        list[str] | None,
        typer.Option(
            "--target",
            metavar="PERCENT",
            help="Print the cheapest setting with this error as YAML, such as 0.1%.",
        ),
    ] = None,
    repeats: Annotated[
        int | None, typer.Option("--repeats", help="Rounds in place of the config's; 7 or more.")
    ] = None,
    engine: Engines = None,
    starts: Starts = None,
    quick: Annotated[
        bool,
        typer.Option("--quick", help="Every other setting of the grid, in the fewest rounds."),
    ] = False,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the newest run where it did not finish.")
    ] = False,
    plot: Annotated[bool, typer.Option("--plot/--no-plot", help="Draw the figure.")] = True,
    jobs: Jobs = 1,
    strict: Strict = False,
    values: Set = None,
    axes: Sweep = None,
    runs: Runs = Path("runs"),
    yes: Yes = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the tables as JSON.")] = False,
) -> None:
    """Measure what accuracy costs: error and time over timestep, solver, sweeps and warm start.

    With --engine: of other engines, too, each over the timesteps and what its declaration varies.

    Ctrl-C keeps what was run, and what was timed by then. Exits 1 when no engine reaches a target
    that was given.
    """
    from lavendersim.errors import UsageError
    from lavendersim.experiment.sweeps import perturbed_starts
    from lavendersim.peers import catalogue
    from lavendersim.runner import load_all
    from lavendersim.runner.cost import check_cost, grid_of, take_cost
    from lavendersim.runner.cost_targets import percentage
    from lavendersim.runner.prediction import planned_before

    sought = [percentage(target) for target in targets or ()]
    engines = catalogue.chosen(engine) if engine else ()
    asked, starts = starts, perturbed_starts.starts_of(starts, engines)
    given = [*overrides_of(values, axes), *perturbed_starts.overrides_of(starts)]
    # In a folder those with a section `cost` are meant; a file that is named must have one.
    experiments = [
        one
        for one in load_all(configs, overrides=given, strict=strict)
        if one.config.cost is not None or one.path in configs
    ]
    if quick:
        from lavendersim.experiment.sweeps.quick import quick as in_few_rounds

        experiments = [in_few_rounds(one) for one in experiments]
    if not experiments:
        raise UsageError(f"{configs[0]}: no config in this folder has a section cost")
    for experiment in experiments:
        check_cost(experiment, repeats)
    printing.warn_of_untried(experiments, engines)
    grids = [grid_of(one, engines) for one in experiments]
    planned = [None if resume else planned_before(grid, jobs) for grid in grids]
    if not resume:  # it was asked before
        confirm(([grid] for grid in grids), runs, jobs, yes, [one for one in planned if one])
    tables, missed, interrupted = [], False, ""
    options = {"--target": targets, "--repeats": repeats, "--engine": engine, "--starts": asked}
    options |= {"--runs": runs, "--jobs": jobs if jobs > 1 else None, "--quick": quick}
    options |= {"--strict": strict, "--no-plot": not plot}
    go_on = command_of("cost", configs, overrides_of(values, axes), *as_words(options), "--resume")
    for experiment, prepared in zip(experiments, planned, strict=True):
        with interruptible(go_on), progress.reporting(experiment.name) as shown:
            costed = take_cost(
                experiment,
                *(runs, jobs, shown, sought, repeats),
                engines=engines,
                is_quick=quick,
                resume=resume,
                is_predicted=not resume,
                prepared=prepared,
            )
        run = costed.finished.run
        reached = {one.target for one in costed.table.targets if one.reached}
        missed = missed or not reached.issuperset(sought)
        figures = []
        if plot:
            from lavendersim.figures import draw

            figures = draw(run, run.path / "figures")
        tables.append({**costed.table.as_data(), "run": run.path, "figures": figures})
        interrupted = costed.table.interrupted
        if not as_json:
            # With targets given, stdout is what is to be pasted, and nothing else.
            print_table(costed.table, aside=bool(sought))
            for figure in figures:
                typer.echo(f"  figure {figure}", err=bool(sought))
            typer.echo(f"  run    {run.path}", err=bool(sought))
            if sought:
                several = len(experiments) * len(costed.table.targets) > 1
                _print_fragments(costed.table, several)
        if interrupted:
            break
    if as_json:
        printing.as_json(tables)
    if interrupted:
        typer.echo(interrupted, err=True)
        raise KeyboardInterrupt
    if sought and missed:
        raise typer.Exit(1)


def _print_fragments(table: CostTable, several: bool) -> None:
    for target in table.targets:
        if target.reached:
            if several:
                typer.echo(f"# {table.experiment}: {target.sentence}")
            typer.echo(target.fragment, nl=False)


def print_table(table: CostTable, aside: bool = False) -> None:
    """Print a row a setting and a sentence a target; aside: to stderr."""
    for line in lines_of(table):
        typer.echo(line, err=aside)


def lines_of(table: CostTable) -> list[str]:
    """Return the table and the sentences as lines."""
    from lavendersim.runner.cost_targets import percent

    rows = table.rows
    cells = [HEADER, *(_cells(row) for row in rows)]
    if table.compares_engines:
        cells = [
            (*text, *beside)
            for text, beside in zip(cells, [BESIDE, *map(_counts, rows)], strict=True)
        ]
    # an empty column is left out
    shown = [column for column in range(len(cells[0])) if any(row[column] for row in cells[1:])]
    widths = {column: max(len(row[column]) for row in cells) for column in shown}
    lines = [
        f"{typer.style(table.experiment, bold=True)}: error of {table.error.measure}, "
        f"{_truth(table)}{', a quick grid' if table.quick else ''}; physics per simulated second, "
        f"medians of {table.repeats} interleaved repeats with quartiles; "
        f"{table.machine['processor']}"
    ]
    for text, row in zip(cells, [None, *rows], strict=True):
        columns = [
            f"{text[column]:{'<' if column in (0, 2) else '>'}{widths[column]}}" for column in shown
        ]
        notes = ", ".join(_notes(row)) if row is not None else ""
        lines.append(f"  {'  '.join(columns)}  {notes}".rstrip())
    of = " of its engine" if len(table.engines) > 1 else ""
    lines.append(f"  * none{of} is cheaper and as good")
    for law in dict.fromkeys(row.law for row in rows):
        which = [row for row in rows if row.law == law]
        least = min((row.error for row in which if row.error is not None), default=None)
        best = "" if least is None else f", at best {percent(least)}"
        lines.append(f"  law: {law} ({len(which)} settings{best})")
    compiled = sorted({row.compile_s for row in rows if row.compile_s})
    if compiled:
        span = f"{compiled[0]:.1f} to {compiled[-1]:.1f} s"
        lines.append(f"  compile time, once and in no cost: {span} an engine")
    lines += [f"  {engine}: {effort}" for engine, effort in table.efforts.items()]
    lines += [f"  {engine}: REFUSED: {why}" for engine, why in table.refused.items()]
    return lines + (table.sentences or [target.sentence for target in table.targets])


def _truth(table: CostTable) -> str:
    from lavendersim.runner.cost_targets import rate_of

    if table.truth is None:
        return "against its truth"
    solved = _residual(table.truth.worst_residual, ".1g")
    return f"against itself at {rate_of(table.truth.timestep)}, solved to {solved}"


def _residual(number: float | None, form: str) -> str:
    return "no finite residual" if number is None else f"{number:{form}} m/s"


def _cells(row: CostRow) -> tuple[str, ...]:
    from lavendersim.quantities.short_times import short_time
    from lavendersim.runner.cost_targets import effort_of, rate_of, settings_of, steps_of

    spread = row.ns_per_second
    name, start = f"{row.solver:28} {row.preset:7}", "warm" if row.warm_start else "cold"
    knobs = f"{name} {steps_of(row):>13} {effort_of(row):>12} {start}"
    if not row.is_lavender:
        knobs = f"{row.engine:28} {', '.join(settings_of(row)):7} {rate_of(row.timestep):>13}"
    return (
        knobs,
        _error_of(row),
        row.worst_at,
        "" if row.order is None else f"{row.order:.1f}",
        _residual_of(row),
        "" if spread is None else short_time(spread.median / 1e9),
        ""
        if spread is None
        else " to ".join(
            short_time(one / 1e9) for one in (spread.lower_quartile, spread.upper_quartile)
        ),
    )


def _counts(row: CostRow) -> tuple[str, ...]:
    return tuple(
        "not reported" if one is None else f"{one:.3g}" for one in (row.contacts, row.iterations)
    )


def _error_of(row: CostRow) -> str:
    """Return the worst error; of perturbed starts the least before it."""
    from lavendersim.runner.cost_targets import percent

    if row.error is None:
        return "none"
    least = "" if row.least_error is None else f"{percent(row.least_error)} to "
    return f"{least}{percent(row.error)}"


def _residual_of(row: CostRow) -> str:
    if row.worst_residual is not None:
        return f"{row.worst_residual:.1e}"
    return "not finite" if row.is_lavender else "not reported"


def _notes(row: CostRow) -> list[str]:
    notes = ["*"] if row.front else []
    notes += [MARKS[row.role]] if MARKS[row.role] else []
    if row.failed:
        return [*notes, f"FAILED: {row.failed}"]
    if row.not_converged_steps:
        from lavendersim.runner.cost_errors import not_converged_steps

        notes.append(not_converged_steps(row.not_converged_steps, row.steps, row.tolerance))
    return notes
