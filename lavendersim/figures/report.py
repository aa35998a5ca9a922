"""Finished runs in; one self-contained HTML page out: a row per case, its cells folded below.

No script, no network, no other file: pictures are data, styles stand in the page. The only links
are those to the logs, relative to the page, so that page and runs can be moved together.
"""

from __future__ import annotations

import base64
import math
import os
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any
from urllib.parse import quote

from lavendersim.errors import LavenderError
from lavendersim.figures.thumbnail import thumbnail

STYLE = """
body { font: 15px/1.45 sans-serif; color: #222; background: #fff; margin: 2em auto;
  max-width: 80em; padding: 0 1em; }
h1 { font-size: 1.5em; margin-bottom: 0.2em; }
table { border-collapse: collapse; width: 100%; }
th { text-align: left; font-weight: normal; color: #666; }
th, td { padding: 0.4em 0.8em 0.4em 0; vertical-align: top; border-bottom: 1px solid #ddd; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td.picture { width: 160px; }
.pass { color: #00694c; font-weight: bold; }
.fail { color: #b04a00; font-weight: bold; }
.small { color: #666; font-size: 0.87em; }
pre { background: #f5f5f5; padding: 0.6em; overflow-x: auto; font-size: 0.87em; }
details table { margin: 0.4em 0; font-size: 0.93em; }
summary { cursor: pointer; }
img { background: #fff; border: 1px solid #ddd; }
"""
LEGEND = (
    "Margin: the least share of a bound that is left over all claims that have one; below 0 it is "
    "broken. Residual: the worst of any step. Cost: physics alone, one processor, no logging."
)


def write_report(results: Sequence[Any], path: Path) -> None:
    """Write the page of finished runs (`.run`, `.outcomes`, `.verdicts`, `.good`), whole or not."""
    text = report(results, path.parent)
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_name(f".{path.name}.{os.getpid()}.unfinished")
    try:
        unfinished.write_text(text, encoding="utf-8")
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)


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
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>lavender: {good} of {len(results)} cases pass</title>
<style>{STYLE}</style>
</head>
<body>
<h1>{mark}</h1>
<p>{met} of {len(claims)} claims met in {cells} cells. <span class="small">{LEGEND}</span></p>
<table>
<thead><tr>{heads}</tr></thead>
<tbody>
{rows}
</tbody>
</table>
</body>
</html>
"""


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
        f'<td class="picture">{_picture(shown)}</td>'
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


def _picture(cell: Any) -> str:
    try:
        data = base64.b64encode(thumbnail(cell.trace())).decode()
    except LavenderError as error:  # a log that is damaged has no picture, but still a row
        return f'<span class="small">{escape(str(error))}</span>'
    finally:
        cell.release()
    said = escape(f"final poses {cell.label}".strip(), quote=True)
    return f'<img width="160" height="110" alt="{said}" src="data:image/png;base64,{data}">'


def _link(cell: Any, folder: Path) -> str:
    relative = os.path.relpath(cell.path.resolve(), folder.resolve())
    return f'<a href="{escape(quote(Path(relative).as_posix()), quote=True)}">log</a>'


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
