"""The checks of every step (`always`): for each a number in every state of a log, and its bound.

finite       how many numbers of a state or its contacts are not finite; of poses and contacts where
             every step has them in the log
energy       gained since it was lowest, of what is at play (`balance`)
penetration  the deepest of the step [m]
impulses     the largest of -lambda_n and |lambda_t| - mu lambda_n of a contact, |psi_n| and |psi_t|
             against their own limits likewise, over the largest normal impulse of the step
momentum     the part of its change without a cause (`balance`)
residual     of the step [m/s]
speed        displacement of a body's centre over the step's time, the largest [m/s]

mu is the config's, or the log's where it changes with the motion; the limits of torsional and
rolling friction are those of the contact's row.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Iterator
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.cell import changes_of_bodies
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.shapes import thickness
from lavendersim.measures.balance import EnergyBalance, momentum_imbalance
from lavendersim.measures.changes import first_starting_at
from lavendersim.measures.contact_sums import ContactSums, contacts_of_log, excesses
from lavendersim.measures.interfaces import Floats, Rows, Trace
from lavendersim.measures.other_engines import unanswered
from lavendersim.measures.overlap_of_bodies import overlap_of_rows
from lavendersim.measures.specs.always import CHECKS, DERIVED, FINITE, NONE, Always
from lavendersim.measures.step_passes import OVER_LOGS, Passes

ENERGY: Final = "energy"  # the one check that needs what went before
SHARE_OF_THICKNESS = 0.1  # a body that sank by a tenth of itself has left the place it stood in


class CheckedSteps(NamedTuple):
    """One check of a log."""

    check: str
    unit: str  # behind a number, with a blank before it where there is one
    bound: float
    numbers: Floats  # in every state; above the bound, or NaN, where it is broken
    bodies: Callable[[int], str]  # row of the log -> its bodies, in words; empty where none


class StepChecks:
    """The checks of a run; the states of its log may come in several sections.

    A section after the first begins with the last state of the one before, without its contacts.
    """

    def __init__(
        self,
        always: Always,
        checks: Container[str] = CHECKS,
        passes: Passes = OVER_LOGS,
    ) -> None:
        """checks: those of CHECKS that may be made; the others are left out.

        passes: how sums and maxima of steps are taken.
        """
        self._always, self._energy, self._passes = always, EnergyBalance(passes), passes
        self._checks = [check for check in checks_of(always) if check in checks]
        self._bounds: dict[str, float] = {}
        self.not_reported: dict[str, str] = {}  # checks that the log cannot answer, with reasons

    def over(self, trace: Trace) -> Iterator[CheckedSteps]:
        """Yield the checks that are made of a log or its next section, in the order of CHECKS."""
        self.not_reported = unanswered(trace)
        sums = self._passes.contacts(trace)
        for check in self._checks:
            if check in self.not_reported:
                continue
            if check not in self._bounds:
                self._bounds[check] = bound_of(check, self._always, trace)
            numbers, bodies = self._numbers(check, trace, sums)
            yield CheckedSteps(check, UNITS[check], self._bounds[check], numbers, bodies)

    def _numbers(self, check: str, trace: Trace, sums: ContactSums) -> Numbers:
        if check == ENERGY:
            return self._energy.created(trace, sums), _no_body
        return NUMBERS[check](trace, sums, self._passes)


def checks_of(always: Always | None) -> tuple[str, ...]:
    """Return the checks that a config requires."""
    if always is None:
        return ()
    bounds = {name: getattr(always, name) for name in CHECKS if name != FINITE}
    return tuple(name for name in CHECKS if name == FINITE or bounds[name] != NONE)


def bound_of(check: str, always: Always, trace: Trace) -> float:
    """Return the bound of a check in a cell."""
    if check == FINITE:
        return 0.0
    specified = getattr(always, check)
    if specified != DERIVED:
        return float(specified)
    bodies = [one for one in trace.config.scene.bodies.values() if is_movable(one)]
    return SHARE_OF_THICKNESS * min((thickness(one.shape) for one in bodies), default=math.inf)


Numbers = tuple[Floats, Callable[[int], str]]


def _no_body(row: int) -> str:
    return ""


def _finite(trace: Trace, sums: ContactSums, passes: Passes) -> Numbers:
    step = trace.step
    pose: Floats = np.empty((len(step), 0, 0)) if "/tf" in trace.absent else trace.pose

    def first(row: int) -> str:
        of_body = np.logical_not(np.isfinite(pose[row]).all(axis=1))
        return trace.bodies[int(np.argmax(of_body))] if of_body.any() else ""

    return sums.not_finite + passes.not_finite(step, pose), first


def _momentum(trace: Trace, sums: ContactSums, passes: Passes) -> Numbers:
    return momentum_imbalance(trace, sums, passes), _no_body


def _penetration(trace: Trace, sums: ContactSums, passes: Passes) -> Numbers:
    if trace.config.engine is not None:  # one geometry for all engines: not what each reports of it
        return overlap_of_rows(trace, np.arange(len(trace.step))), _no_body
    return sums.deepest, _of_contacts(trace, lambda contacts: contacts["penetration"])


def _impulses(trace: Trace, sums: ContactSums, passes: Passes) -> Numbers:
    return sums.excess, _of_contacts(trace, lambda contacts: excesses(trace, contacts))


def _residual(trace: Trace, sums: ContactSums, passes: Passes) -> Numbers:
    residual = np.asarray(trace.step["residual"], dtype=float)

    def worst(row: int) -> str:
        index = int(trace.step["residual_contact"][row])
        if index < 0 or "/contacts" in trace.absent:
            return ""
        return _pair(trace, contacts_of_row(trace, row)[index])

    return residual, worst


def _speed(trace: Trace, sums: ContactSums, passes: Passes) -> Numbers:
    step = trace.step["step"]
    elapsed = trace.clock.elapsed(step[:-1], step[1:])
    speeds, body_of_row = passes.fastest(trace.pose, elapsed, _moved(trace))
    return speeds, lambda row: trace.bodies[int(body_of_row[row])]


def _moved(trace: Trace) -> NDArray[np.bool_] | None:
    """Return in which steps the config put which body elsewhere (n - 1, bodies); None: in none."""
    jumps = [event for event in changes_of_bodies(trace.events) if event.teleport]
    if not jumps:
        return None
    moved = np.zeros((len(trace.step) - 1, len(trace.bodies)), bool)
    for event in jumps:
        row = first_starting_at(trace, event.at)
        if 0 < row <= len(moved):
            moved[row - 1, list(trace.bodies).index(event.body)] = True
    return moved


def _of_contacts(trace: Trace, numbers: Callable[[Rows], Floats]) -> Callable[[int], str]:
    """Return what names the bodies of the contact with the largest number in a row's step."""

    def worst(row: int) -> str:
        contacts = contacts_of_row(trace, row)
        if len(contacts) == 0:
            return ""
        mine = numbers(contacts)
        return _pair(trace, contacts[int(np.argmax(np.where(np.isnan(mine), np.inf, mine)))])

    return worst


def contacts_of_row(trace: Trace, row: int) -> Rows:
    """Return the contacts of a row's step; none where the log has none."""
    contacts = contacts_of_log(trace)
    if contacts is None or len(contacts) == 0:
        none: Rows = np.empty(0, [])
        return none
    step = trace.step["step"][row]
    first, last = (np.searchsorted(contacts["step"], step, side) for side in ("left", "right"))
    mine: Rows = contacts[first:last]
    return mine


def _pair(trace: Trace, contact: np.void) -> str:
    return f"{trace.bodies[contact['body_a']]} and {trace.bodies[contact['body_b']]}"


NUMBERS: Final[dict[str, Callable[[Trace, ContactSums, Passes], Numbers]]] = {
    "finite": _finite,
    "penetration": _penetration,
    "impulses": _impulses,
    "momentum": _momentum,
    "residual": _residual,
    "speed": _speed,
}
UNITS: Final = {
    "finite": " numbers not finite",
    "energy": " of the energy at play",
    "penetration": " m",
    "impulses": " of the step's largest normal impulse",
    "momentum": " of what enters the balance",
    "residual": " m/s",
    "speed": " m/s",
}
