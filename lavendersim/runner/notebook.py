"""A run as a notebook shows it: summary, verdicts, and its figure as a small picture.

Names come from configs of anybody: everything that is not written here is escaped.
"""

from __future__ import annotations

import base64
from collections import Counter
from html import escape
from typing import TYPE_CHECKING, Any, Final

from lavendersim.errors import LavenderError

if TYPE_CHECKING:
    from .run_directory import Run

WIDTH: Final = 420  # dots of the picture
MOST_VERDICTS: Final = 20  # of a long list the failed ones, then the first
FIGURES: Final = "figures"


def html_of(run: Run) -> str:
    """Return a run as HTML. A damaged or unfinished run says so in place of its results."""
    head = f"<b>{_name(run)}</b> <code>{escape(str(run.path))}</code>"
    try:
        body = _results(run)
    except LavenderError as error:
        body = f"<p>{escape(str(error))}</p>"
    return f"<div>{head}{body}{_picture(run)}</div>"


def _name(run: Run) -> str:
    try:
        return escape(run.name)
    except LavenderError:
        return escape(run.path.name)


def _results(run: Run) -> str:
    results = run.results()
    cells, checks = results["cells"], results["checks"]
    ended = Counter(row["status"] for row in cells)
    states = ", ".join(f"{count} {escape(str(state))}" for state, count in ended.items())
    steps = sum(row["steps"] for row in cells)
    physics = sum(row["steps"] * row["physics_us_per_step"] for row in cells) / max(steps, 1)
    passed = sum(check["passed"] for check in checks)
    summary = (
        f"<p>{len(cells)} cell{'s' * (len(cells) != 1)} ({states}), {steps} steps, "
        f"physics {physics:.2f} µs/step; {passed} of {len(checks)} claims met</p>"
    )
    shown = sorted(checks, key=lambda check: bool(check["passed"]))[:MOST_VERDICTS]
    rows = "".join(map(_verdict, shown))
    more = len(checks) - len(shown)
    rest = f"<p>and {more} more that are met</p>" if more and passed >= more else ""
    if more and not rest:
        rest = f"<p>and {more} more</p>"
    head = "<tr><th></th><th>claim</th><th>measured</th><th>expected</th></tr>"
    return summary + (f"<table>{head}{rows}</table>{rest}" if checks else "")


def _verdict(check: dict[str, Any]) -> str:
    mark = "pass" if check["passed"] else "<b>FAIL</b>"
    value = check["measured"]
    measured = f"{value:.6g}" if isinstance(value, float | int) else str(value)
    cells = (escape(str(check["node"])), escape(measured), escape(str(check["expected"])))
    return f"<tr><td>{mark}</td>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"


def _picture(run: Run) -> str:
    """Return the first figure that was drawn of the run, within the page; nothing without one."""
    found = sorted((run.path / FIGURES).glob("*.png"))
    if not found:
        return ""
    data = base64.b64encode(found[0].read_bytes()).decode()
    name = escape(found[0].name, quote=True)
    return f'<img width="{WIDTH}" alt="{name}" src="data:image/png;base64,{data}">'
