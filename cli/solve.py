"""`lavender solve`: solves contact problems of files; prints a table per problem, draws figures."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any

import typer

from lavender_cli import printing

HEADER = ("solver", "status", "scaled", "local", "error", "sweeps", "time", "")
ERROR = HEADER.index("error")
MICRO, MILLI = 1e-6, 1e-3
COMPILING = 0.05  # [s] a first call that took so much longer than the others has compiled
Files = Annotated[
    list[Path],
    typer.Argument(metavar="FILE...", help="Siconos .dat or FCLIB HDF5 files, or folders of them."),
]
Names = Annotated[
    list[str],
    typer.Option(
        *("--solver", "-s"),
        metavar="NAME",
        help="Solvers, with commas between or the option repeated; `all` is every one.",
    ),
]
Tolerance = Annotated[float, typer.Option(help="Scaled residual at which a problem is solved.")]
Sweeps = Annotated[int | None, typer.Option(min=1, help="Sweeps or steps at most.")]
Plot = Annotated[
    Path | None, typer.Option("--plot", metavar="DIR", help="Draw the figures into this folder.")
]


def solve(
    files: Files,
    solver: Names = ["auto"],  # noqa: B006 - typer takes the default from here, nobody changes it
    tolerance: Tolerance = 1e-8,
    sweeps: Sweeps = None,
    plot: Plot = None,
    reference: Annotated[
        bool,
        typer.Option(
            "--reference", help="Find a reference solution by two methods; report velocity errors."
        ),
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the results as JSON.")] = False,
) -> None:
    """Solve contact problems of files. Exits 1 when one is solved by none of the solvers.

    Of a folder what can be read is solved, and the rest is named: exits 3. A bad file that is
    named itself is refused before anything is solved: exits 2.
    """
    from lavendersim.errors import UsageError
    from lavendersim.problems.comparison import compare
    from lavendersim.problems.read import read_all

    if not 0.0 < tolerance < math.inf:
        raise UsageError(f"--tolerance {tolerance:g}: expected a number above 0")
    solvers = _chosen(solver)
    # Every file is read before the first is solved, so a bad one leaves nothing half done.
    problems, unreadable = read_all(files)
    for sentence in unreadable:
        typer.echo(f"left out: {sentence}", err=True)
    comparisons = []
    for comparison in compare(
        problems, solvers, tolerance, sweeps, curves=plot is not None, referenced=reference
    ):
        comparisons.append(comparison)
        if not as_json:
            _print(comparison, tolerance)
        _report_compilation(comparison)
    figures = []
    if plot is not None:
        from lavendersim.figures import draw_comparisons
        from lavendersim.problems.comparison import ratios
        from lavendersim.runner.environment import processor

        figures = draw_comparisons(comparisons, ratios(comparisons), tolerance, processor(), plot)
    if as_json:
        printing.as_json(
            {
                "tolerance": tolerance,
                "problems": [_plain(each) for each in comparisons],
                "figures": figures,
                "unreadable": unreadable,
            }
        )
    else:
        for figure in figures:
            typer.echo(f"figure {figure}")
    if unreadable:
        total = len(unreadable) + len(problems)
        typer.echo(f"{len(unreadable)} of {total} files could not be read", err=True)
    if not all(comparison.solved for comparison in comparisons):
        raise typer.Exit(1)
    if unreadable:
        raise typer.Exit(printing.DAMAGED)


def _chosen(names: list[str]) -> list[str]:
    """Return the solvers that are meant, each once; raises UsageError with the nearest name."""
    from lavendersim.errors import UsageError
    from lavendersim.problems.solve import SOLVERS
    from lavendersim.quantities.found import nearest, quoted

    valid = ["auto", *SOLVERS]
    chosen: dict[str, None] = {}
    for name in (part.strip() for text in names for part in text.split(",")):
        if name != "all" and name not in valid:
            raise UsageError(f"no solver is called {quoted(name)}{nearest(name, [*valid, 'all'])}")
        chosen.update(dict.fromkeys(valid if name == "all" else [name]))
    return list(chosen)


def _report_compilation(comparison: Any) -> None:
    """Print to stderr which first calls took far longer than the others."""
    for attempt in comparison.attempts:
        if attempt.first_call > attempt.timing.median + COMPILING:
            first = f"first call {_time(attempt.first_call)}, compilation included"
            typer.echo(f"{comparison.name}: {attempt.solver}: {first}", err=True)


def _print(comparison: Any, tolerance: float) -> None:
    typer.echo(
        f"{typer.style(comparison.name, bold=True)}: {comparison.contacts} "
        f"contact{'' if comparison.contacts == 1 else 's'}, tolerance {tolerance:g}"
    )
    if comparison.reference:
        typer.echo(f"  reference {comparison.reference}")
    rows = [HEADER, *(_cells(attempt) for attempt in comparison.attempts)]
    if comparison.truth != "referenced":
        rows = [row[:ERROR] + row[ERROR + 1 :] for row in rows]
    last = len(rows[0]) - 1
    widths = [max(len(row[column]) for row in rows) for column in range(last + 1)]
    for row in rows:
        left = "  ".join(f"{cell:{width}}" for cell, width in zip(row[:2], widths, strict=False))
        right = "  ".join(
            f"{cell:>{width}}" for cell, width in zip(row[2:last], widths[2:last], strict=True)
        )
        typer.echo(f"  {left}  {right}  {row[last]}".rstrip())
    for attempt in comparison.attempts:
        if not attempt.solved:
            typer.echo(f"  {attempt.solver} misses: {_parts(attempt.residual)}")


def _cells(attempt: Any) -> tuple[str, ...]:
    timing = attempt.timing
    spread = f"{_time(timing.low)} to {_time(timing.high)} in {timing.repeats} calls"
    return (
        attempt.solver,
        attempt.status,
        f"{attempt.residual.scaled:.1e}",
        f"{attempt.residual.local:.1e}",
        f"{attempt.error:.1e}",
        str(attempt.sweeps),
        _time(timing.median),
        spread if timing.repeats > 1 else "1 call",
    )


def _parts(judged: Any) -> str:
    """Return the laws that are broken, without those that are far less so than the worst."""
    laws = {"Signorini": judged.signorini, "cone": judged.cone, "dissipation": judged.dissipation}
    worst = max(law.largest for law in laws.values())
    return ", ".join(
        f"{name} by {law.largest:.1e} m/s at contact {law.contact}"
        for name, law in laws.items()
        if not law.largest < MILLI * worst  # shown where it is NaN
    )


def _time(seconds: float) -> str:
    """Return a time in the unit that leaves three digits before or after the point."""
    for unit, size in (("s", 1.0), ("ms", MILLI)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / MICRO:.3g} us"


def _plain(value: Any) -> Any:
    """Return tuples with names as mappings; JSON has no number for what is infinite."""
    if hasattr(value, "_asdict"):
        plain = {name: _plain(each) for name, each in value._asdict().items()}
        return plain | ({"solved": value.solved} if "attempts" in plain else {})
    if isinstance(value, tuple):
        return [_plain(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
