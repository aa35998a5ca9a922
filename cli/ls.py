"""`lavender ls`: lists the runs of a folder, a line each."""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

from lavender_cli import printing
from lavender_cli.run import Runs

if TYPE_CHECKING:
    from lavendersim.runner.listing import Listed, RunFilter

COLOUR: Final = re.compile(r"\x1b\[[0-9;]*m")  # takes no column
Name = Annotated[
    list[str] | None,
    typer.Option("--name", metavar="NAME", help="Of these experiments; * and ? as in a shell."),
]
VerdictOption = Annotated[
    str | None,
    typer.Option("--verdict", metavar="WORD", help="pass, fail, unclaimed, unfinished or damaged."),
]
Tag = Annotated[str | None, typer.Option("--tag", metavar="TAG", help="That have this tag.")]
Older = Annotated[
    str | None,
    typer.Option("--older", metavar="TIME", help="Begun before: 12h, 30d, 2w ago, or a date."),
]
Newer = Annotated[
    str | None, typer.Option("--newer", metavar="TIME", help="Begun since: the same.")
]


def ls(
    runs: Runs = Path("runs"),
    name: Name = None,
    verdict: VerdictOption = None,
    tag: Tag = None,
    older: Older = None,
    newer: Newer = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the runs as JSON.")] = False,
) -> None:
    """List runs and what they ask, oldest first.

    Exits 3 when a finished one has a damaged table or a cut log.
    """
    from lavendersim.runner.listing import listed

    wanted = wanted_of(name, verdict, tag, older, newer)
    found = list(listed(runs, wanted))
    if as_json:
        printing.as_json([one.as_row() for one in found])
    else:
        if not found:
            such = "such " if any(wanted) else ""
            typer.echo(f"{runs} holds no {such}run", err=True)
        width = shutil.get_terminal_size().columns if sys.stdout.isatty() else None
        for one in found:
            typer.echo(with_question(line_of(one), one.question, width))
    damaged = [sentence for one in found for sentence in one.damaged]
    printing.report_damage(damaged)
    if damaged:
        raise typer.Exit(printing.DAMAGED)


def line_of(one: Listed) -> str:
    """Return the line of a run: how it ended, when it began, its cells, its size, where it is."""
    if one.damaged:
        word = "BAD " if one.passed is None else "CUT "
        state = typer.style(word, fg=typer.colors.RED, bold=True)
    elif one.passed and not one.claims:
        state = "none"  # nothing was claimed, so nothing passed
    else:
        state = "----" if one.passed is None else printing.mark(one.passed)
    cells = f"{one.cells} cell{' ' if one.cells == 1 else 's'}"
    tags = f"  [{' '.join(one.tags)}]" if one.tags else ""
    size = printing.byte_size(one.size)
    return f"{state}  {one.run.path}  {one.date:%Y-%m-%d %H:%M}  {cells:>10}  {size:>8}{tags}"


def with_question(line: str, question: str, width: int | None) -> str:
    """Return a line with its question, in a second one where a terminal is too narrow for both.

    width: columns of the terminal; None: it is read by a program, and has the whole question.
    """
    words = " ".join(question.split())
    if not words:
        return line
    if width is None or len(COLOUR.sub("", line)) + 2 + len(words) <= width:
        return f"{line}  {words}"
    room = max(width - 6, 1)
    return f"{line}\n      {words if len(words) <= room else words[: room - 1] + '…'}"


def wanted_of(
    name: list[str] | None,
    verdict: str | None,
    tag: str | None,
    older: str | None,
    newer: str | None,
    larger: str | None = None,
) -> RunFilter:
    """Return which runs the options mean. UsageError where one cannot be read."""
    from lavendersim.errors import UsageError
    from lavendersim.runner.listing import VERDICTS, RunFilter, size_from, time_before

    if verdict is not None and verdict not in VERDICTS:
        expected = " or ".join((", ".join(VERDICTS[:-1]), VERDICTS[-1]))
        raise UsageError(f"--verdict {verdict}: expected {expected}")
    return RunFilter(
        tuple(name or ()),
        verdict,
        tag,
        before=time_before("--older", older) if older is not None else None,
        since=time_before("--newer", newer) if newer is not None else None,
        larger=size_from("--larger", larger) if larger is not None else None,
    )
