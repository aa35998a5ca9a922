"""What the checks of every step need of its contacts: sums and maxima over the rows of each step.

`summed` takes them over a log, in numpy. While a cell runs a kernel takes them over the rows as the
engine wrote them (`runner.contact_sums_kernel`), to the same bits: sums go row by row, and what is
computed of a row has the same operations in the same order.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lavendersim.geometry.bodies import is_movable
from lavendersim.measures import shares
from lavendersim.measures.columns import friction_of, impulses, rows_of_steps
from lavendersim.measures.interfaces import Floats, Rows, Trace

# (coefficient, its components): angular impulses that a lever times the normal one bounds
SPINS = (
    ("torsional_friction", ("angular_impulse_n",)),
    ("rolling_friction", ("angular_impulse_t1", "angular_impulse_t2")),
)


class ContactSums(NamedTuple):
    """One number, or vector, for each of n states; 0 without contacts."""

    not_finite: Floats  # how many numbers of its contacts are not finite
    deepest: Floats  # largest penetration [m]
    excess: Floats  # of the largest impulse beyond its limit, over the largest normal impulse [-]
    outer: Floats  # impulse on everything movable (n, 3) [N s]
    size: Floats  # sum of the sizes of all impulses [N s]
    opened: Floats  # sum of what the projection opens at the most [m]
    pulled: Floats  # energy won by drawing bodies together, at the most [J]


def contacts_of_log(trace: Trace) -> Rows | None:
    """Return the contact rows; None where nothing can touch, or not every step has its own."""
    return None if "/contacts" in trace.absent else trace.contact


def summed(trace: Trace) -> ContactSums:
    """Return the sums of every logged step."""
    contacts, count = contacts_of_log(trace), len(trace.step)
    if contacts is None or len(contacts) == 0:
        return nothing(count)
    rows = rows_of_steps(trace.step, contacts)

    def largest(numbers: Floats) -> Floats:
        most = np.zeros(count)
        with np.errstate(invalid="ignore"):
            np.maximum.at(most, rows, numbers)  # NaN stays
        return most

    def total(numbers: Floats) -> Floats:
        sums: Floats = np.bincount(rows, numbers, minlength=count).astype(np.float64)
        return sums

    wrong = np.zeros(count)
    for name in contacts.dtype.names or ():
        if contacts.dtype[name].kind == "f":
            wrong += np.bincount(rows[~np.isfinite(contacts[name])], minlength=count)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        vectors = impulses(contacts)
        x, y, z = vectors.T
        sign = _sign(trace, contacts)
        excess, pushed = largest(excesses(trace, contacts)), largest(np.abs(contacts["impulse_n"]))
        return ContactSums(
            not_finite=wrong,
            deepest=largest(contacts["penetration"]),
            excess=np.where(excess == 0.0, 0.0, excess / pushed),
            outer=np.stack([total(sign * one) for one in (x, y, z)], axis=1),
            size=total(np.sqrt(x * x + y * y + z * z)),
            opened=total(_opened(trace, contacts)),
            pulled=total(shares.given_by_pull(contacts)),
        )


def nothing(count: int) -> ContactSums:
    """Return the sums of states without contacts."""
    zeros = np.zeros(count)
    return ContactSums(zeros, zeros, zeros, np.zeros((count, 3)), zeros, zeros, zeros)


def excesses(trace: Trace, contacts: Rows) -> Floats:
    """Return by how much an impulse of each contact is beyond its limit [N s].

    Divided by its lever [m], an angular impulse is compared with the normal one.
    """
    pushed, names = contacts["impulse_n"], contacts.dtype.names or ()
    excess: Floats = np.maximum(-pushed, 0.0)
    if "joint" in names:  # of either sign
        excess = np.where(contacts["joint"] > 0, 0.0, excess)
    pressing = np.maximum(pushed, 0.0)
    if "impulse_t1" in names:
        mu = friction_of(trace, contacts)
        first, second = np.abs(contacts["impulse_t1"]), np.abs(contacts["impulse_t2"])
        pyramid = trace.config.numerics.friction_cone == "pyramid"
        size = np.maximum(first, second) if pyramid else _length(first, second)
        excess = np.maximum(excess, size - mu * pressing)
    for name, components in SPINS:
        if name in names:
            sizes = [np.abs(contacts[one]) for one in components]
            size, arm = sizes[0] if len(sizes) == 1 else _length(*sizes), contacts[name]
            with np.errstate(invalid="ignore", divide="ignore"):
                beyond = np.where(size == 0.0, 0.0, size / arm - pressing)
            excess = np.maximum(excess, beyond)
    return excess


def _length(first: Floats, second: Floats) -> Floats:
    """Return the length of vectors of two components that are not below 0.

    Scaled by the larger one, whose square may be beyond all numbers, or 0.
    """
    larger = np.maximum(first, second)
    with np.errstate(invalid="ignore", divide="ignore"):
        one, other = first / larger, second / larger
        length: Floats = np.where(larger == 0.0, 0.0, larger * np.sqrt(one * one + other * other))
    return length


def _sign(trace: Trace, contacts: Rows) -> Floats:
    """Return 1 or -1 where a contact's impulse on B acts on everything movable, or against it."""
    bodies = trace.config.scene.bodies
    movable = np.array([is_movable(bodies[name]) for name in trace.bodies], dtype=float)
    sign: Floats = movable[contacts["body_b"]] - movable[contacts["body_a"]]
    return sign


def _opened(trace: Trace, contacts: Rows) -> Floats:
    """Return how far the projection opens each contact at the most [m]; lavender's own alone."""
    if trace.config.engine is not None:
        return np.zeros(len(contacts))
    numerics = trace.config.numerics
    dt = trace.clock.lengths(contacts["step"])
    rate = contacts["normal_velocity"]
    if numerics.integrator == "midpoint_contact":
        # What pushes at the middle of the step opens by its mean, (w + kept)/2: kept is at most 0,
        # and where it counts the contact takes more than the projection gives.
        mean = 0.5 * (rate + contacts["target"])
        rate = np.where((contacts["impulse_n"] > 0.0) & (mean < rate), mean, rate)
    deep = -(contacts["separation"] + rate * dt)
    opened: Floats = numerics.projection * np.maximum(deep - numerics.slop, 0.0)
    return opened
