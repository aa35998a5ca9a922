"""Questions on a terminal; Ctrl-C and the end of the input end the command as a signal does."""

from __future__ import annotations

import typer

INTERRUPTED = 130  # typer ends with it after Ctrl-C, but for a question


def confirmed(question: str, err: bool = False) -> bool:
    """Ask a question; whether the answer is yes. Without an answer the command ends with 130."""
    try:
        return typer.confirm(question, err=err)
    except typer.Abort:
        typer.echo(err=True)  # behind the question
        raise typer.Exit(INTERRUPTED) from None


def answered(question: str) -> str:
    """Ask for a word. Without an answer the command ends with 130."""
    try:
        return str(typer.prompt(question))
    except typer.Abort:
        typer.echo(err=True)
        raise typer.Exit(INTERRUPTED) from None
