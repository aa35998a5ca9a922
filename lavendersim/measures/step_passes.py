"""Passes over the states of a run that its checks need: sums and maxima of steps, row by row.

Over a log they are made in numpy, here. While a cell runs kernels make them over its blocks
(`runner.step_passes_kernel`), to the same bits: every row has the same operations in the same
order, and what runs on from row to row goes row by row.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.measures.contact_sums import ContactSums, summed
from lavendersim.measures.interfaces import Floats, Rows, Trace


class MomentumRows(NamedTuple):
    """What enters the balance of momentum in each of n states."""

    momentum: tuple[Floats, Floats, Floats]  # [N s] (n,) each
    kinetic: Floats  # [J] (n,)
    mass: Floats  # of everything movable [kg] (n,)
    gravity: Floats  # [m/s^2] (3,)
    forces: Floats  # of the config [N] (n, 3)
    others: Floats  # impulse from what is not movable, beside contacts [N s] (n, 3)
    outer: Floats  # of contacts [N s] (n, 3)
    size: Floats  # sum of the sizes of impulses of contacts [N s] (n,)
    elapsed: Floats  # [s] (n - 1,)


class EnergyRows(NamedTuple):
    """What enters the balance of energy in each of n states [J] (n,)."""

    kinetic: Floats
    potential: Floats  # of gravity
    stored: Floats  # by effects
    work: Floats  # of the forces of the config
    events: Floats  # what they gave, at the most
    lifted: Floats  # by the projection, at the most
    pulled: Floats  # what contacts won by drawing together, at the most


# What runs on from section to section [J].
GIVEN, LOWEST, LOWEST_POTENTIAL, WORKED, PUT_IN = range(5)
# And what stays as it was found at first: weight times radius, potential and kinetic energy.
OWN_WEIGHT, FIRST_POTENTIAL, FIRST_KINETIC = range(5, 8)
SO_FAR: Final = 8


class Passes(NamedTuple):
    """How the passes are made."""

    contacts: Callable[[Trace], ContactSums]
    not_finite: Callable[[Rows, Floats], Floats]
    fastest: Callable[[Floats, Floats, NDArray[np.bool_] | None], tuple[Floats, NDArray[np.int64]]]
    imbalance: Callable[[MomentumRows], Floats]
    created: Callable[[EnergyRows, Floats], Floats]


def not_finite(step: Rows, pose: Floats) -> Floats:
    """Return how many numbers of each state, and how many poses of bodies, are not finite (n,)."""
    wrong = np.zeros(len(step))
    for name in step.dtype.names or ():
        wrong += ~np.isfinite(step[name])
    wrong += np.logical_not(np.isfinite(pose).all(axis=2)).sum(axis=1)
    return wrong


def fastest(
    pose: Floats, elapsed: Floats, moved: NDArray[np.bool_] | None
) -> tuple[Floats, NDArray[np.int64]]:
    """Return the speed of the fastest body's centre over each step [m/s] (n,), and which it is.

    pose: (n, bodies, 7). elapsed: [s] (n - 1,). moved: (n - 1, bodies), where the config put a body
    elsewhere, which is no speed; None: nowhere. A speed that is no number is larger than any.
    """
    count, bodies = pose.shape[:2]
    most, body_of_row = np.zeros(count), np.zeros(count, dtype=np.int64)
    for body in range(bodies):
        speed = np.sqrt((np.diff(pose[:, body, :3], axis=0) ** 2).sum(axis=1)) / elapsed
        if moved is not None:
            speed[moved[:, body]] = 0.0
        above = ~((speed <= most[1:]) | np.isnan(most[1:]))
        most[1:][above], body_of_row[1:][above] = speed[above], body
    return most, body_of_row


def imbalance(rows: MomentumRows) -> Floats:
    """Return the part of each step's change of momentum without a cause, over all causes [-]."""
    gaps = np.zeros(len(rows.kinetic))
    dt, mass, forces, others = rows.elapsed, rows.mass, rows.forces, rows.others
    outer, size = rows.outer + others, rows.size + np.sqrt((others**2).sum(axis=1))
    expected = (mass[1:, None] * rows.gravity + forces[1:]) * dt[:, None] + outer[1:]
    difference = np.diff(np.column_stack(rows.momentum), axis=0) - expected
    carried = np.sqrt(2.0 * mass * rows.kinetic)
    enters = size[1:] + carried[1:] + carried[:-1]
    pull = math.hypot(*rows.gravity)
    enters += (mass[1:] * pull + np.sqrt((forces[1:] ** 2).sum(axis=1))) * dt
    lengths = np.sqrt((difference**2).sum(axis=1))
    with np.errstate(invalid="ignore", divide="ignore"):
        gaps[1:] = np.where(lengths == 0.0, 0.0, lengths / enters)
    return gaps


def created(rows: EnergyRows, so_far: Floats) -> Floats:
    """Return, in every state, the energy gained since it was lowest over that at play [-].

    so_far: (SO_FAR,), carried on.
    """
    potential = rows.potential + rows.stored
    given = _summed(so_far[GIVEN], rows.work + rows.events + rows.lifted + rows.pulled)
    with np.errstate(invalid="ignore"):  # of what is beyond all numbers
        own = rows.kinetic + rows.potential + rows.stored - given
    lowest = np.minimum(np.minimum.accumulate(own), so_far[LOWEST])
    deepest = np.minimum(np.minimum.accumulate(potential), so_far[LOWEST_POTENTIAL])
    worked = _summed(so_far[WORKED], np.abs(rows.work))
    put_in = _summed(so_far[PUT_IN], np.maximum(rows.events, 0.0))
    so_far[:OWN_WEIGHT] = given[-1], lowest[-1], deepest[-1], worked[-1], put_in[-1]
    with np.errstate(invalid="ignore"):
        gained = own - lowest
    at_play = (
        so_far[FIRST_KINETIC]
        + so_far[OWN_WEIGHT]
        + np.maximum(so_far[FIRST_POTENTIAL] - deepest, 0.0)
        + worked
        + put_in
    )
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.where(at_play > 0.0, gained / at_play, np.where(gained > 0.0, np.inf, 0.0))
    # nothing that is not finite may pass
    result: Floats = np.where(np.isfinite(gained), share, np.nan)
    return result


def _summed(before: float, numbers: Floats) -> Floats:
    """Return the running sum behind what was summed before, rounded as if it were one."""
    sums: Floats = np.cumsum(np.concatenate(([before], numbers)))[1:]
    return sums


OVER_LOGS: Final = Passes(summed, not_finite, fastest, imbalance, created)
