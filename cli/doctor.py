"""`lavender doctor`: nothing in; versions, machine and kernel cache out."""

from __future__ import annotations

from typing import Annotated

import typer


def doctor(
    clean: Annotated[bool, typer.Option("--clean", help="Delete the compiled kernels.")] = False,
) -> None:
    """Show the machine, the versions and the kernel cache; clean it where asked."""
    from lavendersim.runner.environment import delete_kernels, kernel_files, machine

    for name, value in machine().items():
        typer.echo(f"{name:14} {value}")
    files = kernel_files()
    size = sum(file.stat().st_size for file in files)
    typer.echo(f"{'kernels':14} {len(files)} files, {size / 1e6:.1f} MB")
    if clean:
        typer.echo(f"{'deleted':14} {delete_kernels()} files")
