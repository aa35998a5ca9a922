"""The tables of a log for other programs: `step`, `pose`, `velocity`, `contact`, part by part.

Columns are those that the log has, with the meanings that the effects declare. Bodies of contacts
and poses are words: their names. Poses and velocities have a row for every body.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from lavendersim.arrow import Batch, Field, Table, described
from lavendersim.arrow.fields import NUMBERS
from lavendersim.errors import UsageError
from lavendersim.trace.decode import seconds
from lavendersim.trace.schema import CONTACT_COLUMNS, STEP_COLUMNS

if TYPE_CHECKING:
    from lavendersim.trace.reader import Trace

Parts = Callable[[], Iterator[tuple[Any, Any]]]  # steps (n,), and numbers (n, bodies, k) of them
TOPICS: Final = {"step": "/step", "pose": "/tf", "velocity": "/velocities", "contact": "/contacts"}
BODIES: Final = ("body_a", "body_b")  # of a contact, by name
_TIME: Final = Field("time", "f8", "simulation time", "s")
_STEP: Final = Field("step", "i8", "index of the step; 0 is the initial state")
_POSE: Final = {
    **{axis: f"centre of mass, world {axis} [m]" for axis in "xyz"},
    **{f"q{part}": f"orientation, {part} of the unit quaternion" for part in "wxyz"},
}
_VELOCITY: Final = {
    **{f"v{axis}": f"velocity of the centre of mass, world {axis} [m/s]" for axis in "xyz"},
    **{f"w{axis}": f"angular velocity, world {axis} [rad/s]" for axis in "xyz"},
}


def table_of(trace: Trace, name: str) -> Table:
    """Return a table of a log. UsageError for a name of none, or a topic that the log has not."""
    if name not in TABLES:
        raise UsageError(f"{name!r}: no table of a log; expected one of {', '.join(TABLES)}")
    return TABLES[name](trace)


def _check_topic(trace: Trace, name: str) -> None:
    """Raise UsageError where the log has nothing of a table."""
    if not trace.has(TOPICS[name]):
        raise UsageError(trace.why_not(TOPICS[name]))


def _step(trace: Trace) -> Table:
    meanings = {column.name: column.meaning for column in STEP_COLUMNS}
    fields = [
        described(column.name, NUMBERS[column.kind], meanings.get(column.name, ""))
        for column in trace.step_columns
    ]

    def batches() -> Iterator[Batch]:
        return (
            {name: rows[name] for name in rows.dtype.names or ()} for rows in trace.steps_in_parts()
        )

    return Table("step", [*fields, _TIME], batches)


def _contact(trace: Trace) -> Table:
    _check_topic(trace, "contact")
    first: Any = next(trace.recorded_contacts_in_parts(), None)
    columns = first.dtype if first is not None else np.dtype([("step", "i8"), ("time", "f8")])
    names = columns.names or ()
    fields = [_of_contact(name, columns[name].str[1:], trace.bodies) for name in names]

    def batches() -> Iterator[Batch]:
        parts = trace.recorded_contacts_in_parts()
        return ({name: rows[name] for name in names} for rows in parts)

    return Table("contact", fields, batches)


def _of_contact(name: str, kind: str, bodies: list[str]) -> Field:
    if name in BODIES:
        return Field(name, "word", f"name of body {name[-1].upper()}", words=tuple(bodies))
    known = {"step": _STEP, "time": _TIME}
    return known.get(name) or described(name, NUMBERS[kind], CONTACT_COLUMNS.get(name, ""))


def _pose(trace: Trace) -> Table:
    _check_topic(trace, "pose")
    return _of_bodies(trace, "pose", trace.poses_in_parts, _POSE)


def _velocity(trace: Trace) -> Table:
    _check_topic(trace, "velocity")
    return _of_bodies(trace, "velocity", trace.velocities_in_parts, _VELOCITY)


def _of_bodies(trace: Trace, name: str, parts: Parts, columns: Mapping[str, str]) -> Table:
    """Return a table with a row for every body of each step; columns: their meanings."""
    body = Field("body", "word", "name of the body", words=tuple(trace.bodies))
    fields = [_STEP, _TIME, body, *(described(column, "f8", columns[column]) for column in columns)]

    def batches() -> Iterator[Batch]:
        for steps, numbers in parts():
            rows, count = numbers.shape[:2]
            by_row = numbers.reshape(rows * count, -1)
            yield {
                "step": np.repeat(steps, count),
                "time": np.repeat(seconds(trace.clock.nanoseconds(steps)), count),
                "body": np.tile(np.arange(count), rows),
                **{column: by_row[:, k] for k, column in enumerate(columns)},
            }

    return Table(name, fields, batches)


TABLES: Final[dict[str, Callable[[Trace], Table]]] = {
    "step": _step,
    "pose": _pose,
    "velocity": _velocity,
    "contact": _contact,
}
