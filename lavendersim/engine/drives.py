"""Drives: functions of time that act on bodies, evaluated and integrated exactly within a step.

    value   f(t)
    rates   its derivatives
    knot    the next time at which g bends or jumps: where a substep ends (`step_doubling`)
    mean    1/h times the integral of f from t to t + h: the impulse of a force is exact, and no
            pulse is too short to be noticed
of f(t) = g(t) + a sin(omega t + phi), g linear between knots (`effects.time_functions`). The mean
of the sine is a sin(omega t_m + phi) sin(omega h/2)/(omega h/2), t_m the middle; that of a line its
value there. Times are counted in steps from where the timestep last changed: none drifts.
"""

from __future__ import annotations

from math import cos, sin
from typing import Any

from .compile import kernel
from .spec import Spec
from .step_terms import step_terms

# Substeps end at knots but for round-off: knots this near are there, of the time and MOMENT [-].
NEAR = 1e-12
# Time whose digits one near 0 has by what it is the difference of [s].
MOMENT = 1.0


def make_begin_of_part(spec: Spec) -> Any:
    """Return `kernel(params, counters) -> t`: when the part of a step begins [s]."""

    def begin_of_part(params, counters):
        steps = counters.step - params.stretch_step
        return params.stretch_begin + steps * params.timestep + counters.elapsed

    return kernel(begin_of_part, spec)


def make_last_knot(spec: Spec) -> Any:
    """Return `kernel(drive, knots, t) -> k`: the last knot up to t, `first - 1` before them."""

    def last_knot(drive, knots, t):
        low, high = drive.first - 1, drive.first + drive.count - 1
        while low < high:
            middle = (low + high + 1) // 2
            if knots[middle].time <= t:
                low = middle
            else:
                high = middle - 1
        return low

    return kernel(last_knot, spec)


def make_next_knot(spec: Spec) -> Any:
    """Return `kernel(drives, t, until) -> time` of the next knot, `until` if that comes first."""
    last_knot = make_last_knot(spec)

    def next_knot(drives, t, until):
        slack = NEAR * (MOMENT + t)
        for d in range(drives.records.shape[0]):
            drive = drives.records[d]
            k = last_knot(drive, drives.knots, t + slack) + 1
            if k < drive.first + drive.count:
                until = min(until, drives.knots[k].time)
        return until

    return kernel(next_knot, spec)


def make_on_line(spec: Spec) -> Any:
    """Return `kernel(drive, knots, k, t) -> g(t)`, by the line behind knot k."""

    def on_line(drive, knots, k, t):
        if k < drive.first:
            return knots[drive.first].value
        knot = knots[k]
        if k == drive.first + drive.count - 1:
            return knot.value + drive.slope * (t - knot.time)
        after = knots[k + 1]
        share = (t - knot.time) / (after.time - knot.time)
        return knot.value + share * (after.value - knot.value)

    return kernel(on_line, spec)


def make_value(spec: Spec) -> Any:
    """Return `kernel(drive, knots, t) -> f(t)`."""
    last_knot, on_line = make_last_knot(spec), make_on_line(spec)

    def value(drive, knots, t):
        f = on_line(drive, knots, last_knot(drive, knots, t), t)
        if drive.amplitude != 0.0:
            f += drive.amplitude * sin(drive.omega * t + drive.phase)
        return f

    return kernel(value, spec)


def make_rates(spec: Spec) -> Any:
    """Return `kernel(drive, knots, t, after)`: three derivatives of f; at a bend those after it, or
    before.
    """
    last_knot = make_last_knot(spec)
    near = NEAR if step_terms(spec).substeps else 0.0

    def rates(drive, knots, t, after):
        slack = near * (MOMENT + t)
        k, first, second, third = last_knot(drive, knots, t + slack), 0.0, 0.0, 0.0
        if not after:
            while k >= drive.first and knots[k].time >= t - slack:
                k -= 1
        if k == drive.first + drive.count - 1:
            first = drive.slope
        elif k >= drive.first:
            one, other = knots[k], knots[k + 1]
            first = (other.value - one.value) / (other.time - one.time)
        if drive.amplitude != 0.0:
            angle = drive.omega * t + drive.phase
            swing = drive.amplitude * drive.omega * cos(angle)
            first += swing
            second = -drive.amplitude * drive.omega * drive.omega * sin(angle)
            third = -drive.omega * drive.omega * swing
        return first, second, third

    return kernel(rates, spec)


def make_mean(spec: Spec) -> Any:
    """Return `kernel(drive, knots, t, h) -> mean of f from t to t + h`, h above 0."""
    last_knot, on_line = make_last_knot(spec), make_on_line(spec)

    def mean_of_lines(drive, knots, t, end):
        k, last = last_knot(drive, knots, t), drive.first + drive.count - 1
        if k == last or knots[k + 1].time >= end:
            return on_line(drive, knots, k, 0.5 * (t + end))
        total, begin = 0.0, t
        while begin < end:
            until = end
            if k < last:
                until = min(end, knots[k + 1].time)
            if until > begin:
                total += (until - begin) * on_line(drive, knots, k, 0.5 * (begin + until))
            begin = until
            k += 1
        return total / (end - t)

    mean_of_lines = kernel(mean_of_lines, spec)

    def mean(drive, knots, t, h):
        f = mean_of_lines(drive, knots, t, t + h)
        if drive.amplitude != 0.0:
            half = 0.5 * drive.omega * h
            f += drive.amplitude * sin(drive.omega * (t + 0.5 * h) + drive.phase) * sin(half) / half
        return f

    return kernel(mean, spec)
