"""`lavender open`: shows the page or the figures of a run in the programs of the desktop."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lavender_cli.completion import run_names
from lavender_cli.run import Runs

PAGES, PICTURES = (".html", ".htm"), (".png", ".svg", ".pdf")


def open_(
    what: Annotated[
        Path | None,
        typer.Argument(
            metavar="[RUN_OR_FILE]",
            help="Run directory, page or figure; the latest run by default.",
            autocompletion=run_names,
        ),
    ] = None,
    runs: Runs = Path("runs"),
    only_print: Annotated[
        bool, typer.Option("--print", help="Print the files that would be opened, and stop.")
    ] = False,
) -> None:
    """Open the page of a run where it has one, else its figures; or the file that is named."""
    from lavendersim.errors import MissingDriverError, UsageError
    from lavendersim.runner import open_run

    if what is not None and what.is_file():
        if what.suffix not in (*PAGES, *PICTURES):
            raise UsageError(f"{what}: expected a page (.html) or a figure (.png, .svg, .pdf)")
        found = [what]
    else:
        run = open_run(what, runs)
        found = shown_of(run.path)
        if not found:
            raise UsageError(
                f"{run.path}: it has neither a page nor a figure; `lavender plot` draws its figure"
            )
    for file in found:
        typer.echo(file)
        if not only_print and typer.launch(str(file.resolve())):
            raise MissingDriverError(f"{file}: no program was found that opens it")


def shown_of(run: Path) -> list[Path]:
    """Return the pages in a run's directory; where it has none its figures, one file of each."""
    pages = sorted(file for file in run.iterdir() if file.suffix in PAGES)
    return pages or sorted((run / "figures").glob("*.png"))
