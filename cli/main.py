"""`lavender`: the verbs, and the one place where errors become a sentence and an exit code."""

from __future__ import annotations

import atexit
import gc
import os
import signal
import sys
import traceback
import warnings
from collections.abc import Callable
from contextlib import ExitStack
from typing import Annotated, TextIO, cast

import typer

from lavender_cli import (
    asking,
    check,
    cost,
    diff,
    doctor,
    export,
    going_on,
    judge,
    ls,
    measures,
    merge,
    new,
    open,
    plan,
    plot,
    recover,
    replay,
    rm,
    run,
    schema,
    show,
    solve,
    verify,
)

# Numpy asks for pages of 2 MiB for what has 4 MiB or more. Blocks of rows are written once, so
# larger pages save nothing, and to find memory for them took a third of the processor time of a run
# on a virtual machine. Numpy reads this as it is loaded; who has set it keeps it.
os.environ.setdefault("NUMPY_MADVISE_HUGEPAGE", "0")
# Threads of numpy's BLAS wait for work in a loop, a tenth of a second of the processor in each
# command. Matrices here are of few rows, and what several threads add up has other bits.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# Of pydantic's plugins none is looked for: to ask each distribution takes as long as most checks.
os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")

DISK_FULL = 6
# What these do goes on when nobody reads what they print.
WORKING = ("run", "check", "cost", "merge")

app = typer.Typer(
    name="lavender",
    help="A laboratory for rigid-body contact: run experiments, plot, replay and check them.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={
        "help_option_names": ["-h", "--help"],
        "color": False if os.environ.get("NO_COLOR") else None,
    },
)
VERBS: tuple[Callable[..., None], ...] = (
    new.new,
    run.run,
    merge.merge,
    plot.plot,
    open.open_,
    replay.replay,
    check.check,
    plan.plan,
    ls.ls,
    rm.rm,
    show.show,
    judge.judge,
    verify.verify,
    export.export,
    diff.diff,
    measures.measures,
    cost.cost,
    solve.solve,
    recover.recover,
    schema.schema,
    doctor.doctor,
)
for verb in VERBS:
    app.command(verb.__name__.rstrip("_"))(verb)


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


def _leave_memory() -> None:
    """Let the process end without looking for circles: the system takes all its memory back.

    Python looks through every object for them twice, which takes a fifth of a short command.
    """
    gc.freeze()
    gc.disable()


def main() -> None:
    """Run the command line; exit 0 good, 1 a check failed, 2 usage, 3 a log, 4 internal, 5, 6, 130.

    `docs/commands.md` has the table.
    """
    from lavendersim.errors import ConfigWarning, LavenderError, SuspiciousScene

    # Configs, plans and results are many objects that live on; looking through them for circles
    # takes a tenth of a run of hundreds of cells.
    gc.set_threshold(300_000, 20, 20)
    atexit.register(_leave_memory)
    python_format = warnings.formatwarning
    warnings.formatwarning = lambda message, category, *where, **line: (
        f"{message}\n"  # it begins with the place in the config
        if issubclass(category, (ConfigWarning, SuspiciousScene))
        else python_format(message, category, *where, **line)
    )

    signals = ExitStack()
    if sys.argv[1:2] and sys.argv[1] in WORKING:
        from lavendersim.runner.interruption import handled
        from lavendersim.runner.unread_output import Unread

        signals.enter_context(handled())  # while it plans and draws, too
        sys.stdout = cast(TextIO, Unread(sys.stdout))
    elif hasattr(signal, "SIGPIPE") and not sys.stdout.isatty():
        # As other tools do: a reader that has seen enough ends the writer, without a message.
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    try:
        with signals:
            app(prog_name="lavender")  # by which a shell asks for completions
    except LavenderError as error:
        typer.echo(str(error), err=True)
        sys.exit(error.exit_code)
    except OSError as error:
        named = f"{error.filename}: " if error.filename else ""
        typer.echo(f"{named}{(error.strerror or str(error)).lower()}", err=True)
        sys.exit(DISK_FULL if error.errno in going_on.DISK else 2)
    except SystemExit as end:
        if end.code == asking.INTERRUPTED:
            typer.echo("interrupted", err=True)
        raise
    except Exception:
        traceback.print_exc()
        typer.echo("lavender: this is a defect of lavender, not of your input", err=True)
        sys.exit(4)


if __name__ == "__main__":
    main()
