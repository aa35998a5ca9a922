"""The laws of every step of a log, and the worst of each."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final, NamedTuple

import numpy as np

from .contacts import ContactSearch
from .momentum import BodyStates
from .motion import Floats, RecordedMotion, changed, pairs_of_states
from .pushes import Violation
from .step_laws import LAWS, UNITS, laws_of

EVERYWHERE: Final = (0.0, 0.5, 1.0)  # of a step: where its contacts may push
AT_START: Final = (0.0,)
# Share of what is at play from which on a law counts as broken [-].
BROKEN: Final = 1e-4


class WorstStep(NamedTuple):
    """The step that breaks a law most."""

    law: str
    step: int  # the one that leads to this state; -1: none breaks it
    time: float  # [s] at its end
    bodies: tuple[str, ...]
    violation: Violation


class JudgedLaws(NamedTuple):
    """What the steps of a log do to the laws."""

    steps: np.ndarray  # (n,) those that were judged
    times: Floats  # (n,) [s] at their ends
    numbers: dict[str, Floats]  # by law: (n,) in its unit
    shares: dict[str, Floats]  # by law: (n,) of what was at play [-]
    worst: tuple[WorstStep, ...]  # by LAWS
    left_out: int  # steps that an event opens by changing a velocity, pose or mass

    @property
    def named(self) -> WorstStep | None:
        """The law broken most, by the largest of its shares; None: none is beyond BROKEN."""
        shares = [float(np.max(self.shares[one.law], initial=0.0)) for one in self.worst]
        k = int(np.argmax(shares))
        return self.worst[k] if shares[k] > BROKEN else None

    def table(self) -> dict[str, Any]:
        """Return it as plain data."""
        named = self.named
        return {
            "steps": len(self.steps),
            "left_out": self.left_out,
            "named": named.law if named else None,
            "laws": {one.law: _row(one) for one in self.worst},
        }

    def rows(self) -> dict[str, Any]:
        """Return the numbers of every step as plain data."""
        numbers = {law: one.tolist() for law, one in self.numbers.items()}
        return {"step": self.steps.tolist(), "time": self.times.tolist(), "numbers": numbers}


def judge_laws(motion: RecordedMotion, looks: tuple[float, ...] | None = None) -> JudgedLaws:
    """Return the laws of every step of a run that has the states before and after it.

    looks: shares of a step, 0, 1/2 or 1, in whose poses contacts may push; those of its start,
    middle and end where None, or of its start alone where the config integrates from there
    (`semi_implicit_euler`). UsageError where no step can be judged.
    """
    rows, jumps = pairs_of_states(motion), changed(motion)
    search = ContactSearch(motion)
    looks = looks or looks_of(motion)
    judged: list[dict[str, Violation]] = []
    kept: list[int] = []
    for row in rows:
        step = int(motion.steps[row])
        search.begin(step - 1)
        if step in jumps:
            continue
        before, after = (BodyStates(motion.pose[k], motion.velocity[k]) for k in (row - 1, row))
        judged.append(laws_of(search, before, after, float(motion.clock.length(step)), looks))
        kept.append(step)
    steps = np.array(kept, np.int64)
    times = np.array([float(motion.clock.time(step)) for step in kept])
    numbers = {law: np.array([one[law].number for one in judged]) for law in LAWS}
    shares = {law: np.array([one[law].share for one in judged]) for law in LAWS}
    worst = tuple(_worst(motion, judged, steps, times))
    return JudgedLaws(steps, times, numbers, shares, worst, len(rows) - len(kept))


def looks_of(motion: RecordedMotion) -> tuple[float, ...]:
    """Return in which poses of a step the engine that a config describes lets contacts push."""
    numerics = motion.config.numerics
    return AT_START if numerics.integrator == "semi_implicit_euler" else EVERYWHERE


def _worst(
    motion: RecordedMotion, judged: list[dict[str, Violation]], steps: np.ndarray, times: Floats
) -> Iterator[WorstStep]:
    for law in LAWS:
        numbers = [one[law].number for one in judged]
        k = int(np.argmax(numbers)) if numbers else -1
        if k < 0 or numbers[k] == 0.0:
            yield WorstStep(law, -1, 0.0, (), Violation(0.0, 0.0, ()))
            continue
        violation = judged[k][law]
        bodies = tuple(motion.bodies[row] for row in violation.bodies)
        yield WorstStep(law, int(steps[k]), float(times[k]), bodies, violation)


def _row(one: WorstStep) -> dict[str, Any]:
    violation = one.violation
    row = {
        "worst": violation.number,
        "unit": UNITS[one.law],
        "share": violation.share,
        "step": one.step if one.bodies else None,
        "time": one.time if one.bodies else None,
        "bodies": list(one.bodies),
    }
    if violation.velocity:
        row["velocity"] = violation.velocity
    if violation.gap:
        row["gap"] = violation.gap
    return row
