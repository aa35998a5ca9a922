"""The laws of one step, by the impulses that explain its change of momentum best (`fits`).

`momentum`, `adhesion`, `cone` and `gap` are what these leave. Where they explain all, they are
judged beside the velocities of the surfaces that they act between: `complementarity`,
`dissipation` and `energy` (`pushes`). `penetration` is the depth to which bodies overlap after the
step, beyond the slop.

Contacts push at some time within the step, and where they are then no log tells: the points of its
start, its middle, its end and of where bodies first meet (`meeting`) are allowed together, so that
those of any time between are but for the square of the angle that bodies turn by.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from .contacts import ContactSearch
from .fits import fits_of, impulses_of
from .meeting import meeting_pose
from .momentum import BodyStates, StepMomentum, momentum_of
from .motion import Floats
from .points import PointsOfPose, points_at, together
from .pushes import NONE, Pushes, Violation

UNITS: Final = {
    "momentum": "N s",
    "adhesion": "N s",
    "cone": "N s",
    "gap": "N s",
    "complementarity": "N s",
    "penetration": "m",
    "dissipation": "J",
    "energy": "J",
}
LAWS: Final = tuple(UNITS)
MEANINGS: Final = {
    "momentum": "no impulse of any contact explains it",
    "adhesion": "contacts would have to pull",
    "cone": "friction beyond mu times the normal impulse",
    "gap": "pushes where surfaces do not meet",
    "complementarity": "pushes what parts faster than restitution lets it",
    "penetration": "overlap after the step",
    "dissipation": "friction that takes less energy than slip requires",
    "energy": "contacts gave energy",
}
OF_MOMENTUM: Final = ("momentum", "adhesion", "cone", "gap")


def laws_of(
    search: ContactSearch, before: BodyStates, after: BodyStates, dt: float, looks: Sequence[float]
) -> dict[str, Violation]:
    """Return by LAWS what a step of dt [s] between two states does to each.

    looks: shares of the step, 0, 1/2 or 1, whose contacts may push.
    """
    momentum, states = momentum_of(search, before, after, dt), (before, after)
    points = [points_at(search, share, states, momentum, dt) for share in looks]
    if len(looks) > 1:
        met = meeting_pose(points[0], before, momentum, dt)
        if met is not None:
            points.insert(1, points_at(search, 0.0, states, momentum, dt, pose=met))
    points = together(points)
    fits = fits_of(momentum, points)
    found = {law: _missing(momentum, fits.missing[law]) for law in OF_MOMENTUM}
    if fits.across.any():
        gaps = np.concatenate([one.contacts.gap for one in points])
        farthest = float(np.max(gaps[fits.across > 0.0]))
        found["gap"] = found["gap"]._replace(gap=farthest)
    pushes = Pushes.of(points, fits.impulses, momentum)
    if pushes.chooses():
        cost = np.concatenate([_cost(one) for one in points])
        pushes = Pushes.of(points, impulses_of(momentum, points, cost), momentum)
    found["complementarity"] = pushes.complementarity()
    last = points[-1] if looks[-1] == 1.0 else points_at(search, 1.0, states, momentum, dt)
    found["penetration"] = _penetration(search, last)
    found["dissipation"], found["energy"] = pushes.dissipation(), pushes.energy()
    return {law: found[law] for law in LAWS}


def _missing(momentum: StepMomentum, scaled: Floats) -> Violation:
    sizes = np.linalg.norm(scaled, axis=1)
    if not sizes.any():
        return NONE
    numbers = sizes * np.sqrt(momentum.mass)
    k = int(np.argmax(numbers))
    share = float(sizes[k] / momentum.at_play[k])
    number, row = float(numbers[k]), int(momentum.movable[k])
    return Violation(number, share, (row,), number / float(momentum.mass[k]))


def _cost(points: PointsOfPose) -> Floats:
    """Return what impulses cost (n, 3) [m/s]: nothing where they are as the laws want them.

    So the laws are judged by those of redundant impulses that break them least.
    """
    mu, slip = points.contacts.mu, points.after[:, 1:]
    parting = np.maximum(points.after[:, 0] - points.contacts.restitution * points.approach, 0.0)
    normal = np.where(points.contacts.rigid, parting, 0.0) + mu * np.hypot(slip[:, 0], slip[:, 1])
    return np.column_stack([normal, np.where(mu > 0.0, 1.0, 0.0)[:, None] * slip])


def _penetration(search: ContactSearch, points: PointsOfPose) -> Violation:
    contacts = points.contacts
    depth = np.where(contacts.rigid, -contacts.gap - search.slop, 0.0)
    if not np.any(depth > 0.0):
        return NONE
    c = int(np.argmax(depth))
    pair = int(contacts.a[c]), int(contacts.b[c])
    return Violation(float(depth[c]), float(depth[c] / search.thickness(pair)), pair)
