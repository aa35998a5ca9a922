"""A log in sections of states, as much at a time as memory holds.

A section after the first begins with the last state of the one before, without its contacts: what
is taken over each step finds both its ends.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.clock import Clock
from lavendersim.measures.interfaces import Floats, Rows, Trace


class Section(NamedTuple):
    """Some states of a run as measures of single steps read them; see `interfaces.Trace`."""

    step: Rows
    contact: Rows
    pose: Floats
    bodies: Sequence[str]
    config: CellConfig
    clock: Clock
    absent: Mapping[str, str]
    residual: Any = ()  # no measure of a single step needs sweeps
    status: str = "complete"

    def contacts_in_parts(self) -> Iterator[Rows]:
        """Yield all contacts: a section fits into memory."""
        yield self.contact


def sections_of(trace: Trace, states: int) -> Iterator[tuple[int, Trace]]:
    """Yield the first states of a log in sections, each with how many went before it."""
    context = (trace.bodies, trace.config, trace.clock, trace.absent)
    step = trace.step[:states]
    posed = "/tf" not in trace.absent
    pose = trace.pose[:states] if posed else np.empty((len(step), 0, 0))
    begin, none = 0, None
    for contact in trace.contacts_in_parts():
        none = contact[:0]
        if len(contact) == 0:
            continue
        end = int(np.searchsorted(step["step"], contact["step"][-1], "right"))
        if end == begin:
            break  # contacts of states beyond those
        again = max(begin - 1, 0)
        mine = contact[: np.searchsorted(contact["step"], step["step"][end - 1], "right")]
        yield begin, Section(step[again:end], mine, pose[again:end], *context)
        begin = end
    if begin < len(step):
        again = max(begin - 1, 0)
        without = trace.contact if none is None else none
        yield begin, Section(step[again:], without, pose[again:], *context)
