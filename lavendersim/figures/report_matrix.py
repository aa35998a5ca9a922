"""Squares of a matrix in, a case by a solver each; one self-contained HTML page out.

A square says its verdict by sign and colour, by its words when pointed at, and is the link to its
log; what failed is told again below, solver by solver, where a page is printed or has no pointer.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, Final, NamedTuple

from lavendersim.figures.html_page import address, document, picture, write_whole


class Matrix(NamedTuple):
    """What the page is made of."""

    cases: Sequence[Any]  # .name `family/case`, .question, .reduced
    solvers: Sequence[str]
    squares: Sequence[Any]  # .case, .solver, .verdict, .why, .detail, .margin, .cost, .log
    left_out: Mapping[str, str]  # config -> why it is no case
    shown: Mapping[str, Any]  # case -> the cell that is pictured
    processor: str


class Look(NamedTuple):
    """How a verdict is shown."""

    sign: str
    kind: str  # of the element
    words: str


# Blue-green against vermilion, as Okabe and Ito's for colour-blind readers; signs tell them too.
LOOKS: Final = {
    "passes": Look("\u2713", "passes", "passes"),
    "known failure": Look("~", "known", "known failure: the case declares it; no pass"),
    "fails": Look("\u2717", "fails", "fails"),
    "beyond bounds": Look("\u25a0", "fails", "stopped at the first step beyond a bound"),
    "diverged": Look("\u221e", "fails", "diverged: its numbers ended"),
    "refused": Look("\u2205", "other", "refused: the case cannot be put to this solver"),
    "died": Look("\u2020", "fails", "the run broke off: a defect of lavender"),
}
NOT_RUN: Final = Look("\u2013", "other", "not run")
ALWAYS_TOLD: Final = ("passes", "known failure", "fails", "beyond bounds")
SMALLER: Final = 0.6  # of a picture's size: rows low enough to see a family at once
STYLE: Final = """
body { max-width: 90em; }
thead th { position: sticky; top: 0; background: #fff; vertical-align: bottom; color: #222; }
th.solver, td.square { text-align: center; padding: 0.4em 0.2em; width: 6em; font-size: 0.93em; }
th.solver b { font-size: 1.15em; }
th.family { padding-top: 1.2em; font-weight: bold; color: #222; }
td.name img { float: left; margin-right: 1em; }
td.name > span.small { display: block; } /* why there is no picture */
td.square { vertical-align: middle; border-left: 2px solid #fff; white-space: nowrap; }
td.square a { display: block; color: inherit; text-decoration: none; }
td.square a:hover, td.square a:focus { outline: 2px solid #222; }
.sign { font-size: 1.25em; font-weight: bold; }
.passes { background: #d5f0e7; color: #00523b; }
.known { background: #fbf0c0; color: #5c4a00; }
.fails { background: #f9d9c8; color: #8a3300; }
.other { background: #eee; color: #555; }
summary { margin-top: 0.6em; }
.key span.sign { padding: 0 0.4em; margin-left: 0.8em; }
@media (max-width: 60em) { td.name img, .question { display: none; } }
"""


def write_matrix(matrix: Matrix, path: Path) -> None:
    """Write the page, whole or not."""
    write_whole(page(matrix, path.parent), path)


def page(matrix: Matrix, folder: Path) -> str:
    """Return the page; links are relative to `folder`."""
    most, count = len(matrix.cases), len(matrix.solvers)
    title = f"{most} case{'s' * (most != 1)} by {count} solver{'s' * (count != 1)}"
    told = [look for name, look in LOOKS.items() if name in ALWAYS_TOLD or name in _said(matrix)]
    if len(matrix.squares) < most * count:
        told.append(NOT_RUN)
    key = "".join(
        f'<span class="sign {look.kind}">{look.sign}</span> {escape(look.words)}' for look in told
    )
    reduced = " Slow cases are run at a reduced length." * any(one.reduced for one in matrix.cases)
    body = f"""<h1>{title}</h1>
<p>Every case with the numerics it states, but for the solver.{reduced} Below each sign: physics
per simulated second, no logging, one core of {escape(matrix.processor)}. Squares lead to their logs
and tell more when pointed at.</p>
<p class="key">{key}</p>
<table class="matrix">
<thead><tr><th>case</th>{"".join(_heads(matrix))}</tr></thead>
{"".join(_families(matrix, folder))}
</table>
<h2>What failed</h2>
{"".join(_failures(matrix, folder)) or "<p>Nothing.</p>"}
{_left_out(matrix.left_out)}"""
    return document(f"lavender: {title}", body, STYLE)


def _said(matrix: Matrix) -> set[str]:
    return {square.verdict for square in matrix.squares}


def _heads(matrix: Matrix) -> Iterator[str]:
    for solver in matrix.solvers:
        met = sum(one.solver == solver and one.verdict == "passes" for one in matrix.squares)
        name = escape(solver).replace("_", "_<wbr>")
        yield (
            f'<th class="solver" data-solver="{escape(solver, quote=True)}">{name}<br>'
            f"<b>{met}</b> of {len(matrix.cases)}</th>"
        )


def _families(matrix: Matrix, folder: Path) -> Iterator[str]:
    places = {(square.case, square.solver): square for square in matrix.squares}
    families: dict[str, list[Any]] = {}
    for case in matrix.cases:
        families.setdefault(case.name.rpartition("/")[0], []).append(case)
    for family, cases in families.items():
        wide = 1 + len(matrix.solvers)
        yield f'<tbody><tr><th class="family" colspan="{wide}">{escape(family)}</th></tr>\n'
        for case in cases:
            squares = "".join(
                _square(places.get((case.name, solver)), folder) for solver in matrix.solvers
            )
            cell = matrix.shown.get(case.name)
            image = picture(cell, SMALLER) if cell is not None else ""
            yield (
                f'<tr class="case" data-case="{escape(case.name, quote=True)}">'
                f'<td class="name">{image}{_name(case)}</td>{squares}</tr>\n'
            )
        yield "</tbody>\n"


def _name(case: Any) -> str:
    reduced = " (reduced)" if case.reduced else ""
    question = f'<div class="small question">{escape(case.question)}</div>' if case.question else ""
    return f"<b>{escape(case.name.rpartition('/')[2])}</b>{reduced}{question}"


def _square(square: Any, folder: Path) -> str:
    if square is None:
        return f'<td class="square {NOT_RUN.kind}" title="{NOT_RUN.words}">{NOT_RUN.sign}</td>'
    look = LOOKS[square.verdict]
    said = look.words if square.verdict == "passes" else f"{square.verdict}: {square.why}"
    if not math.isnan(square.margin):
        said += f"\nleast margin {square.margin:.3g} of a bound"
    inside = f'<span class="sign">{look.sign}</span><br>{_time(square.cost)}'
    if square.log is not None:
        inside = f'<a href="{address(square.log, folder)}">{inside}</a>'
    return f'<td class="square {look.kind}" title="{escape(said, quote=True)}">{inside}</td>'


def _failures(matrix: Matrix, folder: Path) -> Iterator[str]:
    for solver in matrix.solvers:
        bad = [one for one in matrix.squares if one.solver == solver and one.verdict != "passes"]
        if not bad:
            continue
        rows = "".join(
            f"<tr><td>{escape(one.case)}</td>"
            f'<td><span class="sign {LOOKS[one.verdict].kind}">{LOOKS[one.verdict].sign}</span>'
            f" {one.verdict}</td><td><pre>{escape(one.detail or one.why)}</pre></td></tr>"
            for one in bad
        )
        said = "; ".join(
            f"{verdict}: {', '.join(escape(one.case) for one in bad if one.verdict == verdict)}"
            for verdict in LOOKS
            if any(one.verdict == verdict for one in bad)
        )
        yield (
            f"<details><summary><b>{escape(solver)}</b> {said}</summary>"
            f"<table><tbody>{rows}</tbody></table></details>\n"
        )


def _left_out(left_out: Mapping[str, str]) -> str:
    if not left_out:
        return ""
    lines = "".join(
        f"<p><b>{escape(why)}</b>: "
        f"{', '.join(escape(name) for name, said in left_out.items() if said == why)}</p>"
        for why in dict.fromkeys(left_out.values())
    )
    return f"<h2>Not in the matrix</h2>\n{lines}"


def _time(seconds: float) -> str:
    """Return a time in the unit that leaves digits before the point."""
    if math.isnan(seconds):
        return ""
    for unit, size in (("s", 1.0), ("ms", 1e-3)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e6:.3g} \u00b5s"
