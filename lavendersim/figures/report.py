"""Finished runs in; one self-contained HTML page out: a row per case, its cells folded below."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any

from lavendersim.figures.html_page import address, document, picture, write_whole

LEGEND = (
    "Margin: the least share of a bound that is left over all claims that have one; below 0 it is "
    "broken. Residual: the worst of any step. Cost: physics alone, one processor, no logging."
)


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
    heads = "".join(
        f"<th{' class=number' if number else ''}>{name}</th>"
        for name, number in (
            *(("", False), ("case", False), ("verdict", False), ("margin", True)),
            *(("residual [m/s]", True), ("cost [us/step]", True), ("log", False)),
        )
    )
    rows = "\n".join(_case(result, folder) for result in results)
    body = f"""<h1>{mark}</h1>
<p>{met} of {len(claims)} claims met in {cells} cells. <span class="small">{LEGEND}</span></p>
<table>
<thead><tr>{heads}</tr></thead>
<tbody>
{rows}
</tbody>
</table>"""
    return document(f"lavender: {good} of {len(results)} cases pass", body)


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
    return (
        f'<tr class="case" data-case="{escape(run.name, quote=True)}">'
        f'<td class="picture">{picture(shown)}</td>'
        f"<td>{name}{question}{_details(result, folder)}{failed}</td>"
        f"<td>{_mark(result.good)}<br>"
        f'<span class="small">{met} of {len(verdicts)} claims</span></td>'
        f'<td class="number">{_number(margin)}{below}</td><td class="number">{residual:.2g}</td>'
        f'<td class="number">{_range(costs)}</td><td>{_link(shown, folder)}</td></tr>'
    )


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
            f'<td class="number">{_cost(outcome):.3g}</td><td>{_link(cell, folder)}</td></tr>'
        )
    claims = "".join(
        f"<tr><td>{_mark(verdict.passed)}</td><td>{escape(verdict.node)}</td>"
        f'<td class="number">{_number(verdict.measured)}</td><td>{escape(verdict.expected)}</td>'
        f'<td class="number">{_number(verdict.margin)}</td></tr>'
        for verdict in result.verdicts
    )
    count = f"{len(rows)} cell{'s' if len(rows) > 1 else ''}, {len(result.verdicts)} claims"
    return (
        f"<details><summary>{count}</summary><table><tbody>{''.join(rows)}</tbody></table>"
        f"<table><tbody>{claims}</tbody></table></details>"
    )


def _shown(result: Any) -> Any:
    """Return the cell that stands for the case: the first that failed something, or the first."""
    failed = {verdict.path for verdict in result.verdicts if not verdict.passed}
    failed |= {str(cell.path) for cell in result.ended_early}
    return next((c for c in result.run.cells if str(c.path) in failed), result.run.cells[0])


def _link(cell: Any, folder: Path) -> str:
    return f'<a href="{address(cell.path, folder)}">log</a>'


def _margin(verdicts: Sequence[Any]) -> tuple[float, str]:
    """Return the least margin and the claim that has it."""
    known = [verdict for verdict in verdicts if not math.isnan(verdict.margin)]
    if not known:
        return math.nan, ""
    least = min(known, key=lambda verdict: verdict.margin)
    return least.margin, least.node


def _cost(outcome: Any) -> float:
    return float(outcome.physics_ns / max(outcome.steps, 1) / 1000)


def _range(numbers: Sequence[float]) -> str:
    low, high = f"{min(numbers):.3g}", f"{max(numbers):.3g}"
    return low if low == high else f"{low} to {high}"


def _number(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.3g}"


def _mark(good: bool, words: str = "") -> str:
    return (
        f'<span class="{"pass" if good else "fail"}">{words or ("pass" if good else "FAIL")}</span>'
    )
