"""Four fits of impulses to the change of momentum, each allowing more: which laws it breaks.

    in Coulomb's cone, where surfaces meet within the step      leaves s0
    in Coulomb's cone, at every point in reach                  leaves s1     s0 - s1: gap
    pushes with any tangential impulse                          leaves s2     s1 - s2: cone
    any impulses                                                leaves s3     s2 - s3: adhesion
                                                                              s3:      momentum
What is left is unique, however redundant contacts are, and so are these differences. Each is, body
by body, a momentum that no impulse within the law can give [N s]; spin is counted as the linear
momentum of as much kinetic energy.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from lavendersim.problems.impulse_fit import Allowed, fit_impulses, impulse_matrix

from .momentum import StepMomentum
from .motion import Floats
from .points import PointsOfPose

# Share of what is at play for a body below which what the first fit leaves is round-off [-]: a
# hundred additions of numbers that are as large.
ROUND_OFF: Final = 1e-14


class Fits(NamedTuple):
    """What the fits say; k movable bodies, m points of all looks together."""

    impulses: Floats  # (m, 3) [N s] of the first fit: within the laws
    missing: dict[str, Floats]  # by law: (k, 6) scaled momentum that it cannot give [J^(1/2)]
    across: Floats  # (m,) [N s] normal impulses of the second fit at points that do not meet


def fits_of(momentum: StepMomentum, looks: Sequence[PointsOfPose]) -> Fits:
    """Return the fits to the momentum of a step at the points of some poses."""
    rows = _matrix(momentum, looks)
    mu = np.concatenate([one.contacts.mu for one in looks])
    meets = np.concatenate([one.meets for one in looks])
    goal, count = momentum.unexplained, len(mu)

    def fit(kept: Any, allowed: Allowed) -> tuple[Floats, Floats]:
        part = np.flatnonzero(np.repeat(kept, 3))
        found = fit_impulses(rows[part], goal, mu[kept], allowed)
        impulses = np.zeros((count, 3))
        impulses[kept] = found.impulses
        return impulses, found.left.reshape(-1, 6)

    every = np.ones(count, bool)
    impulses, left = fit(meets, "cone")
    missing = dict.fromkeys(("gap", "cone", "adhesion", "momentum"), np.zeros_like(left))
    across = np.zeros(count)
    if not np.any(np.linalg.norm(left, axis=1) > ROUND_OFF * momentum.at_play):
        missing["momentum"] = left
        return Fits(impulses, missing, across)
    if not meets.all():
        anywhere, less = fit(every, "cone")
        missing["gap"], left = left - less, less
        across = np.where(meets, 0.0, anywhere[:, 0])
    for law, allowed in (("cone", "push"), ("adhesion", "any")):
        _, less = fit(every, allowed)  # type: ignore[arg-type]
        missing[law], left = left - less, less
    missing["momentum"] = left
    return Fits(impulses, missing, across)


def impulses_of(momentum: StepMomentum, looks: Sequence[PointsOfPose], cost: Floats) -> Floats:
    """Return impulses (m, 3) of the first fit: those that cost the least, of all that fit.

    cost: (m, 3) by a unit of impulse, in the dual cone of each point.
    """
    meets = np.concatenate([one.meets for one in looks])
    mu = np.concatenate([one.contacts.mu for one in looks])[meets]
    rows = _matrix(momentum, looks)[np.flatnonzero(np.repeat(meets, 3))]
    impulses = np.zeros((len(meets), 3))
    found = fit_impulses(rows, momentum.unexplained, mu, cost=cost[meets])
    impulses[meets] = found.impulses
    return impulses


def _matrix(momentum: StepMomentum, looks: Sequence[PointsOfPose]) -> Any:
    """Return G of all points, (3 m, 6 k)."""
    values = np.concatenate([one.rows for one in looks])  # (m, 2, 3, 6)
    bodies = np.concatenate([np.stack([o.contacts.a, o.contacts.b], axis=1) for o in looks])
    place = momentum.place[bodies]  # (m, 2)
    return impulse_matrix(values, place, 6 * len(momentum.movable))
