"""A log as a notebook shows it: summary, tables, and the kinetic energy as a small picture.

Verdicts are those of a run, `open_run`: a log is not judged by itself.
"""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.errors import LavenderError
from lavendersim.trace.tables import TOPICS

if TYPE_CHECKING:
    from lavendersim.trace.reader import Trace

WIDTH: Final = 420  # dots of the picture
HEIGHT: Final = 120
COLUMNS: Final = 210  # of the picture: of more steps the least and the largest of each column
MOST_BODIES: Final = 12


class _Energies(NamedTuple):
    """Of each column of the picture, by time."""

    least: NDArray[np.float64]  # [J]
    largest: NDArray[np.float64]  # [J]
    steps: int  # that the log has, beside the initial state
    end: float  # [s]


def html_of(trace: Trace) -> str:
    """Return a log as HTML; what cannot be read of it is said in its place."""
    shown = [f"<p><b>{escape(trace.path.name)}</b>: {escape(trace.status)}</p>"]
    if trace.damage:
        shown.append(f"<p>{escape(trace.damage)}</p>")
    found: _Energies | None = None
    try:
        found = _energies(trace)
    except LavenderError as error:
        shown.append(f"<p>{escape(str(error))}</p>")
    rows = [("bodies", _bodies(trace))]
    if found is not None:
        rows.insert(0, ("steps", f"{found.steps} of {trace.clock.timestep} s, to {found.end:g} s"))
    for name, topic in TOPICS.items():
        if topic in trace.absent:
            rows.append((f'table("{name}")', trace.absent[topic]))
        else:
            rows.append((f'table("{name}")', topic))
    cells = (f"<tr><td>{escape(name)}</td><td>{escape(what)}</td></tr>" for name, what in rows)
    shown.append(f"<table>{''.join(cells)}</table>")
    if found is not None and found.end > 0.0 and np.isfinite(found.largest).any():
        shown.append(_picture(found))
    return f"<div>{''.join(shown)}</div>"


def _bodies(trace: Trace) -> str:
    more = len(trace.bodies) - MOST_BODIES
    named = ", ".join(trace.bodies[:MOST_BODIES])
    return f"{len(trace.bodies)}: {named}{f' and {more} more' if more > 0 else ''}"


def _energies(trace: Trace) -> _Energies:
    """Read the kinetic energy part by part."""
    least, largest = np.full(COLUMNS, np.inf), np.full(COLUMNS, -np.inf)
    steps, end = 0, 0.0
    last = max(float(trace.config.duration), 1e-300)
    for part in trace.steps_in_parts():
        if not len(part):
            continue
        steps, end = int(part["step"][-1]), float(part["time"][-1])
        if "kinetic_energy" not in (part.dtype.names or ()):
            continue
        energy = part["kinetic_energy"]
        place = np.minimum(part["time"] / last * COLUMNS, COLUMNS - 1).astype(int)
        finite = np.isfinite(energy)
        np.minimum.at(least, place[finite], energy[finite])
        np.maximum.at(largest, place[finite], energy[finite])
    return _Energies(least, largest, steps, end)


def _picture(found: _Energies) -> str:
    """Return the energy over time as an SVG: a line, as wide as the energies of its columns."""
    there = np.isfinite(found.largest)
    top = float(found.largest[there].max())
    scale = (HEIGHT - 20) / top if top > 0.0 else 0.0
    across = (np.flatnonzero(there) + 0.5) * WIDTH / COLUMNS

    def points(energies: NDArray[Any]) -> list[str]:
        up = HEIGHT - 2 - energies[there] * scale
        return [f"{x:.1f},{y:.1f}" for x, y in zip(across, up, strict=True)]

    outline = " ".join([*points(found.largest), *reversed(points(found.least))])
    title = f"kinetic energy, to {top:.3g} J"
    return (
        f'<svg width="{WIDTH}" height="{HEIGHT}" role="img" aria-label="{title}">'
        f'<text x="2" y="12" font-size="11">{title}</text>'
        f'<polygon points="{outline}" fill="#4477aa" stroke="#4477aa"/></svg>'
    )
