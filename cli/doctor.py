"""`lavender doctor`: prints versions, machine and kernel cache; deletes kernels and leftovers."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lavender_cli.run import Runs


def doctor(
    clean: Annotated[
        bool,
        typer.Option(
            "--clean", help="Delete the compiled kernels, and what killed runs left half written."
        ),
    ] = False,
    clean_stale: Annotated[
        bool, typer.Option("--clean-stale", help="Delete those of other versions only.")
    ] = False,
    runs: Runs = Path("runs"),
) -> None:
    """Show the machine, the versions and the kernel cache; clean it with an option."""
    from lavendersim.runner.environment import delete_kernels, kernel_limit, kernels, machine

    for name, value in machine().items():
        typer.echo(f"{name:14} {value}")
    typer.echo(f"{'in use':14} {kernels(current=True)}")
    typer.echo(f"{'stale':14} {kernels(current=False)}, of other versions or settings")
    typer.echo(f"{'limit':14} {kernel_limit() / 1e6:.0f} MB; the least recently used go first")
    refused = False
    for stale in [True] * (clean or clean_stale) + [False] * clean:
        kind = "stale" if stale else "in use"
        found = delete_kernels(current=not stale)
        typer.echo(f"{'deleted':14} {found.kernels}, {kind}")
        if found.left.files:
            refused = True
            typer.echo(f"{'not deleted':14} {found.left}, {kind}: {found.why}", err=True)
    if clean:
        from lavendersim.runner.leftovers import clean as clean_runs

        left = clean_runs(runs)
        typer.echo(f"{'deleted':14} {left}, half written in {runs}")
    if refused:
        raise typer.Exit(2)
