"""`lavender`: the verbs, and the one place where errors become a sentence and an exit code."""

from __future__ import annotations

import os
import sys
import traceback
from typing import Annotated

import typer
from lavender_cli import check, doctor, ls, plan, plot, recover, replay, run, schema, show

app = typer.Typer(
    name="lavender",
    help="A laboratory for rigid-body contact: run experiments, plot, replay and check them.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={
        "help_option_names": ["-h", "--help"],
        "color": False if os.environ.get("NO_COLOR") else None,
    },
)
for verb in (run.run, plot.plot, replay.replay, check.check, plan.plan, ls.ls, show.show):
    app.command()(verb)
for verb in (recover.recover, schema.schema, doctor.doctor):
    app.command()(verb)


def _version(asked: bool) -> None:
    if asked:
        from lavendersim import __version__

        typer.echo(f"lavender {__version__}")
        raise typer.Exit


@app.callback()
def lavender(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print and exit.")
    ] = False,
) -> None:
    """Run and judge experiments in rigid-body contact."""


def main() -> None:
    """Run the command line; exit 0 good, 1 a check failed, 2 usage, 3 salvaged, 4 internal, 130."""
    from lavendersim.errors import LavenderError

    try:
        app()
    except LavenderError as error:
        typer.echo(str(error), err=True)
        sys.exit(error.exit_code)
    except KeyboardInterrupt:
        typer.echo("interrupted", err=True)
        sys.exit(130)
    except BrokenPipeError:
        sys.exit(0)
    except Exception:
        traceback.print_exc()
        typer.echo("lavender: this is a defect of lavender, not of your input", err=True)
        sys.exit(4)


if __name__ == "__main__":
    main()
