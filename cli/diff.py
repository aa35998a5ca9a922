"""`lavender diff`: prints what differs between two runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lavender_cli import printing
from lavender_cli.run import AllowIncomplete, Runs

if TYPE_CHECKING:
    from lavendersim.comparison import Comparison
    from lavendersim.comparison.compare import CellStates, MeasureChange

SHOWN = 20  # of a long list; --json has all
BODIES_SHOWN = 3
DIFFERENT = 1


def diff(
    a: Annotated[Path, typer.Argument(metavar="A", help="Run directory.")],
    b: Annotated[Path, typer.Argument(metavar="B", help="Another.")],
    runs: Runs = Path("runs"),
    as_json: Annotated[bool, typer.Option("--json", help="Print everything as JSON.")] = False,
    allow_incomplete: AllowIncomplete = False,
) -> None:
    """Compare two runs: config, versions, measures, verdicts, cost, and states to the bit.

    Exits 0 when they are equal, the machine and times apart, 1 when not, 3 when a log is damaged.
    """
    from lavendersim.comparison import compare
    from lavendersim.runner import open_run

    opened = [open_run(path, runs, allow_incomplete) for path in (a, b)]
    damaged = [sentence for run in opened for sentence in run.damaged()]
    printing.report_damage(damaged, "nothing is compared" if not allow_incomplete else "")
    found = compare(*opened)
    if as_json:
        printing.as_json(found.table())
    else:
        _print(found)
    if damaged:
        raise typer.Exit(printing.DAMAGED)
    if not found.equal:
        raise typer.Exit(DIFFERENT)


def _print(found: Comparison) -> None:
    typer.echo(f"A  {found.a.path}\nB  {found.b.path}")
    _lines([f"compared as it is written: {one}" for one in found.not_understood])
    if found.equal:
        typer.echo("equal but for the machine and times")
    _section("config", [_change(one.path, one.a, one.b) for one in found.config])
    resolved = [
        _change(one.path, one.a, one.b) + (f"  in {n} cells" if n > 1 else "")
        for one, n in found.resolved
    ]
    _section("resolved in equal cells", resolved)
    _section("versions", [_change(one.path, one.a, one.b) for one in found.versions])
    _section("machine", [_change(one.path, one.a, one.b) for one in found.machine])
    by = f" by {', '.join(found.pairing.axes)}" if found.pairing.axes else ""
    pairs = len(found.pairing.pairs)
    typer.echo(_bold(f"cells  {pairs} pair{'s' * (pairs != 1)}{by}"))
    for side, labels in (("A", found.pairing.only_a), ("B", found.pairing.only_b)):
        _lines([f"only in {side}: {label}" for label in labels])
    _section("measures", [_measure(one) for one in found.measures])
    _section("verdicts", [f"{one.node}  {one.a} -> {one.b}" for one in found.verdicts])
    typer.echo(_bold("cost"))
    for name, (left, right) in found.costs.items():
        ratio = f"  ({right / left:.2f} times)" if left else ""
        kind = name.removesuffix("_us_per_step")
        typer.echo(f"  {kind:8}  {left:.2f} -> {right:.2f} us/step{ratio}")
    typer.echo(_bold("states"))
    _lines([_states(one) for one in found.states])


def _section(title: str, lines: Sequence[str]) -> None:
    if lines:
        typer.echo(_bold(title))
        _lines(lines)


def _lines(lines: Sequence[str]) -> None:
    for line in lines[:SHOWN]:
        typer.echo(f"  {line}")
    if len(lines) > SHOWN:
        typer.echo(f"  and {len(lines) - SHOWN} more; --json has all")


def _bold(text: str) -> str:
    return str(typer.style(text, bold=True))


def _change(name: str, a: Any, b: Any) -> str:
    return f"{name}  {_as_written(a)} -> {_as_written(b)}"


def _as_written(value: Any) -> str:
    """Return a value as a config has it: `{path: scene.bodies.ball.mass, values: [1, 2]}`."""
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{key}: {_as_written(one)}' for key, one in value.items())}}}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_as_written, value))}]"
    return str(value)


def _measure(one: MeasureChange) -> str:
    where = f" at {one.cell}" if one.cell else ""
    numbers = all(isinstance(end, int | float) for end in (one.a, one.b))
    if not numbers:
        return _change(f"{one.name}{where}", one.a, one.b)
    change = one.b - one.a
    share = f", {100 * change / abs(one.a):+.3g} %" if one.a else ""
    ends = f"{printing.digits(one.a)} -> {printing.digits(one.b)}"
    return f"{one.name}{where}  {ends}  ({change:+.3g}{share})"


def _states(one: CellStates) -> str:
    found = one.parting
    name = one.cell or "the cell"
    before, after = one.statuses
    ended = "" if before == after else f"; {before} -> {after}"
    other = [
        f"; only in {side}: {', '.join(bodies)}"
        for side, bodies in (("A", found.only_a), ("B", found.only_b))
        if bodies
    ]
    rest = ended + "".join(other)
    if found.differs == "nothing":
        return f"{name}: equal to the bit, {found.steps} states{rest}"
    if found.differs == "length":
        return f"{name}: equal to the bit in the {found.steps} states of equal times{rest}"
    text = f"{name}: part at step {found.step}, {found.time:.6g} s"
    if found.differs == "velocities":
        later = f"; poses from {found.posed:.6g} s" if found.posed is not None else ""
        text += f", in velocities{later}"
    shown = [f"{one.body} by {_far(one)}" for one in found.bodies[:BODIES_SHOWN]]
    more = len(found.bodies) - len(shown)
    text += f": {', '.join(shown)}" if shown else ""
    text += f" and {more} more bodies" if more else ""
    far = found.farthest
    return text + (f"; at most {far.body} by {_far(far)}" if far else "") + rest


def _far(one: Any) -> str:
    turned = f" and {one.radians:.2g} rad" if one.radians else ""
    return f"{one.metres:.2g} m{turned}"
