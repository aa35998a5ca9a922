"""The checks of an `always` section, made of the blocks of a cell while it runs.

A cell stops with the first step that breaks a bound. What the engine did beyond is dropped, so the
log ends with that step, whatever the size of a block. A state that is no number breaks no bound
here: the engine itself ends the run there. The worst states are those that the log gives, bit for
bit (`measures.always.outcomes_of`), so that a run is not read again to be judged.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from lavendersim.cell import AnyEvent, CellConfig, happened, met_after
from lavendersim.clock import Clock
from lavendersim.measures.always import WorstStates
from lavendersim.measures.contact_sums import ContactSums, nothing
from lavendersim.measures.interfaces import Floats, Rows, Trace
from lavendersim.measures.not_finite import without_warnings
from lavendersim.measures.sections import Section
from lavendersim.measures.specs.always import BEYOND_BOUNDS, STOPPING, Always
from lavendersim.measures.step_checks import CheckedSteps, StepChecks
from lavendersim.measures.step_passes import OVER_LOGS, Passes
from lavendersim.record_tables import joined
from lavendersim.trace import Block
from lavendersim.trace.layout import POSE

from . import step_passes_kernel
from .contact_sums_kernel import RunningSums


class Bounds:
    """Holds every step of one cell to what its config requires of every step."""

    def __init__(
        self,
        always: Always | None,
        bodies: list[str],
        config: CellConfig,
        clock: Clock,
        absent: Mapping[str, str],
    ) -> None:
        passes = OVER_LOGS  # rows of other engines have other columns: no kernel for each
        if config.engine is None:
            passes = _by_kernels(RunningSums(config, bodies, clock), "/contacts" not in absent)
        self._checks = None if always is None else StepChecks(always, passes=passes)
        self._stops = always is not None and always.stop
        self.worst = None if always is None else WorstStates(always)
        self._cell = (bodies, config, clock, absent)
        self._met: dict[int, int] = {}  # steps after which states of triggers were met
        self._last: tuple[Rows, Floats] | None = None  # the state before the block's

    @without_warnings
    def within(self, block: Block, diverged: bool = False, room: bool = False) -> tuple[Block, str]:
        """Return the block up to the first step beyond a bound, and a sentence if there is one.

        diverged: the engine ended with the last state of the block, which then counts for nothing.
        room: steps and poses have a row in front that is none of the block's: the state before is
        put there, where without it both would be copied.
        """
        with_room, block = block, _without_room(block) if room else block
        if self._checks is None or self.worst is None or len(block.step) == 0:
            return block, ""
        step, pose = block.step, block.pose
        again = 0
        if self._last is not None:
            again = 1
            if room:
                step, pose = with_room.step, with_room.pose
                step[:1], pose[:1] = self._last
            else:
                step, pose = joined([self._last[0], step]), np.concatenate([self._last[1], pose])
        part = Section(
            step, block.contact, pose[:, :, :POSE], *self._cell, happened=self._happened(step)
        )
        self._last = step[-1:].copy(), pose[-1:].copy()
        checked = list(self._checks.over(part))
        self.worst.not_reported = self._checks.not_reported
        # Of few passes: each gives the interpreter's lock to the threads of the log, and waits.
        most = [float(check.numbers[again:].max()) for check in checked]
        first: tuple[int, CheckedSteps] | None = None
        for check, largest in zip(checked, most, strict=True) if self._stops else ():
            if check.check not in STOPPING or largest <= check.bound:
                continue
            beyond = check.numbers[again:] > check.bound
            row = int(beyond.argmax())  # the first of them, if there is one
            if beyond[row] and (first is None or row + again < first[0]):
                first = (row + again, check)
        end = len(step) - diverged
        if first is not None:
            end = min(end, first[0] + 1)
        for check, largest in zip(checked, most, strict=True):
            self.worst.take(check, part, again, end, largest if end == len(step) else None)
        if first is None:
            return block, ""
        row, check = first
        return _cut(block, row + 1 - again), _sentence(check, row, part)

    def _happened(self, step: Rows) -> Sequence[AnyEvent]:
        """Return the events of the cell up to the end of a block."""
        _, config, clock, _ = self._cell
        if not config.triggered:
            return config.events
        self._met |= {k: done for k, done in met_after([step]).items() if k not in self._met}
        return happened(config.events, config.triggered, self._met, clock)


def _by_kernels(sums: RunningSums, touches: bool) -> Passes:
    """Return the passes by kernels; touches: there are contacts."""

    def summed(part: Trace) -> ContactSums:
        return sums(part.step, part.contact) if touches else nothing(len(part.step))

    kernels = step_passes_kernel
    return Passes(
        *(summed, kernels.not_finite, kernels.fastest, kernels.imbalance, kernels.created)
    )


def _without_room(block: Block) -> Block:
    return block._replace(step=block.step[1:], pose=block.pose[1:])


def _cut(block: Block, states: int) -> Block:
    """Return the first states of a block."""
    last = block.step["step"][states - 1]
    contact, residual = (
        rows[: np.searchsorted(rows["step"], last, "right")]
        for rows in (block.contact, block.residual)
    )
    return Block(block.step[:states], contact, block.pose[:states], residual)


def _sentence(check: CheckedSteps, row: int, part: Section) -> str:
    """Say which bound was broken, by how much, where and when."""
    step = int(part.step["step"][row])
    whose = check.bodies(row)
    return (
        f"{BEYOND_BOUNDS}{check.check} {float(check.numbers[row]):.6g}{check.unit}, at most "
        f"{check.bound:g}{f', {whose}' if whose else ''}, in step {step} "
        f"(t = {float(part.clock.time(step)):.9g} s)"
    )
