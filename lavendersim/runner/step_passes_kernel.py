"""The passes over states that checks need (`step_passes`), by kernels over the blocks of a run.

Rows of steps come as they stand in memory; which columns are numbers comes as an array, so that one
kernel serves them all.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, lru_cache
from math import hypot, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lavendersim.engine.compile import call, inner
from lavendersim.engine.kernel_cache import cached
from lavendersim.engine.spec import Spec
from lavendersim.measures.interfaces import Floats, Rows
from lavendersim.measures.step_passes import (
    FIRST_KINETIC,
    FIRST_POTENTIAL,
    GIVEN,
    LOWEST,
    LOWEST_POTENTIAL,
    OWN_WEIGHT,
    PUT_IN,
    WORKED,
    EnergyRows,
    MomentumRows,
)

from .contact_sums_kernel import EXPONENT, nan_or_larger


def _smaller(one, other):
    """Return the smaller of two numbers; NaN is smaller than anything."""
    return one if one < other or one != one else other


def _make_not_finite(spec: Spec) -> Any:
    def count_not_finite(words, columns, pose, wrong):
        for i in range(wrong.shape[0]):
            count = 0
            for k in columns:
                count += words[i, k] & EXPONENT == EXPONENT
            for body in range(pose.shape[1]):
                of_body = 0
                for k in range(pose.shape[2]):
                    of_body += pose[i, body, k] & EXPONENT == EXPONENT
                count += of_body > 0
            wrong[i] = count

    return inner(count_not_finite)


def _make_fastest(spec: Spec) -> Any:
    def find_fastest(pose, elapsed, moved, speeds, bodies):
        for i in range(1, pose.shape[0]):
            most, fastest = 0.0, 0
            for body in range(pose.shape[1]):
                x = pose[i, body, 0] - pose[i - 1, body, 0]
                y = pose[i, body, 1] - pose[i - 1, body, 1]
                z = pose[i, body, 2] - pose[i - 1, body, 2]
                speed = sqrt(x * x + y * y + z * z) / elapsed[i - 1]
                if len(moved) and moved[i - 1, body]:
                    speed = 0.0
                if not (speed <= most or most != most):
                    most, fastest = speed, body
            speeds[i], bodies[i] = most, fastest

    return inner(find_fastest)


def _make_imbalance(spec: Spec) -> Any:
    def balance_momentum(states, causes, contacts, elapsed, gaps):
        (p_x, p_y, p_z), kinetic = states
        mass, gravity, pull, forces, others = causes
        outer, size = contacts
        for i in range(1, gaps.shape[0]):
            dt, m = elapsed[i - 1], mass[i]
            squared, others_squared, forces_squared = 0.0, 0.0, 0.0
            for k in range(3):
                p = p_x if k == 0 else p_y if k == 1 else p_z
                expected = (m * gravity[k] + forces[i, k]) * dt + (outer[i, k] + others[i, k])
                difference = p[i] - p[i - 1] - expected
                squared += difference * difference
                others_squared += others[i, k] * others[i, k]
                forces_squared += forces[i, k] * forces[i, k]
            enters = size[i] + sqrt(others_squared)
            enters += sqrt(2.0 * m * kinetic[i])
            enters += sqrt(2.0 * mass[i - 1] * kinetic[i - 1])
            enters += (m * pull + sqrt(forces_squared)) * dt
            gaps[i] = 0.0 if squared == 0.0 else sqrt(squared) / enters

    return inner(balance_momentum)


def _make_created(spec: Spec) -> Any:
    larger, smaller = inner(nan_or_larger), inner(_smaller)

    def balance_energy(rows, so_far, shares):
        kinetic, potential, stored, work, events, lifted, pulled = rows
        given, lowest, worked = so_far[GIVEN], so_far[LOWEST], so_far[WORKED]
        deepest, put_in = so_far[LOWEST_POTENTIAL], so_far[PUT_IN]
        began, first_potential = so_far[FIRST_KINETIC] + so_far[OWN_WEIGHT], so_far[FIRST_POTENTIAL]
        for i in range(shares.shape[0]):
            given += work[i] + events[i] + lifted[i] + pulled[i]
            own = kinetic[i] + potential[i] + stored[i] - given
            lowest = smaller(own, lowest)
            deepest = smaller(potential[i] + stored[i], deepest)
            worked += abs(work[i])
            put_in += larger(events[i], 0.0)
            gained = own - lowest
            at_play = began + larger(first_potential - deepest, 0.0) + worked + put_in
            if gained - gained != 0.0:
                shares[i] = np.nan  # nothing that is not finite may pass
            elif at_play > 0.0:
                shares[i] = gained / at_play
            else:
                shares[i] = np.inf if gained > 0.0 else 0.0
        so_far[GIVEN], so_far[LOWEST], so_far[WORKED] = given, lowest, worked
        so_far[LOWEST_POTENTIAL], so_far[PUT_IN] = deepest, put_in

    return inner(balance_energy)


@cache
def _kernel(make: Callable[[Spec], Any]) -> Any:
    return cached(make, Spec())


def _run(make: Callable[[Spec], Any], *arguments: Any) -> None:
    call(_kernel(make), *arguments)


def _plain(numbers: Any) -> Floats:
    return np.ascontiguousarray(numbers, np.float64)


def not_finite(step: Rows, pose: Floats) -> Floats:
    """Return the same as `step_passes.not_finite`; rows are of eight-byte fields."""
    words = np.ascontiguousarray(step).view(np.int64).reshape(len(step), -1)
    wrong = np.zeros(len(step))
    bits = _plain(pose).view(np.int64)
    _run(_make_not_finite, words, _floats(step.dtype), bits, wrong)
    return wrong


@lru_cache(maxsize=64)
def _floats(row: np.dtype[Any]) -> NDArray[np.int64]:
    """Return which eight bytes of a row are floats."""
    fields = (row.fields or {}).items()
    return np.array([place[1] // 8 for _, place in fields if place[0].kind == "f"], np.int64)


def fastest(
    pose: Floats, elapsed: Floats, moved: NDArray[np.bool_] | None
) -> tuple[Floats, NDArray[np.int64]]:
    """Return the same as `step_passes.fastest`."""
    speeds, bodies = np.zeros(len(pose)), np.zeros(len(pose), np.int64)
    where = np.zeros((0, 0), bool) if moved is None else moved
    _run(_make_fastest, _plain(pose), _plain(elapsed), where, speeds, bodies)
    return speeds, bodies


def imbalance(rows: MomentumRows) -> Floats:
    """Return the same as `step_passes.imbalance`."""
    gaps = np.zeros(len(rows.kinetic))
    _run(
        _make_imbalance,
        (tuple(map(_plain, rows.momentum)), _plain(rows.kinetic)),
        (
            *(_plain(rows.mass), _plain(rows.gravity), hypot(*rows.gravity)),
            *(_plain(rows.forces), _plain(rows.others)),
        ),
        (_plain(rows.outer), _plain(rows.size)),
        _plain(rows.elapsed),
        gaps,
    )
    return gaps


def created(rows: EnergyRows, so_far: Floats) -> Floats:
    """Return the same as `step_passes.created`."""
    shares = np.zeros(len(rows.kinetic))
    _run(_make_created, tuple(map(_plain, rows)), so_far, shares)
    return shares
