"""The sums over contacts (`contact_sums`) of a cell that runs, by one kernel in one pass.

It serves rows of every form: which columns they have comes as an array, -1 for those they lack.
"""

from __future__ import annotations

from functools import cache, lru_cache
from math import sqrt
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lavendersim.cell import CellConfig
from lavendersim.cell.mixing import mixed
from lavendersim.clock import Clock
from lavendersim.engine.compile import call, inner
from lavendersim.engine.kernel_cache import cached
from lavendersim.engine.spec import Spec
from lavendersim.geometry.bodies import is_movable
from lavendersim.measures import shares
from lavendersim.measures.contact_sums import ContactSums, nothing
from lavendersim.measures.interfaces import Rows

COLUMNS: Final = (
    *("step", "body_a", "body_b", "nx", "ny", "nz", "t1x", "t1y", "t1z"),
    *("separation", "penetration", "normal_velocity", "impulse_n", "impulse_t1", "impulse_t2"),
    *("friction", "torsional_friction", "angular_impulse_n"),
    *("rolling_friction", "angular_impulse_t1", "angular_impulse_t2", "joint", "target"),
)
STEP, A, B, NX, NY, NZ, T1X, T1Y, T1Z = range(9)
SEPARATION, PENETRATION, NORMAL_VELOCITY, IMPULSE_N, IMPULSE_T1, IMPULSE_T2 = range(9, 15)
FRICTION, TORSIONAL, ANGULAR_N, ROLLING, ANGULAR_T1, ANGULAR_T2, JOINT, TARGET = range(15, 23)
# Columns of what the kernel fills for each step.
NOT_FINITE, DEEPEST, EXCESS, OUTER_X, OUTER_Y, OUTER_Z, SIZE, OPENED, PULLED = range(9)
EXPONENT: Final = 0x7FF << 52  # of a float64 that is not finite all these bits are set
VARIES: Final = -1.0  # in place of a coefficient that changes during the run


def nan_or_larger(one, other):
    """Return the larger of two numbers; NaN is larger than anything."""
    return one if one > other or one != one else other


def _length(first, second):
    """Return the length of a vector of two components that are not below 0."""
    larger = first if first > second or first != first else second
    if larger == 0.0:
        return 0.0
    one, other = first / larger, second / larger
    return larger * sqrt(one * one + other * other)


def _no_numbers(words):
    """Return how many words of a row would be no finite numbers, were all of them numbers."""
    count = 0
    for k in range(np.uint64(len(words))):
        count += words[k] & EXPONENT == EXPONENT
    return count


def _make_sum(spec: Spec) -> Any:
    larger, length, no_numbers = inner(nan_or_larger), inner(_length), inner(_no_numbers)

    def sum_contacts(rows, places, scene, sums):
        steps, numbers, integers = rows
        columns, floats, pulls = places
        of_body, mu, choices = scene
        projection, slop, pyramid = choices[0], choices[1], choices[2] == 1.0
        centred = choices[3] == 1.0
        end, count = 0, numbers.shape[0]
        for i in range(steps.shape[0]):
            dt, pushed, wrong, deepest, most = sums[i, OPENED], 0.0, 0.0, 0.0, 0.0
            outer_x, outer_y, outer_z = 0.0, 0.0, 0.0
            total, opened, pulled = 0.0, 0.0, 0.0
            while end < count and integers[end, columns[STEP]] <= steps[i]:
                row, words = numbers[end], integers[end]
                end += 1
                if no_numbers(words):  # or an integer below 0
                    for k in floats:
                        number = row[k]
                        if number - number != 0.0:
                            wrong += 1.0
                a, b = words[columns[A]], words[columns[B]]
                n, v_n = row[columns[IMPULSE_N]], row[columns[NORMAL_VELOCITY]]
                pull = 0.0
                for k in pulls:
                    pull += row[k]
                net = n - pull if len(pulls) else n
                x, y, z = row[columns[NX]], row[columns[NY]], row[columns[NZ]]
                jx, jy, jz = x * net, y * net, z * net
                excess, pressing = larger(-n, 0.0), larger(n, 0.0)
                if columns[JOINT] >= 0 and words[columns[JOINT]] > 0:  # of either sign
                    excess = 0.0
                if columns[IMPULSE_T1] >= 0:
                    one, two = row[columns[IMPULSE_T1]], row[columns[IMPULSE_T2]]
                    tx, ty, tz = row[columns[T1X]], row[columns[T1Y]], row[columns[T1Z]]
                    jx, jy, jz = jx + tx * one, jy + ty * one, jz + tz * one
                    jx += (y * tz - z * ty) * two
                    jy += (z * tx - x * tz) * two
                    jz += (x * ty - y * tx) * two
                    one, two = abs(one), abs(two)
                    size = larger(one, two) if pyramid else length(one, two)
                    between = mu[int(of_body[a, 0]), int(of_body[b, 0])]
                    if between == VARIES:
                        between = row[columns[FRICTION]]
                    excess = larger(excess, size - between * pressing)
                if columns[TORSIONAL] >= 0:
                    size = abs(row[columns[ANGULAR_N]])
                    if size != 0.0:
                        excess = larger(excess, size / row[columns[TORSIONAL]] - pressing)
                if columns[ROLLING] >= 0:
                    size = length(abs(row[columns[ANGULAR_T1]]), abs(row[columns[ANGULAR_T2]]))
                    if size != 0.0:
                        excess = larger(excess, size / row[columns[ROLLING]] - pressing)
                sign = of_body[b, 1] - of_body[a, 1]
                outer_x += sign * jx
                outer_y += sign * jy
                outer_z += sign * jz
                total += sqrt(jx * jx + jy * jy + jz * jz)
                rate = v_n
                if centred and n > 0.0:
                    mean = 0.5 * (v_n + row[columns[TARGET]])
                    if mean < rate:
                        rate = mean
                deep = -(row[columns[SEPARATION]] + rate * dt)
                opened += projection * larger(deep - slop, 0.0)
                pulled += larger(-pull * v_n, 0.0)
                deepest = larger(row[columns[PENETRATION]], deepest)
                most = larger(excess, most)
                pushed = larger(abs(n), pushed)
            out = sums[i]
            out[NOT_FINITE], out[DEEPEST] = wrong, deepest
            out[EXCESS] = most / pushed if most != 0.0 else 0.0
            out[OUTER_X], out[OUTER_Y], out[OUTER_Z] = outer_x, outer_y, outer_z
            out[SIZE], out[OPENED], out[PULLED] = total, opened, pulled

    return inner(sum_contacts)


