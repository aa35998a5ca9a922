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

mu is the config's; the limits of torsional and rolling friction are those of the contact's row.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Iterator
from typing import Final, NamedTuple

import numpy as np

from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.shapes import thickness
from lavendersim.measures.balance import EnergyBalance, contacts_of_log, momentum_imbalance
from lavendersim.measures.changes import events_of_bodies, first_starting_at
from lavendersim.measures.columns import rows_of_steps
from lavendersim.measures.interfaces import Floats, Rows, Trace
from lavendersim.measures.kinds.optimality import friction_of
from lavendersim.measures.specs.always import CHECKS, DERIVED, FINITE, NONE, Always

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

    def __init__(self, always: Always, checks: Container[str] = CHECKS) -> None:
        """checks: those of CHECKS that may be made; the others are left out."""
        self._always, self._energy = always, EnergyBalance()
        self._checks = [check for check in checks_of(always) if check in checks]
        self._bounds: dict[str, float] = {}

    def over(self, trace: Trace) -> Iterator[CheckedSteps]:
        """Yield the checks that are made of a log or its next section, in the order of CHECKS."""
        for check in self._checks:
            if check not in self._bounds:
                self._bounds[check] = bound_of(check, self._always, trace)
            numbers, bodies = self._numbers(check, trace)
            yield CheckedSteps(check, UNITS[check], self._bounds[check], numbers, bodies)

    def _numbers(self, check: str, trace: Trace) -> Numbers:
        if check == ENERGY:
            return self._energy.created(trace), _no_body
        return NUMBERS[check](trace)


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


def _finite(trace: Trace) -> Numbers:
    step = trace.step
    wrong = np.zeros(len(step))
    for name in step.dtype.names or ():
        wrong += ~np.isfinite(step[name])
    pose: Floats = np.empty((len(step), 0, 0)) if "/tf" in trace.absent else trace.pose
    of_body = np.logical_not(np.isfinite(pose).all(axis=2))
    wrong += of_body.sum(axis=1)
    contacts = contacts_of_log(trace)
    if contacts is not None and len(contacts):
        rows = rows_of_steps(step, contacts)
        for name in _not_finite(contacts):
            wrong += np.bincount(rows[~np.isfinite(contacts[name])], minlength=len(step))

    def first(row: int) -> str:
        return trace.bodies[int(np.argmax(of_body[row]))] if of_body[row].any() else ""

    return wrong, first


def _not_finite(contacts: Rows) -> list[str]:
    """Return the columns of floats that have a number that is not finite, in one pass."""
    places = dict(contacts.dtype.fields or {})
    floats = {name: int(places[name][1]) for name in places if places[name][0].kind == "f"}
    if contacts.dtype.itemsize % 8 or any(offset % 8 for offset in floats.values()):
        return list(floats)
    words = np.ascontiguousarray(contacts).view("f8").reshape(len(contacts), -1)
    wrong = (~np.isfinite(words)).any(axis=0)  # columns of integers are looked at, and left out
    return [name for name, offset in floats.items() if wrong[offset // 8]]


def _momentum(trace: Trace) -> Numbers:
    return momentum_imbalance(trace), _no_body


def _penetration(trace: Trace) -> Numbers:
    contacts = contacts_of_log(trace)
    if contacts is None:
        return np.zeros(len(trace.step)), _no_body
    return _of_contacts(trace, contacts, contacts["penetration"])


def _residual(trace: Trace) -> Numbers:
    residual = np.asarray(trace.step["residual"], dtype=float)

    def worst(row: int) -> str:
        index = int(trace.step["residual_contact"][row])
        if index < 0 or "/contacts" in trace.absent:
            return ""
        first = np.searchsorted(trace.contact["step"], trace.step["step"][row])
        return _pair(trace, trace.contact[int(first) + index])

    return residual, worst


def _speed(trace: Trace) -> Numbers:
    pose, step = trace.pose, trace.step["step"]
    fastest, body_of_row = np.zeros(len(step)), np.zeros(len(step), dtype=int)
    dt = trace.clock.elapsed(step[:-1], step[1:])
    jumps = {event.body for event in events_of_bodies(trace) if event.teleport}
    for body, name in enumerate(trace.bodies):
        speed = np.sqrt((np.diff(pose[:, body, :3], axis=0) ** 2).sum(axis=1)) / dt
        if name in jumps:
            speed = _without_jumps(trace, name, speed)
        # NaN is faster than anything, and stays
        above = ~((speed <= fastest[1:]) | np.isnan(fastest[1:]))
        fastest[1:][above], body_of_row[1:][above] = speed[above], body
    return fastest, lambda row: trace.bodies[int(body_of_row[row])]


def _without_jumps(trace: Trace, name: str, speed: Floats) -> Floats:
    """Return speeds without those of steps in which the config moved the body."""
    for event in events_of_bodies(trace):
        row = first_starting_at(trace, event.at)
        if event.body == name and event.teleport and 0 < row <= len(speed):
            speed[row - 1] = 0.0
    return speed


def _impulses(trace: Trace) -> Numbers:
    contacts = contacts_of_log(trace)
    if contacts is None or len(contacts) == 0:
        return np.zeros(len(trace.step)), _no_body
    pushed = contacts["impulse_n"]
    names = contacts.dtype.names or ()
    excess = np.maximum(-pushed, 0.0)
    pressing = np.maximum(pushed, 0.0)
    if "impulse_t1" in names:
        bodies = trace.config.scene.bodies
        mu = friction_of(contacts, [bodies[name].surface for name in trace.bodies])
        first, second = contacts["impulse_t1"], contacts["impulse_t2"]
        pyramid = trace.config.numerics.friction_cone == "pyramid"
        size = np.maximum(abs(first), abs(second)) if pyramid else np.hypot(first, second)
        excess = np.maximum(excess, size - mu * pressing)
    # divided by its arm [m], an angular impulse is compared with the normal one
    for name, components in (
        ("torsional_friction", ("angular_impulse_n",)),
        ("rolling_friction", ("angular_impulse_t1", "angular_impulse_t2")),
    ):
        if name in names:
            size = np.hypot.reduce([contacts[one] for one in components])
            arm = contacts[name]
            with np.errstate(invalid="ignore", divide="ignore"):
                beyond = np.where(size > 0.0, size / arm - pressing, 0.0)
            excess = np.maximum(excess, beyond)
    rows = rows_of_steps(trace.step, contacts)
    largest = np.zeros(len(trace.step))
    with np.errstate(invalid="ignore", divide="ignore"):
        np.maximum.at(largest, rows, np.abs(pushed))
        share = np.where(excess == 0.0, 0.0, excess / largest[rows])
    return _of_contacts(trace, contacts, share)


def _of_contacts(trace: Trace, contacts: Rows, numbers: Floats) -> Numbers:
    """Return the largest number of the contacts of each step, and whose it is."""
    rows = rows_of_steps(trace.step, contacts)
    largest = np.zeros(len(trace.step))
    with np.errstate(invalid="ignore"):
        np.maximum.at(largest, rows, numbers)  # NaN stays

    def worst(row: int) -> str:
        mine = np.flatnonzero(rows == row)
        if len(mine) == 0:
            return ""
        ranked = np.where(np.isnan(numbers[mine]), np.inf, numbers[mine])
        return _pair(trace, contacts[mine[int(np.argmax(ranked))]])

    return largest, worst


def _pair(trace: Trace, contact: np.void) -> str:
    return f"{trace.bodies[contact['body_a']]} and {trace.bodies[contact['body_b']]}"


NUMBERS: Final[dict[str, Callable[[Trace], Numbers]]] = {
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
