"""Impulses of a step beside the velocities of their surfaces: what they should not have done.

    complementarity   min(lambda_n, (w_n - e v - k)/k_n)      pushes what parts faster than it may
    dissipation       lambda_t . w_t + mu lambda_n |w_t|      friction that takes less than its most
    energy            sum of lambda . (w before + w)/2        contacts gave energy
v is the most that the surfaces can have approached with. In which order contacts pushed no log
tells. So of the first two the step gets the benefit of the doubt: k is what the others gave this
contact if all that part it came after, and tangential velocities w_t are those between the step's
two ends that are the best for it, less what the others may have changed since. Both vanish for what
is pushed at one point alone, and as the timestep for forces that last.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .momentum import StepMomentum
from .motion import Floats
from .points import PointsOfPose

# Share of what is at play from which on other impulses of the same momentum are looked for [-].
WORTH_CHOOSING: Final = 1e-10
BETWEEN: Final = np.linspace(0.0, 1.0, 9)  # of the velocities at the two ends of a step


class Violation(NamedTuple):
    """How far a step breaks one law, and by whom."""

    number: float  # in the law's unit
    share: float  # of what is at play for these bodies [-]
    bodies: tuple[int, ...]  # rows in the log; none where it is 0
    velocity: float = 0.0  # [m/s] of laws of momentum: that over the body's mass
    gap: float = 0.0  # [m] of `gap`: the farthest that a push acts across


NONE: Final = Violation(0.0, 0.0, ())


class Pushes(NamedTuple):
    """The points of all poses of a step that carry an impulse, n of them."""

    impulses: Floats  # (n, 3) [N s]
    approach: Floats  # (n,) [m/s]
    before: Floats  # (n, 3) [m/s]
    free: Floats  # (n, 3) [m/s]
    after: Floats  # (n, 3) [m/s]
    softness: Floats  # (n,) k_n [1/kg]
    mu: Floats
    restitution: Floats
    rigid: NDArray[np.bool_]
    a: NDArray[np.intp]
    b: NDArray[np.intp]
    names: NDArray[np.int64]  # (n,) equal: the same contact, in another pose
    rows: Floats  # (n, 2, 3, 6) what impulses give to A and B, scaled
    size: Floats  # (n,) [N s] momentum at play for the two bodies
    energy_at_play: float  # [J] of all bodies that are pushed

    @classmethod
    def of(cls, points: Sequence[PointsOfPose], impulses: Floats, momentum: StepMomentum) -> Pushes:
        """Return those of impulses (m, 3) at the points of some poses."""
        pushed = impulses[:, 0] > 0.0

        def joined(parts: Sequence[NDArray[Any]]) -> NDArray[Any]:
            together: NDArray[Any] = np.concatenate(parts)[pushed]
            return together

        contacts = [one.contacts for one in points]
        a, b = joined([one.a for one in contacts]), joined([one.b for one in contacts])
        at_play = np.zeros(len(momentum.place))
        at_play[momentum.movable] = momentum.at_play
        size = at_play.copy()
        size[momentum.movable] *= np.sqrt(momentum.mass)
        touched = np.unique(np.concatenate([a, b]))
        names = joined([one.names for one in points])
        return cls(
            impulses[pushed],
            joined([one.approach for one in points]),
            joined([one.before for one in points]),
            joined([one.free for one in points]),
            joined([one.after for one in points]),
            joined([one.softness for one in points]),
            joined([one.mu for one in contacts]),
            joined([one.restitution for one in contacts]),
            joined([one.rigid for one in contacts]),
            a,
            b,
            np.unique(names, axis=0, return_inverse=True)[1].ravel(),
            joined([one.rows for one in points]),
            np.maximum(size[a], size[b]),
            0.5 * float((at_play[touched] ** 2).sum()),
        )

    def chooses(self) -> bool:
        """Whether other impulses of the same momentum may break the laws less."""
        found = self.complementarity(), self.dissipation()
        return len(self.mu) > 1 and any(one.share > WORTH_CHOOSING for one in found)

    def complementarity(self) -> Violation:
        """Return the worst push of what parts faster than restitution and other pushes let it."""
        parting = self.after[:, 0] - self.restitution * self.approach
        numbers = np.zeros(len(parting))
        for c in np.flatnonzero((parting > 0.0) & self.rigid).tolist():
            kicks = self._kicks(c)[:, 0]
            aside = np.maximum(kicks, 0.0).sum()
            aside += self.restitution[c] * np.maximum(-kicks, 0.0).sum()
            left = max(float(parting[c] - aside), 0.0) / self.softness[c]
            numbers[c] = min(float(self.impulses[c, 0]), left)
        if not np.any(numbers > 0.0):
            return NONE
        c = int(np.argmax(numbers))
        share = float(numbers[c] / self.size[c])
        return Violation(float(numbers[c]), share, (int(self.a[c]), int(self.b[c])))

    def dissipation(self) -> Violation:
        """Return what friction takes less than slip requires, over all contacts."""
        ends = self.before[:, 1:], self.after[:, 1:]
        limit = self.mu * self.impulses[:, 0]
        slips = [ends[0] + share * (ends[1] - ends[0]) for share in BETWEEN]
        slips.append(_nearest_to_nothing(*ends))
        missing = np.min(
            [
                (self.impulses[:, 1:] * slip).sum(axis=1) + limit * np.hypot(*slip.T)
                for slip in slips
            ],
            axis=0,
        )
        for c in np.flatnonzero(missing > 0.0).tolist():
            since = np.hypot(*self._kicks(c)[:, 1:].T).sum()
            missing[c] = max(float(missing[c] - 2.0 * limit[c] * since), 0.0)
        return self._summed(missing)

    def energy(self) -> Violation:
        """Return what contacts gave to bodies, forces before or after them."""
        gained = [
            (self.impulses * 0.5 * (first + self.after)).sum(axis=1) * self.rigid
            for first in (self.before, self.free)
        ]
        return self._summed(min(gained, key=lambda one: float(one.sum())))

    def _kicks(self, c: int) -> Floats:
        """Return by how much each other contact changed the velocities of one (others, 3) [m/s]."""
        given = np.einsum("nsij,ni->nsj", self.rows, self.impulses)
        kicks = np.zeros((len(self.mu), 3))
        for side, body in enumerate((self.a[c], self.b[c])):
            for other, theirs in enumerate((self.a, self.b)):
                same = np.flatnonzero((theirs == body) & (self.names != self.names[c]))
                kicks[same] += given[same, other] @ self.rows[c, side].T
        together = np.zeros((int(self.names.max()) + 1, 3))
        np.add.at(together, self.names, kicks)
        return together

    def _summed(self, numbers: Floats) -> Violation:
        """Return the sum over points, with the two bodies that have most of it; 0 below 0."""
        total = float(numbers.sum())
        if not total > 0.0:
            return NONE
        c = int(np.argmax(numbers))
        return Violation(total, total / self.energy_at_play, (int(self.a[c]), int(self.b[c])))


def _nearest_to_nothing(first: Floats, last: Floats) -> Floats:
    """Return the least of the velocities between two of each (n, 2)."""
    change = last - first
    square = (change * change).sum(axis=1)
    share = -(first * change).sum(axis=1) / np.where(square > 0.0, square, 1.0)
    nearest: Floats = first + np.clip(share, 0.0, 1.0)[:, None] * change
    return nearest