@cache
def _kernel() -> Any:
    return cached(_make_sum, Spec())


@lru_cache(maxsize=64)
def _places(row: np.dtype[Any]) -> tuple[NDArray[np.int64], ...]:
    """Return which eight bytes of a row are COLUMNS, -1: none; which are floats, which pull."""
    places = {name: int(place[1]) // 8 for name, place in (row.fields or {}).items()}
    found = (
        [places.get(name, -1) for name in COLUMNS],
        [places[name] for name in places if row[name].kind == "f"],
        [places[name] for name in shares.PULLS if name in places],
    )
    return tuple(np.array(one, np.int64) for one in found)


class RunningSums:
    """Takes the sums of one cell's blocks."""

    def __init__(self, config: CellConfig, bodies: list[str], clock: Clock) -> None:
        known = [config.scene.bodies[name] for name in bodies]
        surfaces = [body.surface for body in known]
        different = list(dict.fromkeys(surfaces))
        number = {surface: row for row, surface in enumerate(different)}
        rows = [(number[body.surface], is_movable(body)) for body in known]
        self._of_body = np.array(rows, np.float64).reshape(-1, 2)
        changing = shares.surfaces_change(config)
        self._mu = np.zeros((len(different), len(different)))
        for i, one in enumerate(different):
            for j, other in enumerate(different[: i + 1]):  # mixed alike in either order
                between = mixed(one, other)
                varies = changing or shares.varies_friction(between)
                self._mu[i, j] = self._mu[j, i] = VARIES if varies else between.friction
        numerics = config.numerics
        pyramid = numerics.friction_cone == "pyramid"
        centred = numerics.integrator == "midpoint_contact"
        choices = [numerics.projection, numerics.slop, float(pyramid), float(centred)]
        self._choices = np.array(choices)
        self._clock = clock

    def __call__(self, step: Rows, contacts: Rows) -> ContactSums:
        """Return the sums of every step; contacts: rows as the engine wrote them, by step."""
        if len(contacts) == 0:
            return nothing(len(step))
        sums = np.zeros((len(step), 9))
        sums[:, OPENED] = self._clock.lengths(step["step"])  # where the kernel finds it
        words = np.ascontiguousarray(contacts)
        numbers, integers = (words.view(kind).reshape(len(words), -1) for kind in ("f8", "i8"))
        call(
            _kernel(),
            (np.ascontiguousarray(step["step"]), numbers, integers),
            _places(contacts.dtype),
            (self._of_body, self._mu, self._choices),
            sums,
        )
        return ContactSums(
            not_finite=sums[:, NOT_FINITE],
            deepest=sums[:, DEEPEST],
            excess=sums[:, EXCESS],
            outer=sums[:, OUTER_X : OUTER_Z + 1],
            size=sums[:, SIZE],
            opened=sums[:, OPENED],
            pulled=sums[:, PULLED],
        )
