"""`lavender show`: prints the question, plan, cells, measures and verdicts of a run."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from lavender_cli import cell_lines, claims, printing
from lavender_cli.replay import cell_of
from lavender_cli.run import LatestRun, Runs

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lavendersim.runner import Run, RunCell

Metadata = dict[str, dict[str, str]]
# of a log's metadata
SECTIONS = ("plan", "shape pairs", "forced", "study-only", "recorded")
OF_ENGINE = ("version", "variant", "settings", "law", "repeats")  # of another engine's log


def show(
    run: LatestRun = None,
    runs: Runs = Path("runs"),
    cell: Annotated[
        int | None,
        typer.Option("--cell", metavar="K", help="One cell, counted from 0: its log, its numbers."),
    ] = None,
    verbose: claims.Verbose = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the results as JSON.")] = False,
) -> None:
    """Show a run: its question, the effects it simulated, what it measured and its verdicts.

    Of many cells the ranges and the worst, of claims the counts; with -v each of them.
    Exits 3 when one of its logs was cut or is damaged where the plan is read.
    """
    from lavendersim.runner import open_run

    opened = open_run(run, runs)
    if cell is not None:
        _show_cell(opened, cell, as_json)
        return
    results = opened.results()
    if as_json:
        printing.as_json(results.as_json)
        _end(opened.cut())
        return
    typer.echo(f"{typer.style(opened.name, bold=True)}  {opened.path}")
    if opened.not_understood:
        typer.echo(opened.not_understood, err=True)
    for name in ("question", "expected"):
        if text := opened.config_data.get(name):
            typer.echo(f"{name}  {text}")
    if opened.options.solver is not None:
        typer.echo(f"solver  {opened.options.solver}, instead of the config's")
    logged = plans_of(opened.cells)
    for plan in logged.plans:
        print_plan(plan, len(opened.cells))
    logging = results.mean_per_step("logging_us_per_step")
    compiled = "not recorded" if results.compile_s is None else f"{results.compile_s:.1f} s"
    typer.echo(f"cells  logging {logging:.2f} us/step, compile {compiled}")
    cell_lines.print_cells(results.cells, verbose)
    typer.echo("checks")
    claims.print_claims(results.checks, verbose)
    claims.print_failures([], results.checks, verbose)
    _end(logged.damaged)


def _show_cell(opened: Run, number: int, as_json: bool) -> None:
    """Print where the log of a cell is, what replays it, and what was measured of it."""
    cell = cell_of(opened, number)
    row = next(row for row in opened.results().cells if row.index == cell.index)
    command = f"lavender replay {shlex.quote(str(opened.path))} --cell {number}"
    if as_json:
        printing.as_json({**row.as_json, "log": cell.path, "replay": command})
    else:
        typer.echo(f"{typer.style(cell.label or opened.name, bold=True)}  {cell.status}")
        typer.echo(f"log     {cell.path}")
        typer.echo(f"replay  {command}")
        for name, value in row.measures.items():
            shown = printing.digits(value) if isinstance(value, float | int) else value
            typer.echo(f"  {name}  {shown}")
    damage = cell.damage()
    _end([damage] if damage else [])


def _end(damaged: list[str]) -> None:
    """Say which logs are damaged, and exit 3 where one is."""
    printing.report_damage(damaged)
    if damaged:
        raise typer.Exit(printing.DAMAGED)


class LoggedPlan(NamedTuple):
    """A plan as logs describe it, and the cells that were run by it."""

    cells: list[RunCell]
    metadata: Metadata  # SECTIONS, and OF_ENGINE


class LoggedPlans(NamedTuple):
    """The plans of a run."""

    plans: list[LoggedPlan]
    damaged: list[str]  # a sentence of each log that describes none


def plans_of(cells: Sequence[RunCell]) -> LoggedPlans:
    """Return each different plan that the logs describe."""
    from lavendersim.errors import TraceError

    plans: dict[str, LoggedPlan] = {}
    damaged: dict[str, None] = {}
    for cell in cells:
        try:
            metadata = cell.trace().metadata
        except TraceError as error:
            damaged[str(error)] = None
            continue
        cell.release()
        plan = {name: metadata.get(name, {}) for name in SECTIONS}
        engine = metadata.get("engine", {})
        plan["engine"] = {key: engine[key] for key in OF_ENGINE if engine.get(key)}
        plans.setdefault(repr(plan), LoggedPlan([], plan)).cells.append(cell)
    return LoggedPlans(list(plans.values()), list(damaged))


def print_plan(plan: LoggedPlan, count: int) -> None:
    """Print one plan: what is on with its reason, what is off by name, what was overridden.

    count: the cells of the run.
    """
    cells, metadata = plan
    more = "" if len(cells) == 1 else f" and {len(cells) - 1} more"
    typer.echo("plan" if len(cells) == count else f"plan of {cells[0].label}{more}")
    forced = metadata["forced"]
    if forced:
        changes = "; ".join(f"{name} {how}" for name, how in forced.items())
        typer.echo(typer.style(f"  overridden by hand: {changes}", fg=typer.colors.YELLOW))
    for mistake, text in metadata["study-only"].items():
        typer.echo(typer.style(f"  study-only: {mistake}, {text}", fg=typer.colors.YELLOW))
    for key, which in metadata["recorded"].items():
        typer.echo(f"  {key} recorded: {which}")
    for key, text in metadata["engine"].items():
        typer.echo(f"  {key:{max(map(len, OF_ENGINE))}}  {text}")
    parts = {**metadata["plan"], **metadata["shape pairs"]}
    width = max(map(len, parts), default=0)
    off = []
    for name, decision in parts.items():
        on, _, reason = decision.partition(": ")
        if on == "on" or name in forced:
            typer.echo(f"  {name:{width}}  {on:3}  {reason}")
        else:
            off.append(name)
    if off:
        typer.echo(f"  off: {', '.join(off)}")
