"""`lavender rm`: removes runs, those that are named or those that are old, large or tagged."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from lavender_cli import printing
from lavender_cli.asking import confirmed
from lavender_cli.completion import run_names
from lavender_cli.ls import Name, Newer, Older, Tag, VerdictOption, line_of, wanted_of
from lavender_cli.run import Runs


def rm(
    named: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="[RUN]...",
            help="Run directories; or options say which.",
            autocompletion=run_names,
        ),
    ] = None,
    runs: Runs = Path("runs"),
    name: Name = None,
    verdict: VerdictOption = None,
    tag: Tag = None,
    older: Older = None,
    newer: Newer = None,
    larger: Annotated[
        str | None, typer.Option("--larger", metavar="SIZE", help="Of logs such as 200MB or more.")
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", "-y", help="Do not ask.")] = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", "-n", help="Say what would be removed, and stop.")
    ] = False,
) -> None:
    """Remove runs. By options, the newest finished run of each experiment stays; asks first."""
    from lavendersim.errors import UsageError
    from lavendersim.runner.listing import RunFilter, listed
    from lavendersim.runner.remove_runs import named_run, removable, remove, remove_leftovers

    wanted = wanted_of(name, verdict, tag, older, newer, larger)
    if bool(named) == (wanted != RunFilter()):
        raise UsageError("expected either runs by name, or options that say which are removed")
    if named:
        each = (named_run(path, runs) for path in named)
        found = [*{one.run.path: one for one in each}.values()]
    else:
        found = removable(list(listed(runs, wanted)), runs)
    if not found:
        typer.echo("nothing to remove", err=True)
        return
    for one in found:
        typer.echo(line_of(one))
    size = printing.byte_size(sum(one.size for one in found))
    what = f"{len(found)} run{'s' if len(found) > 1 else ''}, {size}"
    if dry_run:
        typer.echo(f"would remove {what}")
        return
    if not yes:
        if not sys.stdin.isatty():
            raise UsageError(f"{what}: not removed, there is nobody to ask: --yes removes them")
        if not confirmed(f"Remove {what}?"):
            typer.echo("nothing is removed")
            return
    remove_leftovers(runs)
    remove([one.run for one in found], runs)
    typer.echo(f"removed {what}")
