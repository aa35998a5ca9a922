"""`lavender measures`: lists the kinds of measures that a config may name."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lavender_cli import printing
from lavender_cli.completion import measure_kinds


def measures(
    kind: Annotated[
        str | None,
        typer.Argument(
            metavar="[KIND]", help="Print the parameters of one kind.", autocompletion=measure_kinds
        ),
    ] = None,
    own: Annotated[
        Path | None,
        typer.Option("--measures", metavar="FILE", help="Those of a measures.py, too; it is run."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print all as JSON.")] = False,
) -> None:
    """List all measures, those of other packages included: kind, unit, meaning."""
    from lavendersim.errors import UsageError
    from lavendersim.measures.meanings import described_kinds
    from lavendersim.quantities.found import nearest, quoted

    found = described_kinds(own)
    if kind is not None and kind not in found:
        raise UsageError(f"no measure is called {quoted(kind)}{nearest(kind, list(found))}")
    chosen = found if kind is None else {kind: found[kind]}
    if as_json:
        printing.as_json({name: one._asdict() for name, one in chosen.items()})
        return
    widths = [max(map(len, chosen)), max(len(one.unit) for one in chosen.values())]
    for name, one in chosen.items():
        of = f"  (of {one.package})" if one.package else ""
        typer.echo(f"{name:{widths[0]}}  {one.unit:{widths[1]}}  {one.meaning}{of}")
        for key, meaning in one.parameters.items() if kind is not None else ():
            typer.echo(f"  {key}: {meaning}".rstrip(": "))
