"""The exact times of steps, and the steps that are done when a time is reached.

    times      0 ... dt1 ... 2 dt1 | 2 dt1 + dt2 ... | ...
    stretches  (done 0, begin 0, dt1)  (done 2, begin 2 dt1, dt2)  ...

A clock counts steps and keeps fractions of a second: no time drifts, however often the timestep
changes. A change specified for a time takes place when that time is reached by whole steps of the
timestep before, so every step has one length.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable
from fractions import Fraction
from math import ceil, floor, gcd, lcm
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    import numpy as np

NANOSECONDS = 10**9


class Stretch(NamedTuple):
    """Steps of one length, up to the next stretch."""

    done: int  # steps before it
    begin: Fraction  # [s] when it begins
    timestep: Fraction  # [s]


class Clock:
    """The times of a run's steps. changes: time [s] and the timestep [s] from then on.

    Changes at one time follow each other as they come, so the last one holds.
    """

    def __init__(
        self, timestep: Fraction, changes: Iterable[tuple[Fraction, Fraction]] = ()
    ) -> None:
        self.stretches = [Stretch(0, Fraction(0), timestep)]
        for at, length in sorted(changes, key=lambda change: change[0]):
            done = self.steps_until(at)
            before = [one for one in self.stretches if one.done < done]
            begin = self.time(done)
            if not before or before[-1].timestep != length:
                before.append(Stretch(done, begin, length))
            self.stretches = before

    @classmethod
    def counted(cls, timestep: Fraction, changes: Iterable[tuple[int, Fraction]]) -> Clock:
        """Return the clock of the first timestep [s] and its `changes`, in their order."""
        clock = cls(timestep)
        for done, length in changes:
            last = clock.stretches[-1]
            begin = last.begin + (done - last.done) * last.timestep
            if last.done == done:
                clock.stretches.pop()
            if not clock.stretches or clock.stretches[-1].timestep != length:
                clock.stretches.append(Stretch(done, begin, length))
        return clock

    @property
    def timestep(self) -> Fraction:
        """Length of the first step [s]."""
        return self.stretches[0].timestep

    @property
    def changes(self) -> list[tuple[int, Fraction]]:
        """After how many steps the timestep changes, and to what [s]."""
        return [(one.done, one.timestep) for one in self.stretches[1:]]

    @property
    def longest(self) -> Fraction:
        """The longest timestep [s]."""
        return max(one.timestep for one in self.stretches)

    def time(self, done: int) -> Fraction:
        """Return the time [s] when so many steps are done."""
        dones = [one.done for one in self.stretches]
        one = self.stretches[max(bisect_right(dones, done) - 1, 0)]
        return one.begin + (done - one.done) * one.timestep

    def steps_until(self, time: Fraction) -> int:
        """Return the fewest steps that reach a time [s]."""
        begins = [one.begin for one in self.stretches]
        one = self.stretches[max(bisect_left(begins, time) - 1, 0)]
        return one.done + ceil((time - one.begin) / one.timestep)

    def steps_within(self, time: Fraction) -> int:
        """Return the most steps that do not go beyond a time [s]."""
        begins = [one.begin for one in self.stretches]
        one = self.stretches[max(bisect_right(begins, time) - 1, 0)]
        return one.done + floor((time - one.begin) / one.timestep)

    def steps_of(self, duration: Fraction) -> int:
        """Return how many steps a run of so long [s] has.

        The whole number nearest to duration / timestep; where the timestep changes within the run,
        the fewest that reach the duration.
        """
        steps = self.steps_until(duration)
        if any(one.done < steps for one in self.stretches[1:]):
            return steps
        return round(duration / self.timestep)

    def length(self, step: int) -> Fraction:
        """Return the length [s] of a step, counted from 1; of step 0, the first one's."""
        dones = [one.done for one in self.stretches]
        return self.stretches[max(bisect_left(dones, step) - 1, 0)].timestep

    def lengths(self, steps: Any) -> np.ndarray:
        """Return the length [s] of each of many steps, float64, like `length`."""
        import numpy as np

        if len(self.stretches) == 1:
            return np.full(np.shape(steps), float(self.timestep))
        dones = [one.done for one in self.stretches]
        places = np.maximum(np.searchsorted(dones, steps, side="left") - 1, 0)
        of_stretches = np.array([float(one.timestep) for one in self.stretches])
        return np.asarray(of_stretches[places], np.float64)

    def elapsed(self, first: Any, last: Any) -> np.ndarray:
        """Return the time [s] from one count of steps to another, float64, of scalars or arrays.

        Each stretch is counted in its own steps: short times late in a long run keep their digits.
        """
        import numpy as np

        first, last = np.asarray(first, np.int64), np.asarray(last, np.int64)
        if len(self.stretches) == 1:
            return np.asarray((last - first) * float(self.timestep), np.float64)
        total = np.zeros(np.broadcast_shapes(first.shape, last.shape))
        ends = [one.done for one in self.stretches[1:]] + [np.iinfo(np.int64).max]
        for one, end in zip(self.stretches, ends, strict=True):
            steps = np.clip(last, one.done, end) - np.clip(first, one.done, end)
            total += steps * float(one.timestep)
        return total

    def nanoseconds(self, steps: np.ndarray) -> np.ndarray:
        """Return the times of states in whole nanoseconds, int64, rounded down."""
        import numpy as np

        if len(self.stretches) == 1:
            return _nanoseconds(self.stretches[0], steps)
        times = np.zeros(len(steps), np.int64)
        for one in self.stretches:
            within = steps >= one.done  # what belongs to a later stretch is overwritten there
            times[within] = _nanoseconds(one, steps[within] - one.done)
        return times


def _nanoseconds(stretch: Stretch, steps: np.ndarray) -> np.ndarray:
    import numpy as np

    seconds = stretch.begin.numerator // stretch.begin.denominator
    rest = stretch.begin - seconds
    scale = lcm(rest.denominator, stretch.timestep.denominator)
    begin, length = int(rest * scale) * NANOSECONDS, int(stretch.timestep * scale) * NANOSECONDS
    common = gcd(length, begin, scale)  # steps of 1/250 s are whole nanoseconds, without a division
    length, begin, scale = length // common, begin // common, scale // common
    steps = np.ascontiguousarray(steps)  # read more than once
    most = int(steps.max(initial=1))
    if most * length + begin < 2**62:
        times = steps * length
        if begin:
            times += begin
        if scale > 1:
            times //= scale
    elif scale * length + begin < 2**62:
        whole, left = np.divmod(steps, scale)
        times = whole * length + (left * length + begin) // scale
    else:  # Timesteps such as 0.0041666666, or many changes, have denominators beyond 64 bits.
        times = np.array([(int(step) * length + begin) // scale for step in steps], np.int64)
    return np.asarray(times + seconds * NANOSECONDS if seconds else times, np.int64)
