"""`lavender doctor`: prints versions, machine and kernel cache, and empties the cache."""

from __future__ import annotations

from typing import Annotated

import typer


def doctor(
    clean: Annotated[bool, typer.Option("--clean", help="Delete the compiled kernels.")] = False,
    clean_stale: Annotated[
        bool, typer.Option("--clean-stale", help="Delete those of other versions only.")
    ] = False,
) -> None:
    """Show the machine, the versions and the kernel cache; clean it with an option."""
    from lavendersim.runner.environment import delete_kernels, kernel_limit, kernels, machine

    for name, value in machine().items():
        typer.echo(f"{name:14} {value}")
    typer.echo(f"{'in use':14} {kernels(current=True)}")
    typer.echo(f"{'stale':14} {kernels(current=False)}, of other versions or settings")
    typer.echo(f"{'limit':14} {kernel_limit() / 1e6:.0f} MB; the least recently used go first")
    for stale in [True] * (clean or clean_stale) + [False] * clean:
        kind = "stale" if stale else "in use"
        typer.echo(f"{'deleted':14} {delete_kernels(current=not stale)}, {kind}")
