"""What a shell completes behind a word: runs, kinds of measures, starting configs.

`lavender --install-completion` teaches the shell to ask; files and options it completes by itself.
A completion that fails completes nothing: an error has no place in a line that is being typed.
"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import typer


def run_names(ctx: typer.Context, incomplete: str) -> list[str]:
    """Return the runs of the folder that `--runs` names, newest first; by path where one begins."""
    with suppress(Exception):
        from lavendersim.runner import RUNS, list_runs

        given = ctx.params.get("root") or ctx.params.get("runs")  # of some verbs `runs` are many
        root = given if isinstance(given, Path) else RUNS
        runs = [run.path for run in reversed(list_runs(root))]
        by_name = [path.name for path in runs if path.name.startswith(incomplete)]
        return by_name or [str(path) for path in runs if str(path).startswith(incomplete)]
    return []


def start_names(incomplete: str) -> list[str]:
    """Return the names of starting configs."""
    with suppress(Exception):
        from lavendersim.runner.starting_configs import starts

        return [start.name for start in starts() if start.name.startswith(incomplete)]
    return []


def measure_kinds(incomplete: str) -> list[str]:
    """Return the kinds of measures."""
    with suppress(Exception):
        from lavendersim.measures.meanings import described_kinds

        return [kind for kind in described_kinds() if kind.startswith(incomplete)]
    return []
