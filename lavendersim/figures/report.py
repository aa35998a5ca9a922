"""Finished runs in; one self-contained HTML page out: a row per case, its cells folded below."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any, Final

from lavendersim.figures.html_page import address, document, picture, write_whole

LEGEND: Final = (
    "Margin: the least share of a bound that is left over all claims that have one; below 0 it is "
    "broken. Residual: the worst of any step. Cost: physics alone, one processor, no logging."
)
HEADS: Final = ("case", "verdict", "margin", "residual [m/s]", "cost [us/step]", "log")
CELL_HEADS: Final = ("cell", "verdict", "margin", "of the claim", *HEADS[3:])
CLAIM_HEADS: Final = ("verdict", "claim", "measured", "expected", "margin")
NUMBERS: Final = frozenset({"margin", "measured", *HEADS[3:5]})
# A row of numbers that no text below it can widen; on a narrow screen every number has its own
# line, told by its head.
STYLE: Final = """
.cases > tbody > tr.case > td:not(.picture) { border-bottom: none; padding-bottom: 0; }
.cases > tbody > tr.more > td { padding-top: 0; }
.cases > tbody > tr.case { height: 1px; } /* what a picture is taller goes below */
td.verdict { white-space: nowrap; }
td.number .small { display: inline-block; white-space: normal; max-width: 16em; }
pre { white-space: pre-wrap; overflow-wrap: anywhere; }
details { overflow-x: auto; }
@media (max-width: 55em) {
  .cases > thead { display: none; }
  .cases, .cases > tbody, .cases > tbody > tr, .cases > tbody > tr > td { display: block; }
  .cases > tbody > tr > td { width: auto; border: none; padding: 0 0 0.2em; }
  .cases > tbody > tr > td.number { text-align: left; }
  .cases > tbody > tr > td.number::before { content: attr(data-head) ": "; color: #666; }
  .cases > tbody > tr.more { border-bottom: 1px solid #ddd; margin-bottom: 1em; }
}
"""


def write_report(results: Sequence[Any], path: Path) -> None:
    """Write the page of finished runs (`.run`, `.outcomes`, `.verdicts`, `.good`), whole or not."""
    write_whole(report(results, path.parent), path)


def report(results: Sequence[Any], folder: Path) -> str:
    """Return the page; links are relative to `folder`."""
    good = sum(result.good for result in results)
    cells = sum(len(result.outcomes) for result in results)
    claims = [verdict for result in results for verdict in result.verdicts]
    met = sum(verdict.passed for verdict in claims)
    mark = _mark(good == len(results), f"{good} of {len(results)} cases pass")
    rows = "\n".join(_case(result, folder) for result in results)
    body = f"""<h1>{mark}</h1>
<p>{met} of {len(claims)} claims met in {cells} cells. <span class="small">{LEGEND}</span></p>
<table class="cases">
<thead><tr><th></th>{_heads(HEADS)}</tr></thead>
<tbody>
{rows}
</tbody>
</table>"""
    return document(f"lavender: {good} of {len(results)} cases pass", body, STYLE)


def _case(result: Any, folder: Path) -> str:
    run, verdicts = result.run, result.verdicts
    shown = _shown(result)
    met = sum(verdict.passed for verdict in verdicts)
    margin, whose = _margin(verdicts)
    reduced = " (reduced)" if run.experiment.reduced else ""
    costs = [_cost(outcome) for outcome in result.outcomes]
    residual = max(outcome.accuracy.worst_residual for outcome in result.outcomes)
    name = f"<b>{escape(run.name)}</b>{reduced}"
    question = f"<br>{escape(run.experiment.question)}" if run.experiment.question else ""
    ended = "".join(
        f"<pre>{escape(cell.label or 'the cell')}: {escape(cell.status)}</pre>"
        for cell in result.ended_early
    )
    failed = ended + "".join(
        f"<pre>{escape(verdict.message)}</pre>" for verdict in verdicts if not verdict.passed
    )
    below = f'<br><span class="small">{escape(whose)}</span>' if whose else ""
    said = "".join(f"<br>{escape(one)} fails, as declared" for one in _declared(run.experiment))
    return (
        f'<tr class="case" data-case="{escape(run.name, quote=True)}">'
        f'<td class="picture" rowspan="2">{picture(shown)}</td><td>{name}{question}</td>'
        f'<td class="verdict">{_mark(result.good)}<br>'
        f'<span class="small">{met} of {len(verdicts)} claims{said}</span></td>'
        f"{_cell('margin', _number(margin) + below)}{_cell(HEADS[3], f'{residual:.2g}')}"
        f"{_cell(HEADS[4], _range(costs))}<td>{_link(shown, folder)}</td></tr>\n"
        f'<tr class="more"><td colspan="{len(HEADS)}">{_details(result, folder)}{failed}</td></tr>'
    )


def _declared(experiment: Any) -> list[str]:
    """Return the checks that the config says will fail: known failures and negative controls."""
    return list(dict.fromkeys(control.fails for control in experiment.controls))


def _details(result: Any, folder: Path) -> str:
    """Return the cells, folded: each with its verdicts, and a line per claim."""
    rows = []
    for cell, outcome in zip(result.run.cells, result.outcomes, strict=True):
        own = [verdict for verdict in result.verdicts if verdict.path == str(cell.path)]
        good = cell.index not in {one.index for one in result.ended_early}
        margin, whose = _margin(own)
        rows.append(
            f'<tr class="cell"><td>{escape(cell.label or "the only cell")}</td>'
            f"<td>{_mark(good and all(verdict.passed for verdict in own))}</td>"
            f'<td class="number">{_number(margin)}</td><td>{escape(whose)}</td>'
            f'<td class="number">{outcome.accuracy.worst_residual:.2g}</td>'
            f'<td class="number">{_number(_cost(outcome))}</td><td>{_link(cell, folder)}</td></tr>'
        )
    claims = [
        f"<tr><td>{_mark(verdict.passed)}</td><td>{escape(verdict.node)}</td>"
        f'<td class="number">{_number(verdict.measured)}</td><td>{escape(verdict.expected)}</td>'
        f'<td class="number">{_number(verdict.margin)}</td></tr>'
        for verdict in result.verdicts
    ]
    tables = "".join(
        f"<table><thead><tr>{_heads(heads)}</tr></thead><tbody>{''.join(lines)}</tbody></table>"
        for heads, lines in ((CELL_HEADS, rows), (CLAIM_HEADS, claims))
    )
    count = (
        f"{len(rows)} cell{'s' * (len(rows) != 1)}, {len(claims)} claim{'s' * (len(claims) != 1)}"
    )
    return f"<details><summary>{count}</summary>{tables}</details>"


def _heads(names: Sequence[str]) -> str:
    return "".join(f"<th{' class=number' if name in NUMBERS else ''}>{name}</th>" for name in names)


def _cell(head: str, number: str) -> str:
    return f'<td class="number" data-head="{head}">{number}</td>'


def _shown(result: Any) -> Any:
    """Return the cell that stands for the case: the first that failed something, or the first."""
    failed = {verdict.path for verdict in result.verdicts if not verdict.passed}
    failed |= {str(cell.path) for cell in result.ended_early}
    return next((c for c in result.run.cells if str(c.path) in failed), result.run.cells[0])


def _link(cell: Any, folder: Path) -> str:
    return f'<a href="{address(cell.path, folder)}">log</a>'


def _margin(verdicts: Sequence[Any]) -> tuple[float, str]:
    """Return the least margin and the claim that has it; of a failure without one, no number."""
    failed = [verdict for verdict in verdicts if not verdict.passed]
    known = [one for one in failed or verdicts if not math.isnan(one.margin)]
    if not known:
        return math.nan, failed[0].node if failed else ""
    least = min(known, key=lambda verdict: verdict.margin)
    return least.margin, least.node


def _cost(outcome: Any) -> float:
    return float(outcome.physics_ns / max(outcome.steps, 1) / 1000)


def _range(numbers: Sequence[float]) -> str:
    low, high = _number(min(numbers)), _number(max(numbers))
    return low if low == high else f"{low} to {high}"


def _number(value: float) -> str:
    if math.isnan(value):
        return "-"
    return f"{value:.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.3g}"


def _mark(good: bool, words: str = "") -> str:
    return (
        f'<span class="{"pass" if good else "fail"}">{words or ("pass" if good else "FAIL")}</span>'
    )
