"""What became of the claims of a run, in lines: one for each expectation, its cells together.

A line has the counts, the range of what was measured, and the cell that leaves the least of its
bound or misses it the most. Checks of `always` that are all met are one line. Failures follow in
full, the first few; `-v` prints each claim in each cell, and all failures.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Annotated, Any, Final, NamedTuple

import typer

from lavender_cli.printing import digits, digits_between, mark

FULL_FAILURES: Final = 3  # of a summary; a failure is six lines
ENDED_SHOWN: Final = 10
NO_TOLERANCES: Final = ("", "0", "none")
FLOAT: Final = re.compile(r"\d+\.\d+(?:e[-+]?\d+)?")
WHOLE: Final = "a complete run"  # what a claim expects of a cell that ended early
Verbose = Annotated[
    bool, typer.Option("--verbose", "-v", help="Each claim in each cell, and every failure.")
]


class Judged(NamedTuple):
    """A verdict as it is printed."""

    name: str
    node: str
    passed: bool
    measured: float
    expected: str
    margin: float  # share of the bound that is left; NaN where there is no such
    judged: bool = True
    tolerance: str = ""

    @property
    def asked(self) -> str:
        """What is expected, with the digits that a person can use and the tolerance."""
        return _asked(self.expected, self.tolerance)

    @property
    def fails(self) -> bool:
        """Whether it was judged and not met."""
        return self.judged and not self.passed

    @property
    def place(self) -> str:
        """The cell, as its node has it; empty where the claim is on no cell alone."""
        return self.node.removeprefix(self.name).removeprefix(" at ")


class ClaimLine(NamedTuple):
    """What became of one expectation in all its cells, or of all checks of `always`."""

    passed: bool | None  # None: the engine does not report enough to judge it in any cell
    text: str


@lru_cache(maxsize=256)  # of most sweeps all cells are asked the same
def _asked(expected: str, tolerance: str) -> str:
    text = FLOAT.sub(lambda found: digits(float(found[0])), expected)
    return f"{text}, within {tolerance}" if tolerance not in NO_TOLERANCES else text


def summarise(verdicts: Sequence[Any]) -> list[ClaimLine]:
    """Return a line for each expectation, its cells counted together."""
    from lavendersim.measures.always import PREFIX

    groups: dict[str, list[Any]] = {}
    every = of_memory(verdicts)
    for verdict in every:
        if not verdict.judged:
            continue
        groups.setdefault(verdict.name, []).append(verdict)
    checks = [name for name in groups if name.startswith(PREFIX)]
    met = [name for name in checks if all(one.passed for one in groups[name])]
    together = [] if len(met) < 2 else met
    lines = [
        ClaimLine(all(one.passed for one in group), _line(name, group))
        for name, group in groups.items()
        if name not in together
    ]
    if together:
        grouped = [groups[name] for name in together]
        text = _together(PREFIX, grouped, len(together) == len(checks))
        lines.append(ClaimLine(True, text))
    left = [one for one in every if not one.judged]
    for name in dict.fromkeys(one.name for one in left):
        own = [one for one in left if one.name == name]
        cells = f" in {len(own)} cells" if len(own) > 1 else ""
        lines.append(ClaimLine(None, f"{name}: not judged{cells}, the engine does not report it"))
    return lines


def of_memory(verdicts: Iterable[Any]) -> list[Judged]:
    """Return verdicts as they are printed."""
    return [Judged(*(getattr(one, key) for key in Judged._fields)) for one in verdicts]


def _line(name: str, group: list[Judged]) -> str:
    if len(group) == 1:
        return f"{name}: {digits(group[0].measured)}, expected {group[0].asked}"
    known = [one.measured for one in group if not math.isnan(one.measured)]
    shown = digits_between(known) if known else digits(math.nan)
    met = sum(one.passed for one in group)
    text = f"{name}: {shown}, expected {_expected(group)} in {met} of {len(group)} cells"
    worst = _nearest(group)
    if worst is None or not worst.place:
        return text
    return f"{text}; {_how(worst)} at {worst.place}, {digits(worst.measured)}"


def _together(name: str, checks: list[list[Judged]], are_all: bool) -> str:
    """Return the line of checks that are all met. are_all: that there are no others."""
    which = "checks" if are_all else "other checks"
    count = len({one.place for group in checks for one in group})
    cells = f" in {count} cells" if count > 1 else ""
    text = f"{name}{len(checks)} {which} of every step met{cells}"
    worst = _nearest([one for group in checks for one in group])
    if worst is None:
        return text
    short = worst.name.removeprefix(name)
    place = f" at {worst.place}" if worst.place else ""
    return f"{text}; {_how(worst)}: {short} {digits(worst.measured)} of {worst.asked}{place}"


def _nearest(group: list[Judged]) -> Judged | None:
    """Return the claim that leaves the least of its bound; None where none has a margin."""
    known = (one for one in group if not math.isnan(one.margin))
    return min(known, key=lambda one: one.margin, default=None)


def _how(worst: Judged) -> str:
    return "worst" if worst.margin < 0.0 else "nearest its bound"


def _expected(group: list[Judged]) -> str:
    """Return what was expected; of a closed form whose value differs by cell, its name."""
    whole = [one for one in group if one.expected != WHOLE]  # not of cells that ended early
    texts = {one.asked for one in whole}
    if len(texts) < 2:
        return texts.pop() if texts else WHOLE
    named = re.search(r"^\S+ \((.+)\)", whole[0].asked)
    return f"the cell's {named.group(1)}" if named else "a number of each cell"


def print_claims(verdicts: Sequence[Any], verbose: bool = False) -> None:
    """Print a line for each expectation; verbose: for each claim in each cell."""
    if not verbose:
        for passed, text in summarise(verdicts):
            typer.echo(f"  {mark(passed)}  {text}")
        return
    for verdict, one in zip(verdicts, of_memory(verdicts), strict=True):
        shown = f"{one.node}: {digits(one.measured)}, expected {one.asked}"
        if not one.judged:
            shown = verdict.message
        typer.echo(f"  {mark(one.passed if one.judged else None)}  {shown}")


def print_failures(
    ended_early: Sequence[Any], verdicts: Sequence[Any], verbose: bool = False
) -> None:
    """Print cells that ended early and the failed verdicts, the first few unless verbose.

    ended_early: cells, with label and status.
    """
    ended = ended_early if verbose else ended_early[:ENDED_SHOWN]
    for cell in ended:
        typer.echo(f"  {mark(False)}  {cell.label or 'the cell'}: {cell.status}")
    if len(ended_early) > len(ended):
        more = len(ended_early) - len(ended)
        typer.echo(f"  and {more} more cells ended early, -v lists each")
    failed = [one for one in verdicts if one.fails]
    shown = failed if verbose else failed[:FULL_FAILURES]
    for one in shown:
        typer.echo("\n".join(f"  {line}" for line in one.message.splitlines()))
    if len(failed) > len(shown):
        typer.echo(f"  and {len(failed) - len(shown)} more failed, -v prints each")
